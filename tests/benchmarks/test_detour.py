"""The navigation mesh of Recast: its units, and a real one where it is installed."""

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
import pytest
from benchmarks._detour import Detour, NavMeshSettings, y_up, z_up
from benchmarks._node_process import recast_missing

SETTINGS = NavMeshSettings(radius_m=0.25, height_m=1.8, climb_m=0.6, cell_m=0.125)


def floor(x0: float, x1: float, z: float) -> np.ndarray:
    """A floor 4 m deep."""
    a, b, c, d = [x0, 0, z], [x1, 0, z], [x1, 4, z], [x0, 4, z]
    return np.array([[a, b, c], [a, c, d]], dtype=float)


@contextmanager
def detour(mesh: np.ndarray, settings: NavMeshSettings = SETTINGS) -> Iterator[Detour]:
    if absent := recast_missing():
        pytest.skip(absent)
    with Detour(mesh, settings) as running:
        yield running


def test_lengths_become_cells_on_the_safe_side() -> None:
    config = SETTINGS.config()
    assert config["walkableRadius"] == 2
    assert config["walkableHeight"] == 36
    assert config["walkableClimb"] == 12
    assert config["minRegionArea"] == 8
    coarse = NavMeshSettings(0.25, 1.85, 0.55, cell_m=0.1, cell_height_m=0.1).config()
    assert (coarse["walkableRadius"], coarse["walkableHeight"], coarse["walkableClimb"]) == (
        3,
        19,
        5,
    )


def test_axes_turn_forth_and_back() -> None:
    assert y_up(np.array([1.0, 2.0, 3.0])).tolist() == [1.0, 3.0, -2.0]
    points = np.random.default_rng(0).random((5, 3))
    assert np.array_equal(z_up(y_up(points)), points)


def test_step_is_climbed_by_the_tall_only() -> None:
    mesh = np.concatenate([floor(0, 6, 0.0), floor(6, 12, 0.5), floor(14, 20, 0.0)])
    pairs = np.array(
        [[[1, 2, 0], [11, 2, 0.5]], [[1, 2, 0], [19, 2, 0]], [[1, 2, 0], [1, 9, 0]]], dtype=float
    )
    with detour(mesh) as tall:
        up, across, outside = tall.find_paths(pairs)
        assert up.found
        assert up.length_m == pytest.approx(10.0, abs=0.2)
        assert across.stands == (True, True)
        assert not across.found
        assert outside.stands == (True, False)
        assert tall.stands(pairs[:, 1]).tolist() == [True, True, False]
    with detour(mesh, NavMeshSettings(0.2, 1.3, 0.3)) as short:
        assert not short.find_paths(pairs[:1])[0].found


def test_rules_are_eased_one_at_a_time() -> None:
    pair = np.array([[[1, 2, 0], [11, 2, 0.66]]])
    with detour(np.concatenate([floor(0, 6, 0.0), floor(6, 12, 0.66)])) as refusing:
        assert not refusing.find_paths(pair)[0].found
        assert [rule for rule, other in refusing.relaxed() if other.find_paths(pair)[0].found] == [
            "step"
        ]
        assert not refusing.find_paths(pair)[0].found


def test_walkable_ground_lies_where_the_floor_is() -> None:
    with detour(floor(0, 6, 1.0)) as plain:
        assert plain.build_figures["polygons"] >= 1
        assert plain.build_figures["KiB"] > 0
        triangles = plain.triangles()
    assert triangles.shape[1:] == (3, 3)
    assert 0.0 < triangles[..., 0].min() < triangles[..., 0].max() < 6.0
    assert 0.0 < triangles[..., 1].min() < triangles[..., 1].max() < 4.0
    assert triangles[..., 2] == pytest.approx(1.0, abs=0.1)


def test_mesh_without_ground_is_told_of() -> None:
    from_below = floor(0, 6, 0.0)[:, ::-1]
    with pytest.raises(RuntimeError, match=r"Node\.js process reports"), detour(from_below):
        pass

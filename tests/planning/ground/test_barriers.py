"""The barriers that stop a body: outlines, walls, doors and ledges, where they really are."""

import math

import numpy as np
import pytest

from esplanade.planning import Door, LayeredGrid, Polygon, Ramp, Scene, Stairs, Wall
from esplanade.planning.ground.floors import floors_of_scene
from tests.planning.storeys import box

BOUNDS = (0.0, 0.0, 6.0, 6.0)


def barriers(**parts) -> np.ndarray:
    return floors_of_scene(Scene(bounds=BOUNDS, **parts)).barriers


def stops(rows: np.ndarray, z: float, height_m: float, step_on_m: float) -> np.ndarray:
    """For each row, whether it stops a body that stands at that height."""
    return (
        (rows["bottom_m"] < z + height_m)
        & (rows["top_m"] > z + step_on_m)
        & (step_on_m < rows["climb_m"])
    )


def length(rows: np.ndarray) -> float:
    return float(np.hypot(rows["x1"] - rows["x0"], rows["y1"] - rows["y0"]).sum())


def test_walls_reach_from_their_foot_to_their_top() -> None:
    wall = Wall(start=(1, 1), end=(1, 5), height_m=1.0, offset_m=3.0)
    assert barriers(walls=(wall,)).tolist() == [(1, 1, 1, 5, 3.0, 4.0, math.inf)]


def test_a_tall_solid_has_its_outline_and_nothing_else() -> None:
    rows = barriers(polygons=(box(1.1, 1.1, 3.3, 3.3, 3.0),))
    house = rows[:4]
    assert length(house) == pytest.approx(4 * 2.2)
    assert stops(house, 0.0, 1.8, 0.6).all()
    on_the_roof = rows[4:]
    assert (on_the_roof["bottom_m"] > 2.9).all()
    assert not stops(on_the_roof, 0.0, 1.8, 0.6).any()


def test_a_low_block_is_stepped_on_by_who_can() -> None:
    rows = barriers(polygons=(box(1.1, 1.1, 3.3, 3.3, 0.45),))
    assert not stops(rows, 0.0, 1.8, 0.6).any()
    assert not stops(rows, 0.45, 1.8, 0.6).any()
    assert length(rows[stops(rows, 0.0, 1.3, 0.3)]) == pytest.approx(2 * 4 * 2.2, abs=0.8)
    ledges = rows[stops(rows, 0.45, 1.3, 0.3)]
    assert length(ledges) == pytest.approx(4 * 2.2, abs=0.4)
    assert ledges["climb_m"] == pytest.approx(0.45)
    ends = np.array(ledges[["x0", "y0", "x1", "y1"]].tolist())
    on_outline = np.abs(ends[:, :, None] - (1.1, 3.3)).min(axis=2) < 1e-9
    assert on_outline.any(axis=1).all()


def test_nobody_falls_off_a_slab_or_is_stopped_below_it() -> None:
    rows = barriers(polygons=(box(1.1, 1.1, 3.3, 3.3, 0.2, 2.8),))
    above = rows[stops(rows, 3.0, 1.8, 0.6)]
    assert length(above) == pytest.approx(4 * 2.2, abs=0.6)
    assert np.isinf(above["climb_m"]).all()
    assert not stops(rows, 0.0, 1.8, 0.6).any()
    assert length(rows[stops(rows, 0.0, 2.9, 0.6)]) > 4.0


def test_a_ledge_ends_at_the_ceiling_over_it() -> None:
    pit = box(2, 0, 6, 6, 0.2, 1.6)
    steps = box(0, 0, 2, 6, 1.5)
    rows = barriers(polygons=(pit, steps))
    assert not stops(rows[8:], 1.8, 1.8, 0.6).any()


def test_plants_and_water_stop_everybody() -> None:
    pond = Polygon(points=((1, 1), (3, 1), (3, 3)), height_m=0.05, kind="water")
    rows = barriers(polygons=(pond,))
    assert len(rows) == 3
    assert stops(rows, 0.0, 1.0, 1.15).all()


def test_ramps_stop_only_beside_what_is_too_high() -> None:
    ramp = Ramp(start=(1.0, 2.0), end=(5.0, 2.0))
    rows = barriers(polygons=(box(1, 2, 5, 4, 2.0).model_copy(update={"ramp": ramp}),))
    met = rows[stops(rows, 0.0, 1.8, 0.6)]
    assert min(met["x0"].min(), met["x1"].min()) >= 1.0 + 2 * 0.5
    assert max(met["x0"].max(), met["x1"].max()) == 5.0
    along = rows[(rows["y0"] != rows["y1"]) & (np.abs(rows["x0"] - rows["x1"]) < 1e-9)]
    assert not ((along["x0"] > 1.1) & (along["x0"] < 4.9)).any()


def test_stairs_are_climbed_by_who_steps_so_high() -> None:
    stairs = Stairs(start=(1, 3), end=(4, 3), width_m=2, top_m=2.5, steps=10)
    rows = barriers(stairs=(stairs,))
    across = rows[np.abs(rows["x0"] - rows["x1"]) < 1e-9]
    for k in range(10):
        x = 1.0 + 0.3 * k
        riser = across[np.abs(across["x0"] - x) < 1e-6]
        assert not stops(riser, 0.25 * k, 1.3, 0.3).any()
        assert stops(riser, 0.25 * k, 1.3, 0.2).any()
        assert stops(riser, 0.25 * (k + 1), 1.3, 0.2).any()


def test_doors_stop_only_while_closed() -> None:
    door = Door(name="gate", start=(3, 1), end=(2, 1), open=False)
    grid = LayeredGrid.from_scene(Scene(bounds=BOUNDS, doors=(door,)))
    rows = grid.barriers
    assert list(grid.doors) == ["gate"]
    assert len(grid.doors) == 1
    assert not grid.doors.is_open("gate")
    assert stops(rows, 0.0, 1.8, 0.6).all()
    assert grid.doors.set_open("gate", True) == (2.0, 1.0, 3.0, 1.0)
    assert grid.doors.is_open("gate")
    assert grid.barriers is rows
    assert not stops(rows, 0.0, 1.8, 0.0).any()
    grid.doors.set_open("gate", False)
    assert stops(rows, 0.0, 1.8, 0.6).all()
    with pytest.raises(KeyError, match="moon"):
        grid.doors.set_open("moon", True)

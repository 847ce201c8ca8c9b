"""The checks of positions in the gallery find impossible positions and accept all others."""

import numpy as np
import pytest
from benchmarks._position_checks import clearances, inside, unsupported
from benchmarks.gallery import position_figures

from esplanade.planning import Place
from esplanade.planning.scene.scene_file import read_scene
from esplanade.server.loading import DEFAULT_SCENE
from tests.server.worlds import ROOM

GALLERY = read_scene(DEFAULT_SCENE)


def one(*point: float) -> np.ndarray:
    return np.array([point], dtype=np.float64)


def point_of(place: Place) -> tuple[float, float, float]:
    return (*place.position, place.z_m)


@pytest.mark.parametrize("place", GALLERY.places, ids=lambda place: place.name)
def test_every_place_is_a_place_to_be(place: Place) -> None:
    point = one(*point_of(place))
    assert not unsupported(GALLERY, point).any()
    assert not inside(GALLERY, point).any()
    assert clearances(GALLERY, point)[0] >= 0.2


@pytest.mark.parametrize(
    ("point", "fault"),
    [
        ((20.0, 12.5, 2.0), unsupported),  # between the passage and the bridge
        ((20.0, 16.0, 3.5), unsupported),  # above the court
        ((22.0, 18.0, 0.0), inside),  # in the stairs
        ((22.0, 18.0, 2.4), unsupported),  # above them
        ((2.25, 7.5, 0.0), inside),  # in a wall
        ((18.0, 11.5, 3.5), inside),  # in a railing
        ((30.0, 28.0, 0.0), inside),  # in the ramp
        ((50.0, 0.0, 0.0), unsupported),  # beyond the bounds
    ],
)
def test_where_nobody_can_be_is_found(point, fault) -> None:
    assert fault(GALLERY, one(*point)).all()


def test_stairs_and_ramps_carry() -> None:
    stairs = np.array([[16.0, 14.5 + 0.3 * k + 0.15, 0.175 * (k + 1)] for k in range(10)])
    ramp = np.array([[x, 28.0, 1.75 * (37.0 - x) / 14.0] for x in np.linspace(23.5, 36.5, 20)])
    for points in (stairs, ramp):
        assert not unsupported(GALLERY, points).any()
        assert not inside(GALLERY, points).any()


def test_distances_are_those_to_what_stops_a_body() -> None:
    points = np.array([[9.5, 4.0, 0.0], [9.0, 14.5, 0.0], [12.0, 18.0, 0.0]])
    assert clearances(ROOM, points) == pytest.approx([0.5, 1.0, 3.0], abs=0.02)


def test_figures_sum_it_up() -> None:
    rows = [[tick, 7.0, 2.0 + 0.1 * tick, 4.0, 0.0] for tick in range(10)]
    rows += [[tick, 8.0, 10.0, 4.0, 0.0] for tick in range(0, 10, 3)]
    figures = position_figures(ROOM, np.array(rows))
    assert figures["positions"] == 14
    assert figures["avatars"] == 2
    assert figures["share_at_0_m"] == 1.0
    assert figures["inside"] == 4  # this avatar stands in the wall
    assert figures["unsupported"] == 0
    assert figures["longest_move_m"] == pytest.approx(0.1)
    assert figures["steps_too_high"] == 0

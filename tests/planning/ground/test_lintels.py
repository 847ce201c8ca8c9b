"""Ceilings of meshes that end without a face at their side have lintels where they end."""

import math

import numpy as np
import pytest

from esplanade.planning import Body, PathStatus, find_path
from esplanade.planning.grid.grid import LayeredGrid
from esplanade.planning.ground.floors import Floors
from esplanade.planning.ground.meshes import barriers_of_triangles, surfaces_of_triangles
from esplanade.planning.scene.doors import Doors
from tests.planning.ground.test_turned_meshes import block, plate, turned
from tests.planning.worlds import of_all

LOW_M = 1.5
FROM, TO = (-3.0, 0.4, 0.0), (3.0, -0.3, 0.0)
TURNS = of_all([(9.0, (0.11, 0.07)), (27.0, (0.2, 0.03)), (45.0, (0.06, 0.19))])

Sheet = np.ndarray


def sheet(x0: float, y0: float, x1: float, y1: float) -> Sheet:
    """A ceiling without thickness, seen from both sides."""
    above = np.array(plate(x0, y0, x1, y1, LOW_M))
    return np.concatenate([above, above[:, ::-1]])


def beam(x0: float, y0: float, x1: float, y1: float) -> Sheet:
    return block(x0, y0, LOW_M, x1, y1, LOW_M + 0.4)


def room(width_m: float, low: Sheet) -> Sheet:
    """A room that a wall and something low divide, with a passage between the two."""
    floor = np.array(plate(-5, -5, 5, 5, 0))
    return np.concatenate([floor, block(-0.3, -5, -0.1, 0.3, -0.5 * width_m, 3), low])


def floors_of(triangles: Sheet) -> Floors:
    surfaces = surfaces_of_triangles(triangles)
    layered = surfaces.layered()
    barriers = barriers_of_triangles(triangles, surfaces, layered)
    return Floors(surfaces, layered, barriers, Doors(barriers, {}))


def has_way(triangles: Sheet, degrees: float, aside_m: tuple[float, float], body: Body) -> bool:
    grid = LayeredGrid(floors_of(turned(triangles, degrees, aside_m)))
    start, goal = (tuple(turned(np.array(end), degrees, aside_m).tolist()) for end in (FROM, TO))
    return find_path(grid, start, goal, body).status is PathStatus.FOUND


@pytest.mark.parametrize(("degrees", "aside_m"), TURNS)
@pytest.mark.parametrize("low", [sheet, beam])
@pytest.mark.parametrize(("width_m", "passes"), [(0.46, False), (0.6, True)])
def test_a_passage_beside_something_low_is_as_wide_as_it_is(
    degrees, aside_m, low, width_m, passes
) -> None:
    triangles = room(width_m, low(-0.3, 0.5 * width_m, 0.3, 5))
    assert has_way(triangles, degrees, aside_m, Body.adult()) is passes
    assert has_way(triangles, degrees, aside_m, Body.child())


@pytest.mark.parametrize(("degrees", "aside_m"), TURNS)
def test_lintels_lie_along_the_edges_of_a_sheet(degrees, aside_m) -> None:
    low = sheet(-1.0, -1.3, 1.2, 0.9)
    triangles = np.concatenate([np.array(plate(-5, -5, 5, 5, 0)), low])
    barriers = floors_of(turned(triangles, degrees, aside_m)).barriers
    lintels = barriers[np.abs(barriers["bottom_m"] - LOW_M) < 0.01]
    total = 0.0
    for lintel in lintels:
        ends = np.array([(lintel["x0"], lintel["y0"], 0.0), (lintel["x1"], lintel["y1"], 0.0)])
        back = (ends - (*aside_m, 0.0)) @ rotation(degrees).T
        on_edge = [np.ptp(back[:, axis]) < 1e-6 and on_side(back[0, axis], axis) for axis in (0, 1)]
        assert any(on_edge)
        total += math.dist(ends[0], ends[1])
    assert total == pytest.approx(2.0 * (2.2 + 2.2), abs=0.3)


def rotation(degrees: float) -> np.ndarray:
    a = np.radians(degrees)
    return np.array([[np.cos(a), np.sin(a), 0], [-np.sin(a), np.cos(a), 0], [0, 0, 1]])


def on_side(value: float, axis: int) -> bool:
    """Whether a coordinate is that of a side of the sheet."""
    return min(abs(value - side) for side in ((-1.0, 1.2), (-1.3, 0.9))[axis]) < 1e-6


def test_a_sloping_ceiling_keeps_its_lintels_between_cells() -> None:
    """Its height changes without an edge, and a body keeps its radius from what is too low."""
    slope = np.array(
        [[[-2.0, -2, 0.9], [2, -2, 3.7], [2, 2, 3.7]], [[-2, -2, 0.9], [2, 2, 3.7], [-2, 2, 0.9]]]
    )
    triangles = np.concatenate([np.array(plate(-5, -5, 5, 5, 0)), slope[:, ::-1]])
    barriers = floors_of(triangles).barriers
    between = np.isinf(barriers["climb_m"]) & (barriers["bottom_m"] > 1.0)
    between &= (barriers["x0"] == barriers["x1"]) & (np.abs(barriers["x0"]) < 1.9)
    assert between.sum() > 3

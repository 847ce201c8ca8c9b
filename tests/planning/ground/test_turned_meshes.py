"""Meshes turned about the vertical: ways and ledges depend on the building, not on the cells."""

from functools import cache

import numpy as np
import pytest
import trimesh

from esplanade.planning import Body, PathStatus, find_path
from esplanade.planning.grid.grid import LayeredGrid
from esplanade.planning.ground.floors import Floors
from esplanade.planning.ground.meshes import barriers_of_triangles, surfaces_of_triangles
from esplanade.planning.scene.doors import Doors

RISE_M, TREAD_M, LEAN_M = 0.18, 0.27, 0.03
STEPS = 14
UPSTAIRS_M = STEPS * RISE_M
ROOM, BEDROOM = (1.5, 5.0, 0.0), (7.0, 1.0, UPSTAIRS_M)
KITCHEN = (7.0, 5.0, 0.0)


def quad(a, b, c, d) -> list[list[tuple[float, float, float]]]:
    return [[a, b, c], [a, c, d]]


def plate(x0, y0, x1, y1, z) -> list[list[tuple[float, float, float]]]:
    """A level floor without thickness."""
    return quad((x0, y0, z), (x1, y0, z), (x1, y1, z), (x0, y1, z))


def block(x0, y0, z0, x1, y1, z1) -> np.ndarray:
    return np.asarray(trimesh.creation.box(bounds=((x0, y0, z0), (x1, y1, z1))).triangles)


@cache
def house() -> np.ndarray:
    """Two rooms with a slit between their floors under a wall with a door; a flight of leaning
    risers, 0.9 m wide, along the south; an upper floor at its head."""
    south, north = 0.5, 1.4
    parts = [plate(0, 0, 4.9, 6, 0), plate(5.1, 0, 9, 6, 0)]
    for k in range(STEPS - 1):
        x, z = 1.0 + k * TREAD_M, (k + 1) * RISE_M
        parts.append(plate(x, south, x + TREAD_M, north, z))
    for k in range(STEPS):
        x, z = 1.0 + k * TREAD_M, k * RISE_M
        foot = x + LEAN_M
        parts.append(
            quad((foot, north, z), (foot, south, z), (x, south, z + RISE_M), (x, north, z + RISE_M))
        )
    head = 1.0 + (STEPS - 1) * TREAD_M
    parts.append(plate(head, 0, 9, 3, UPSTAIRS_M))
    walls = [block(4.9, 3.0, -0.1, 5.1, 4.5, 2.4), block(4.9, 5.4, -0.1, 5.1, 6, 2.4)]
    walls.append(block(4.9, 0.0, -0.1, 5.1, 3.0, 2.3))
    return np.concatenate([np.array(part, dtype=float) for part in (*parts, *walls)])


def turned(points: np.ndarray, degrees: float, offset: tuple[float, float]) -> np.ndarray:
    a = np.radians(degrees)
    matrix = np.array([[np.cos(a), np.sin(a), 0], [-np.sin(a), np.cos(a), 0], [0, 0, 1]])
    return np.asarray(points) @ matrix + (*offset, 0.0)


def grid_of(triangles: np.ndarray) -> LayeredGrid:
    surfaces = surfaces_of_triangles(triangles)
    layered = surfaces.layered()
    barriers = barriers_of_triangles(triangles, surfaces, layered)
    return LayeredGrid(Floors(surfaces, layered, barriers, Doors(barriers, {})))


@cache
def lengths(degrees: float, offset: tuple[float, float]) -> tuple[float, float]:
    """Lengths of the ways through the door and up the flight, metres."""
    grid = grid_of(turned(house(), degrees, offset))
    found = []
    for ends in ((ROOM, KITCHEN), (ROOM, BEDROOM)):
        start, goal = (tuple(turned(np.array(end), degrees, offset).tolist()) for end in ends)
        way = find_path(grid, start, goal, Body.adult())
        assert way.status is PathStatus.FOUND, ends
        found.append(way.length_m)
    return found[0], found[1]


@pytest.mark.parametrize("offset", [(0.0, 0.0), (0.11, 0.07)])
@pytest.mark.parametrize("degrees", [9, 18, 27, 45, 63, 72])
def test_a_turned_house_has_the_same_ways(degrees, offset) -> None:
    assert lengths(degrees, offset) == pytest.approx(lengths(0, (0.0, 0.0)), rel=0.05)


def ledges_of(triangles: np.ndarray) -> np.ndarray:
    surfaces = surfaces_of_triangles(triangles)
    return barriers_of_triangles(triangles, surfaces, surfaces.layered())


@pytest.mark.parametrize("degrees", [0, 18, 45, 72])
def test_ledges_lie_where_floors_end(degrees) -> None:
    """A platform of two triangles, 0.5 m above a floor that reaches beyond it on three sides."""
    low = np.array(plate(0, 0, 6, 6, 0.0), dtype=float)
    high = np.array(plate(2, 2, 4, 6, 0.5), dtype=float)
    rows = ledges_of(turned(np.concatenate([low, high]), degrees, (0.03, 0.05)))
    steps = rows[np.abs(rows["climb_m"] - 0.5) < 1e-5]
    ends = [[steps[x], steps[y], 0.0 * steps[x]] for x, y in (("x0", "y0"), ("x1", "y1"))]
    a, b = (turned(np.stack(end, axis=1) - (0.03, 0.05, 0.0), -degrees, (0, 0)) for end in ends)
    assert np.hypot(*(b - a)[:, :2].T).sum() == pytest.approx(2 + 4 + 4, abs=1e-3)
    for corner in (a, b):
        away = np.minimum(np.abs(corner[:, 0] - 2), np.abs(corner[:, 0] - 4))
        assert np.minimum(away, np.abs(corner[:, 1] - 2)).max() < 1e-6
    assert steps["bottom_m"] == pytest.approx(0.45, abs=1e-5)


@pytest.mark.parametrize("degrees", [0, 27, 45])
@pytest.mark.parametrize(("slit_m", "ledges"), [(0.0, 0), (0.002, 0), (0.2, 0), (0.4, 0), (0.6, 2)])
def test_slits_between_level_floors_have_ledges_if_they_are_wide(degrees, slit_m, ledges) -> None:
    rooms = np.array(plate(0, 0, 3, 4, 1.0) + plate(3 + slit_m, 0, 7, 4, 1.0), dtype=float)
    rows = ledges_of(turned(rooms, degrees, (0.0, 0.0)))
    middle = turned(np.array([3 + 0.5 * slit_m, 2.0, 0.0]), degrees, (0.0, 0.0))
    x, y = 0.5 * (rows["x0"] + rows["x1"]), 0.5 * (rows["y0"] + rows["y1"])
    assert (np.hypot(x - middle[0], y - middle[1]) < 0.5).sum() == ledges


def test_a_slope_that_breaks_off_has_a_ledge_and_one_that_goes_on_has_none() -> None:
    slope = quad((0, 0, 0), (4, 0, 3), (4, 4, 3), (0, 4, 0))
    on = quad((4, 0, 3), (8, 0, 3), (8, 4, 3), (4, 4, 3))
    down = quad((4, 0, 2), (8, 0, 2), (8, 4, 2), (4, 4, 2))
    inner = [
        ledges_of(turned(np.array(slope + beyond, dtype=float), 18, (0, 0)))["climb_m"]
        for beyond in (on, down)
    ]
    assert not np.isfinite(inner[0]).any()
    assert inner[1][np.isfinite(inner[1])] == pytest.approx(1.0, abs=1e-4)

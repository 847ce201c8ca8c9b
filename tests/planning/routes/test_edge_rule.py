"""M in the potential: where it can bind, and that it forbids what `find_path` forbids."""

import math
from functools import cache

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.planning import (
    Body,
    LayeredGrid,
    PathStatus,
    Polygon,
    Potential,
    Scene,
    Wall,
    Wave,
    find_path,
)
from esplanade.planning.routes.wave_front import NO_TARGETS, WaveFront
from tests.planning.worlds import holds

Point = tuple[float, float]


def turned(points: list[Point], angle: float, about: Point) -> tuple[Point, ...]:
    """Points after a turn about one of them."""
    c, s = math.cos(angle), math.sin(angle)
    x0, y0 = about
    return tuple(
        (x0 + c * (x - x0) - s * (y - y0), y0 + s * (x - x0) + c * (y - y0)) for x, y in points
    )


def flight(steps: int, width: float = 1.6, angle: float = 0.0) -> tuple[Scene, Point, Point]:
    """A flight of low steps up to a platform, the only way up; a place below, and one above."""
    tread, riser, landing = 0.3, 0.1, 2.0
    start, middle = 3.0, 9.0
    end = start + steps * tread + landing
    about = (0.5 * (start + end), middle)
    low, high = middle - 0.5 * width, middle + 0.5 * width
    solids = [
        Polygon(
            points=turned([(x, low), (end, low), (end, high), (x, high)], angle, about),
            height_m=riser * (k + 1),
        )
        for k, x in ((k, start + k * tread) for k in range(steps))
    ]
    below, above = turned([(1.5, middle), (end - 1.0, middle)], angle, about)
    reach = 0.5 * (end - start) + 4.0
    bounds = about[0] - reach, about[1] - reach, about[0] + reach, about[1] + reach
    return Scene(bounds=bounds, polygons=tuple(solids)), below, above


def kerb(length: float, width: float, gap: float) -> tuple[Scene, Point, Point]:
    """A narrow plank over a pit between two halves of the ground, and a level way around.

    With a gap of 0 there is no way around.
    """
    x0, x1 = 4.0, 4.0 + length
    y = 6.0
    walls = [
        Polygon(points=((x0, 0.0), (x1, 0.0), (x1, y - 0.6), (x0, y - 0.6)), height_m=3.0),
        Polygon(
            points=((x0, y + 0.6), (x1, y + 0.6), (x1, 12.0 - gap), (x0, 12.0 - gap)), height_m=3.0
        ),
        Polygon(
            points=(
                (x0, y - 0.5 * width),
                (x1, y - 0.5 * width),
                (x1, y + 0.5 * width),
                (x0, y + 0.5 * width),
            ),
            height_m=0.3,
        ),
    ]
    return Scene(bounds=(0.0, 0.0, x1 + 4.0, 12.0), polygons=tuple(walls)), (2.0, y), (x1 + 2.0, y)


@cache
def grid_of(steps: int, width: float, angle: float) -> tuple[LayeredGrid, Point, Point]:
    scene, below, above = flight(steps, width, angle)
    return LayeredGrid.from_scene(scene), below, above


def agrees(grid: LayeredGrid, goal: Point, z_m: float, starts: list[Point], body: Body) -> int:
    """The number of starts where the potential is finite and no path is, or the other way round."""
    potential = Potential(grid, goal, z_m, body.radius_m, body=body)
    wrong = 0
    for start in starts:
        floor = grid.floor_at(start, z_m)
        path = find_path(grid, (*start, floor), (*goal, z_m), body)
        finite = bool(np.isfinite(potential.distance([start], [floor])[0]))
        wrong += finite != (path.status is PathStatus.FOUND)
    return wrong


@holds(25, 1)
@given(
    steps=st.sampled_from([12, 24, 36]),
    width=st.sampled_from([1.2, 1.6]),
    degrees=st.sampled_from([0, 11, 30, 45, 77]),
    most=st.integers(2, 60),
    up=st.booleans(),
    place=st.floats(0.0, 1.0),
)
def test_the_potential_forbids_what_find_path_forbids(
    steps: int, width: float, degrees: int, most: int, up: bool, place: float
) -> None:
    grid, below, above = grid_of(steps, width, math.radians(degrees))
    body = Body(edge_cells=most)
    goal, z_m, start = (above, 0.1 * steps, below) if up else (below, 0.0, above)
    within = start[0] + place * (goal[0] - start[0]), start[1] + place * (goal[1] - start[1])
    assert agrees(grid, goal, z_m, [start], body) == 0
    rise = 0.1 * steps * (place if up else 1.0 - place)
    path = find_path(grid, (*within, rise), (*goal, z_m), body)
    potential = Potential(grid, goal, z_m, body.radius_m, body=body)
    finite = bool(np.isfinite(potential.distance([within], [rise])[0]))
    assert finite == (path.status is PathStatus.FOUND)


def test_a_body_that_may_be_on_edges_briefly_goes_around_a_kerb() -> None:
    scene, start, goal = kerb(10.0, 0.5, 2.0)
    grid = LayeredGrid.from_scene(scene)
    long, short = Body(edge_cells=200), Body(edge_cells=4)
    assert not grid.bounds_edges(long)
    assert grid.bounds_edges(short)
    over = Potential(grid, goal, 0.0, 0.25, body=long).distance([start], [0.0])[0]
    around = Potential(grid, goal, 0.0, 0.25, body=short).distance([start], [0.0])[0]
    assert over == pytest.approx(14.0, abs=0.3)
    assert around > 17.0
    legal = find_path(grid, (*start, 0.0), (*goal, 0.0), short)
    assert around == pytest.approx(legal.length_m, rel=0.05)


def test_level_ground_bounds_nobody() -> None:
    grid = LayeredGrid.from_scene(Scene(bounds=(0, 0, 5, 5)))
    assert not grid.bounds_edges(Body(edge_cells=1))


def test_a_goal_beside_the_anchor_of_its_cell_is_reached() -> None:
    scene, start, _ = kerb(10.0, 0.5, 2.0)
    goal = (1.742514, 4.262339)
    along = np.array([math.cos(0.965709), math.sin(0.965709)])
    across = 0.5 * 0.544295 * np.array([-along[1], along[0]])
    middle = np.array([1.643018, 4.090775])
    half = 0.294585 * along
    walls = tuple(
        Wall(start=tuple(middle + side - half), end=tuple(middle + side + half))
        for side in (across, -across)
    )
    grid = LayeredGrid.from_scene(Scene(bounds=scene.bounds, polygons=scene.polygons, walls=walls))
    bodies = Body(edge_cells=200), Body(edge_cells=4)
    assert [grid.bounds_edges(body) for body in bodies] == [False, True]
    cell = int(grid.on_ground([goal], [0.0])[1][0])
    assert grid.arrays.kinds.steps[grid.row_of(bodies[1]), cell] == 0
    for body in bodies:
        potential = Potential(grid, goal, 0.0, 0.25, body=body)
        assert potential.goal == goal
        left_m = potential.distance([start], [0.0])[0]
        assert left_m == pytest.approx(math.dist(start, goal), abs=0.5)


def test_cells_that_a_way_may_only_begin_at_count_as_settled_like_others() -> None:
    grid, below, above = grid_of(24, 1.6, 0.0)
    body = Body(edge_cells=20)
    cell = int(grid.on_ground([above], [2.4])[1][0])
    front = WaveFront(grid, above, cell, body.radius_m, Wave.SIGHT, body)
    front.grow(NO_TARGETS)
    halfway = 0.5 * below[0] + 0.5 * above[0], below[1]
    # No way leads up from below, but one from within the flight.
    potential = Potential(grid, above, 2.4, body.radius_m, body=body)
    left_m = potential.distance([below, halfway], [0.0, grid.floor_at(halfway, 1.0)])
    assert np.isfinite(left_m).tolist() == [False, True]
    assert set(front.settled.tolist()) == {0, 1}

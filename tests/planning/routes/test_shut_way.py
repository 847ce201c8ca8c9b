"""Whether bodies that stand in a route shut it, and ways around their places."""

import numpy as np
import pytest

from esplanade.planning import Body, LayeredGrid, Potential, Scene, Wall
from esplanade.planning.routes.shut_way import ShutWays

RADIUS_M = 0.25
START, GOAL = (2.0, 5.0), (8.0, 5.0)


def doorway(half_m: float) -> LayeredGrid:
    ends = ((0.0, 5.0 - half_m), (5.0 + half_m, 10.0))
    walls = tuple(Wall(start=(5.0, a), end=(5.0, b)) for a, b in ends)
    return LayeredGrid.from_scene(Scene(bounds=(0.0, 0.0, 10.0, 10.0), walls=walls))


def shut_by(grid: LayeredGrid, *discs, around_m: float = 1.5, goal=GOAL) -> list[bool]:
    potential = Potential(grid, goal, 0.0, RADIUS_M)
    cell = int(grid.on_ground([START], [0.0])[1][0])
    bodies = np.array(discs, dtype=np.float64).reshape(-1, 4)
    ways = ShutWays(len(grid.layered.floors))
    row = grid.row_of(Body.adult())
    return ways.shut_by(
        grid.arrays, row, potential.values, cell, START, bodies, RADIUS_M, around_m
    ).tolist()


def test_several_who_look_are_told_each_as_if_it_looked_alone() -> None:
    grid = doorway(0.5)
    goals = [GOAL, (5.0, 8.0), (2.0, 2.0)]
    potentials = [Potential(grid, goal, 0.0, RADIUS_M).values for goal in goals]
    places = np.random.default_rng(1).uniform((0.5, 0.5), (4.5, 9.5), (12, 2))
    cells, slots = grid.on_ground(places, np.zeros(12))[1], np.arange(12) % 3
    bodies = np.array([(5.0, 5.0, 0.0, 0.4), (3.0, 5.0, 0.0, 0.4), (80.0, 5.0, 0.0, 0.4)])
    row, ways = grid.row_of(Body.adult()), ShutWays(len(grid.layered.floors))
    rows, rooms = np.full(12, row), np.linspace(0.2, 0.4, 12)
    found = ways.any_shut(
        grid.arrays, rows, np.stack(potentials), slots, cells, places, bodies, rooms, 1.5
    )
    alone = [
        ways.shut_by(
            grid.arrays,
            row,
            potentials[slots[n]],
            int(cells[n]),
            tuple(places[n].tolist()),
            bodies,
            float(rooms[n]),
            1.5,
        ).any()
        for n in range(12)
    ]
    assert found.tolist() == alone
    assert 0 < found.sum() < 12


@pytest.mark.parametrize(("half_m", "shut"), [(0.45, True), (0.7, True), (1.2, False)])
def test_one_body_shuts_a_doorway_if_it_leaves_no_room_beside(half_m: float, shut: bool) -> None:
    assert shut_by(doorway(half_m), (5.0, 5.0, 0.0, 0.4)) == [shut]


def test_several_bodies_shut_what_one_of_them_does_not() -> None:
    row = [(5.0, 4.2, 0.0, 0.4), (5.0, 5.0, 0.0, 0.4), (5.0, 5.8, 0.0, 0.4)]
    assert shut_by(doorway(1.2), *row) == [True] * 3
    assert shut_by(doorway(1.2), *row[:1]) == [False]


def test_bodies_beside_the_route_or_upstairs_shut_nothing() -> None:
    assert shut_by(doorway(0.5), (2.0, 8.0, 0.0, 0.4), (5.0, 5.0, 3.0, 0.4)) == [False, False]


@pytest.mark.parametrize("behind_m", [1.6, 2.0, 2.5, 3.0])
def test_two_bodies_one_behind_the_other_in_the_open_shut_nothing(behind_m: float) -> None:
    """The way around the second begins where the first stands."""
    grid = LayeredGrid.from_scene(Scene.open_space((0.0, 0.0, 40.0, 10.0)))
    bodies = (12.0, 5.0, 0.0, 0.5), (12.0 + behind_m, 5.05, 0.0, 0.5)
    assert shut_by(grid, *bodies, goal=(30.0, 5.0)) == [False, False]


@pytest.mark.parametrize("away_m", [0.0, 0.2, 0.5, 0.7])
def test_a_body_that_one_touches_in_the_open_shuts_nothing(away_m: float) -> None:
    grid = LayeredGrid.from_scene(Scene.open_space((0.0, 0.0, 40.0, 10.0)))
    body = START[0] + away_m, START[1] + 0.1, 0.0, 0.5
    assert shut_by(grid, body, goal=(30.0, 5.0)) == [False]


def test_a_doorway_is_shut_by_who_stands_in_it_though_one_touches_them() -> None:
    walls = tuple(Wall(start=(2.5, a), end=(2.5, b)) for a, b in ((0.0, 4.5), (5.5, 10.0)))
    grid = LayeredGrid.from_scene(Scene(bounds=(0.0, 0.0, 10.0, 10.0), walls=walls))
    assert shut_by(grid, (2.5, 5.0, 0.0, 0.4)) == [True]


def test_a_goal_that_is_taken_shuts_no_way() -> None:
    assert shut_by(doorway(0.5), (8.0, 5.0, 0.0, 0.4)) == [False]


def test_a_doorway_on_the_way_to_a_goal_that_is_taken_is_shut_by_who_stands_in_it() -> None:
    taker, door = (6.0, 5.0, 0.0, 0.4), (5.0, 5.0, 0.0, 0.4)
    assert shut_by(doorway(0.5), taker, door, goal=(6.0, 5.0)) == [False, True]


def test_ways_lead_around_places_as_if_they_were_solid() -> None:
    grid = LayeredGrid.from_scene(Scene.open_space((0.0, 0.0, 10.0, 10.0)))
    disc = (5.0, 5.0, 0.0, 1.0)
    free = Potential(grid, GOAL, 0.0, RADIUS_M)
    around = Potential(grid, GOAL, 0.0, RADIUS_M, shut=[disc])
    direct, detour = (float(p.distance([START], [0.0])[0]) for p in (free, around))
    # The shortest way around a disc: two tangents and an arc.
    reach = 1.0 + RADIUS_M
    tangent, angle = np.sqrt(9.0 - reach**2), np.arccos(reach / 3.0)
    shortest = 2.0 * tangent + (np.pi - 2.0 * angle) * reach
    assert direct == pytest.approx(6.0, abs=0.05)
    assert shortest - 0.1 <= detour <= shortest + 0.5


def test_no_way_leads_past_a_disc_where_less_than_the_body_is_left_beside_it() -> None:
    # A doorway across the cells, with 0.9 m between the disc's middle and its one side.
    (ax, ay), (bx, by), side = (5.07, 5.29), (5.95, 5.47), (7.0, 5.68)
    walls = (Wall(start=(0.0, 4.28), end=(ax, ay)), Wall(start=(bx, by), end=side))
    walls = (*walls, Wall(start=side, end=(12.0, 6.68)))
    scene = Scene(bounds=(0.0, 0.0, 12.0, 12.0), walls=walls)
    shut = [(bx, by, 0.0, 0.5)]
    potential = Potential(LayeredGrid.from_scene(scene), (5.5, 4.0), 0.0, RADIUS_M, shut=shut)
    starts = [(4.7, 6.3), (5.13, 5.67), (5.3, 6.0), (6.6, 6.4)]
    assert np.isinf(potential.distance(starts, [0.0] * 4)).all()
    assert np.isfinite(potential.distance([(5.5, 3.0)], [0.0])).all()


def test_a_way_that_discs_shut_is_none() -> None:
    grid = doorway(0.5)
    shut = Potential(grid, GOAL, 0.0, RADIUS_M, shut=[(5.0, 5.0, 0.0, 0.4)])
    assert not np.isfinite(shut.distance([START], [0.0])[0])
    assert np.isfinite(shut.distance([(7.0, 5.0)], [0.0])[0])


def test_a_potential_from_no_further_than_wanted_is_the_whole_one_there() -> None:
    grid = doorway(0.7)
    whole = Potential(grid, GOAL, 0.0, RADIUS_M).values[:, 0]
    part = Potential(grid, GOAL, 0.0, RADIUS_M, within_m=4.0)
    walkable = grid.arrays.kinds.steps[grid.row_of(Body.adult())] != 0
    reached = walkable & np.isfinite(part.values[:, 0])
    assert 0.1 < reached.mean() < 0.9
    assert np.array_equal(part.values[reached, 0], whole[reached])
    far_m = Potential(grid, GOAL, 0.0, RADIUS_M).distance([(1.0, 1.0)], [0.0])[0]
    assert far_m > 4.0
    assert not np.isfinite(part.distance([(1.0, 1.0)], [0.0])[0])
    assert part.distance([(6.0, 5.0)], [0.0])[0] == pytest.approx(2.0, abs=0.05)

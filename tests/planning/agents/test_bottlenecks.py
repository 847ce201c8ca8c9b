"""Keeping right at contested passages: the agents concerned, their lanes and priorities."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.planning import PASSAGE
from esplanade.planning.agents._bottleneck_kernels import (
    Lane,
    find_contested,
    off_lane_m,
    order_at_passages,
    see_passage,
)
from esplanade.planning.agents._decide_kernels import make_task
from esplanade.planning.agents.priorities import Priorities, Turn
from esplanade.planning.grid.grid import LayeredGrid
from esplanade.planning.routes.potential import Potential
from esplanade.planning.scene.scene import Scene
from tests.planning.agents.test_batch import crowd_of
from tests.planning.worlds import RULES, holds, open_grid

OPPOSED = 8
BEFORE_M = 20.0
AFTER_M = 4.0
PASSED_M = 8.0
NEARER_M = 0.5
WAITING_MPS = 0.2
LEFT_RAD = 1.0

EAST = Lane(8.0, 8.0, 1.0, 0.0, 0.3, 0.8, BEFORE_M, AFTER_M, 1.0)


def _naive_off_lane_m(lane: Lane, x: float, y: float) -> float:
    """The same by complex numbers, with the way through the passage along the real axis."""
    z = complex(x - lane.x, y - lane.y) / complex(lane.along_x, lane.along_y)
    near = (AFTER_M if z.real > 0.0 else BEFORE_M) - abs(z)
    left = z.imag + lane.shift_m
    if near <= 0.0 or left <= 0.0:
        return 0.0
    return lane.weight * near * min(1.0, math.atan2(left, abs(z.real)) / LEFT_RAD)


@given(st.floats(-25.0, 25.0), st.floats(-25.0, 25.0), st.floats(-3.2, 3.2), st.floats(0.1, 1.0))
@holds(200, 30)
def test_only_the_left_is_off_lane_m(x, y, turn, weight) -> None:
    lane = EAST._replace(along_x=math.cos(turn), along_y=math.sin(turn), weight=weight)
    assert off_lane_m(lane, x, y) == pytest.approx(_naive_off_lane_m(lane, x, y), abs=1e-9)
    assert off_lane_m(lane._replace(weight=0.0), x, y) == 0.0


def _facing(west: int, east: int):
    """Crowds on either side of one passage that all want to go through it."""
    places = [(4.0 - 0.1 * n, 8.0) for n in range(west)] + [(12.0, 8.0 + n) for n in range(east)]
    crowd = crowd_of(places, places)
    crowd.passages["middle_x"] = crowd.passages["middle_y"] = 8.0
    crowd.passages["along_x"] = [1.0] * west + [-1.0] * east
    crowd.passages["nearest_m"] = np.hypot(*(crowd.positions - 8.0).T)
    return crowd


def _walking(actors, left_m):
    """Everyone with the priority of the same distance left."""
    return Priorities(np.full(actors, int(Turn.WALKS)), np.full(actors, left_m))


def test_a_passage_is_contested_by_enough_who_come_against_one() -> None:
    crowd = _facing(OPPOSED - 1, OPPOSED)
    contested = np.ones(len(crowd.positions), dtype=bool)
    find_contested(crowd, RULES, contested)
    assert contested[: OPPOSED - 1].all(), "eight come against the west"
    assert not contested[OPPOSED - 1 :].any(), "seven come against the east"


def test_agents_that_have_come_through_contest_nothing() -> None:
    crowd = _facing(OPPOSED, OPPOSED)
    crowd.positions[-1] = (5.0, 8.0)
    contested = np.zeros(2 * OPPOSED, dtype=bool)
    find_contested(crowd, RULES, contested)
    assert not contested[:OPPOSED].any(), "seven still come against the west"
    assert contested[OPPOSED:].all()


def test_the_two_ends_of_a_long_passage_are_one() -> None:
    crowd = _facing(OPPOSED, OPPOSED)
    crowd.passages["middle_x"][:OPPOSED] -= 3.0
    contested = np.zeros(2 * OPPOSED, dtype=bool)
    find_contested(crowd, RULES, contested)
    assert contested.all()


@pytest.mark.parametrize(
    ("field", "apart_m"), [("middle_x", 7.0), ("middle_y", 3.0), ("floor_m", 3.0)]
)
def test_another_passage_or_floor_is_not_contested(field, apart_m) -> None:
    crowd = _facing(OPPOSED, OPPOSED)
    crowd.passages[field][:OPPOSED] -= apart_m
    contested = np.ones(2 * OPPOSED, dtype=bool)
    find_contested(crowd, RULES, contested)
    assert not contested.any()


def test_agents_that_have_come_through_go_first() -> None:
    crowd = _facing(OPPOSED, OPPOSED + 1)
    crowd.positions[-1] = (5.0, 8.0)
    contested = np.zeros(2 * OPPOSED + 1, dtype=bool)
    find_contested(crowd, RULES, contested)
    assert contested.all()
    contested[0] = False
    who = _walking(2 * OPPOSED + 1, 7.0)
    order_at_passages(crowd, RULES, contested, who)
    away = np.hypot(*(crowd.positions - 8.0).T)
    assert (who.turns[-1], who.keys_m[-1]) == (Turn.LEAVES_PASSAGE, pytest.approx(-3.0))
    assert (who.turns[1:-1] == Turn.ENTERS_PASSAGE).all()
    assert who.keys_m[1:-1] == pytest.approx(away[1:-1])
    assert (who.turns[0], who.keys_m[0]) == (Turn.WALKS, 7.0)
    who.turns[1] = Turn.SETTLED
    order_at_passages(crowd, RULES, contested, who)
    assert who.turns[1] == Turn.SETTLED, "an agent about to arrive on this side goes last"
    who.turns[-1] = Turn.SETTLED
    order_at_passages(crowd, RULES, contested, who)
    assert who.turns[-1] == Turn.LEAVES_PASSAGE, "on the other side it goes up to the goal first"


def test_waiting_in_vain_gives_priority() -> None:
    crowd = _facing(OPPOSED, OPPOSED)
    crowd.passages["nearest_m"] = 5.0
    crowd.passages["waited_s"] = np.random.default_rng(0).permutation(2 * OPPOSED)
    crowd.passages["nearest_m"][0] = 4.0
    who = _walking(2 * OPPOSED, 30.0)
    order_at_passages(crowd, RULES, np.ones(2 * OPPOSED, dtype=bool), who)
    waited_s = crowd.passages["waited_s"]
    assert who.keys_m[1:] == pytest.approx(5.0 - WAITING_MPS * waited_s[1:])
    assert who.keys_m[0] == pytest.approx(4.0 - WAITING_MPS * waited_s[0])
    waited_s[:] = 1e3
    order_at_passages(crowd, RULES, np.ones(2 * OPPOSED, dtype=bool), who)
    assert not who.keys_m.any(), "those who have waited for long enough go by their ranks"


def test_to_come_nearer_by_enough_ends_the_waiting() -> None:
    """Along a random walk: nearest and waited are those of the plain account."""
    walls = (((8.0, 0.1), (8.0, 7.0)), ((8.0, 9.0), (8.0, 15.9)))
    grid = LayeredGrid.from_scene(Scene.open_space((0.0, 0.0, 20.0, 16.0), walls=walls), 0.25)
    crowd = crowd_of([(3.0, 8.0)], [(19.0, 8.0)])
    crowd.potential_rows[:] = 0
    potential = Potential(grid, (19.0, 8.0), 0, 0.25).values
    random = np.random.default_rng(0)
    nearest, waited_s = math.inf, 0.0
    for _ in range(60):
        crowd.positions[0] = random.uniform((2.0, 6.0), (7.5, 10.0))
        crowd.cells[:] = grid.on_ground(crowd.positions, [0.0])[1]
        see_passage(grid.arrays, potential, RULES, crowd, 0, True, 0.1)
        away = math.dist(
            crowd.positions[0], (crowd.passages["middle_x"][0], crowd.passages["middle_y"][0])
        )
        waited_s += 0.1
        if away < nearest - NEARER_M:
            nearest, waited_s = away, 0.0
        assert crowd.passages["nearest_m"][0] == pytest.approx(nearest)
        assert crowd.passages["waited_s"][0] == pytest.approx(waited_s)


def test_a_passage_is_kept_until_one_is_well_beyond() -> None:
    walls = (((8.0, 0.1), (8.0, 7.0)), ((8.0, 9.0), (8.0, 15.9)))
    scene = Scene.open_space((0.0, 0.0, 20.0, 16.0), walls=walls)
    grid = LayeredGrid.from_scene(scene, 0.25)
    crowd = crowd_of([(3.0, 8.0)], [(19.0, 8.0)])
    crowd.potential_rows[:] = 0
    potentials = Potential(grid, (19.0, 8.0), 0, 0.25).values[None]
    seen = []
    for x in (3.0, 7.0, 9.0, 8.0 + PASSED_M - 0.5, 8.0 + PASSED_M + 0.5):
        crowd.positions[0, 0] = x
        crowd.cells[:] = grid.on_ground(crowd.positions, [0.0])[1]
        see_passage(grid.arrays, potentials[0], RULES, crowd, 0, True, 3.0)
        seen.append(bool(crowd.passages["along_x"][0]))
    assert seen == [True, True, True, True, False]
    crowd.positions[0, 0] = 3.0
    see_passage(grid.arrays, potentials[0], RULES, crowd, 0, False, 3.0)
    assert (crowd.passages == np.zeros(1, dtype=PASSAGE)).all()


def test_on_open_ground_nobody_has_a_passage() -> None:
    grid = open_grid(16.0)
    crowd = crowd_of([(3.0, 8.0), (4.0, 3.0)], [(12.0, 8.0)] * 2)
    crowd.potential_rows[:] = 0
    crowd.cells[:] = grid.on_ground(crowd.positions, [0.0, 0.0])[1]
    potentials = Potential(grid, (12.0, 8.0), 0, 0.25).values[None]
    for a in range(2):
        see_passage(grid.arrays, potentials[0], RULES, crowd, a, True, 0.1)
    for field in ("middle_x", "middle_y", "along_x", "along_y", "half_m", "floor_m"):
        assert not crowd.passages[field].any()


def test_neither_lanes_nor_order_depend_on_the_order_of_actors() -> None:
    random = np.random.default_rng(1)
    walls = (((8.0, 0.1), (8.0, 7.0)), ((8.0, 9.0), (8.0, 15.9)))
    grid = LayeredGrid.from_scene(Scene.open_space((0.0, 0.0, 16.0, 16.0), walls=walls), 0.25)
    goals = [(14.0, 8.0), (2.0, 8.0)]
    potentials = np.stack([Potential(grid, goal, 0, 0.25).values for goal in goals])
    places = random.uniform((1.0, 3.0), (15.0, 13.0), (40, 2))
    slots = random.integers(0, 2, 40)
    ranks = random.permutation(40)

    def decided(rows):
        crowd = crowd_of(places[rows], np.array(goals)[slots[rows]], ranks=ranks[rows])
        crowd.potential_rows[:] = slots[rows]
        crowd.cells[:] = grid.on_ground(crowd.positions, np.zeros(40))[1]
        who = Priorities(np.full(40, int(Turn.WALKS)), np.hypot(*(crowd.goals - crowd.positions).T))
        contested = np.zeros(40, dtype=bool)
        for a in range(40):
            potential = potentials[crowd.potential_rows[a]]
            see_passage(grid.arrays, potential, RULES, crowd, a, True, 0.1)
        find_contested(crowd, RULES, contested)
        order_at_passages(crowd, RULES, contested, who)
        return np.column_stack([crowd.passages.tolist(), *who, contested])

    rows = random.permutation(40)
    once, again = decided(np.arange(40)), decided(rows)
    assert once[:, -1].any()
    assert (once[rows] == again).all()


@pytest.mark.parametrize(("x", "weight"), [(6.0, 0.8), (9.0, 0.0)])
def test_an_agent_about_to_arrive_keeps_to_no_lane(x, weight) -> None:
    grid = open_grid(16.0)
    crowd = crowd_of([(x, 8.0)], [(12.0, 8.0)])
    crowd.potential_rows[:] = 0
    crowd.cells[:] = grid.on_ground(crowd.positions, [0.0])[1]
    for field, value in (("middle_x", 8.0), ("middle_y", 8.0), ("along_x", 1.0)):
        crowd.passages[field][0] = value
    potentials = Potential(grid, (12.0, 8.0), 0, 0.25).values[None]
    assert make_task(potentials, crowd, RULES, 0, 0.3, 0.1, True).lane.weight == weight
    assert make_task(potentials, crowd, RULES, 0, 0.3, 0.1, False).lane.weight == 0.0
    crowd.parameters["keep_right_weight"] = 0.0
    assert make_task(potentials, crowd, RULES, 0, 0.3, 0.1, True).lane.weight == 0.0

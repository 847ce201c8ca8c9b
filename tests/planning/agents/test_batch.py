"""A tick of decisions for many actors: symmetry, order, threads, and what must not touch."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.planning import (
    PARAMETERS,
    Agents,
    AgentTable,
    Batch,
    Decisions,
    LayeredGrid,
    PlanModel,
    RiskModel,
    RuleModel,
    Scene,
)
from esplanade.planning.agents._step_kernels import _separation
from esplanade.planning.agents.agents import ARRIVED, BLOCKED, GIVING_WAY, WAITING
from esplanade.planning.grid._grid_kernels import GridArrays
from esplanade.planning.routes.potential import Potential
from tests.planning.worlds import holds, open_grid, scaled, walking

TICK_S = 0.1
PLAN = PlanModel(threads=1)
BODY = {
    "radius_m": 0.25,
    "speed_mps": 1.3,
    "max_speed_mps": 1.7,
    "max_acceleration_mps2": 2.0,
    "goal_tolerance_m": 0.2,
    "person_room_m": 0.05,
    "contact_closing_s": 0.3,
    "risk_weight": 25.0,
    "foresight_s": 4.0,
    "closing_weight": 0.1,
    "turn_weight": 0.1,
    "wall_weight": 0.3,
    "hurry_weight": 2.0,
    "catch_up": 0.0,
    "stride": 1.0,
    "hysteresis_s": 0.15,
    "keep_right_weight": 0.8,
    "max_expansions": float(scaled(150, 30)),
    "height_m": 1.8,
    "step_on_m": 0.6,
    "leg_length_m": 0.9,
    "edge_cells": 24.0,
    "patience_s": 30.0,
}


def crowd_of(positions, goals, velocities=None, ranks=None, **changes) -> Agents:
    positions = np.array(positions, dtype=np.float64)
    actors = len(positions)
    row = np.array(tuple(BODY[name] for name in PARAMETERS.names or ()), dtype=PARAMETERS)
    table = AgentTable(PLAN.slices)
    nothing = np.zeros(actors, dtype=np.int64)
    table.add(
        range(actors),
        np.column_stack([positions, np.zeros(actors)]),
        np.repeat(row[None], actors),
        cells=nothing - 1,
        layers=nothing,
        headings=np.zeros(actors),
    )
    for name, value in changes.items():
        table.agents.parameters[name] = value
    return table.agents._replace(
        velocities=np.zeros((actors, 2)) if velocities is None else np.array(velocities),
        goals=np.array(goals, dtype=np.float64),
        potential_rows=np.arange(actors),
        ranks=np.arange(actors) if ranks is None else np.array(ranks),
    )


def guides_of(grid, crowd):
    return np.stack([
        Potential(grid, tuple(goal), 0, radius).values
        for goal, radius in zip(crowd.goals, crowd.parameters["radius_m"], strict=True)
    ])  # fmt: skip


@pytest.fixture
def batch():
    batch = Batch(open_grid(8.0), PLAN, RiskModel())
    yield batch
    batch.close()


def tick(batch, crowd, people=()):
    prediction = walking([p for p, _ in people], [v for _, v in people])
    crowd.cells[:] = batch.grid.on_ground(crowd.positions, np.zeros(len(crowd.positions)))[1]
    return decided(batch, crowd, guides_of(batch.grid, crowd), prediction)


def decided(batch, crowd, potentials, prediction):
    """Copies of the decisions and of the positions: the next tick writes them over."""
    decisions, positions, _ = batch.tick(crowd, potentials, prediction, TICK_S)
    return Decisions(*(array.copy() for array in decisions)), positions.copy()


def step(crowd, decisions, positions) -> None:
    """Update the state after a tick, as its owner does."""
    crowd.velocities[:] = (positions - crowd.positions) / TICK_S
    crowd.positions[:] = positions
    crowd.followed[decisions.renewed] = decisions.paths[decisions.renewed]
    crowd.ages[decisions.renewed] = 0
    crowd.ages[:] += 1
    crowd.known[:] = True


def around(points, turn, mirrored):
    """Points turned by quarter turns about (4, 4), and mirrored first where asked for."""
    out = np.array(points, dtype=np.float64).reshape(-1, 2) * ((1.0, -1.0) if mirrored else 1.0)
    for _ in range(turn):
        out = np.stack([-out[:, 1], out[:, 0]], axis=1)
    return out


@given(st.integers(0, 10_000), st.integers(0, 3), st.booleans())
@holds(12, 2)
def test_a_first_decision_turns_and_mirrors_with_the_world(seed, turn, mirrored) -> None:
    rng = np.random.default_rng(seed)
    start, goal = rng.uniform(-3.0, -1.0, (1, 2)), rng.uniform(1.0, 3.0, (1, 2))
    velocity = rng.normal(0.0, 0.5, (1, 2))
    where, way = rng.uniform(-2.0, 2.0, (2, 2)), rng.normal(0.0, 0.6, (2, 2))
    wishes = []
    batch = Batch(open_grid(8.0), PLAN, RiskModel())
    for t, m in ((0, False), (turn, mirrored)):
        ends = (4.0 + around(start, t, m), 4.0 + around(goal, t, m))
        crowd = crowd_of(*ends, around(velocity, t, m))
        people = list(zip(4.0 + around(where, t, m), around(way, t, m), strict=True))
        decisions, positions = tick(batch, crowd, people)
        wishes.append((decisions.wishes, positions - 4.0))
    batch.close()
    assert around(wishes[0][0], turn, mirrored) == pytest.approx(wishes[1][0], abs=2e-3)
    assert around(wishes[0][1], turn, mirrored) == pytest.approx(wishes[1][1], abs=2e-4)


def some(seed, actors):
    rng = np.random.default_rng(seed)
    cells = rng.permutation(49)[: 2 * actors]
    spots = 1.0 + np.stack([cells % 7, cells // 7], axis=1)
    spots = spots + rng.uniform(-0.15, 0.15, spots.shape)
    people = list(zip(rng.uniform(1.0, 7.0, (3, 2)), rng.normal(0.0, 0.8, (3, 2)), strict=True))
    return spots[:actors], spots[actors:], people


def run(seed, actors, ticks, threads=1, order=None):
    """Positions after so many ticks, row by row as they were before being reordered."""
    starts, goals, people = some(seed, actors)
    order = np.arange(actors) if order is None else order
    batch = Batch(open_grid(8.0), PlanModel(threads=threads), RiskModel())
    crowd = crowd_of(starts[order], goals[order], ranks=order)
    for _ in range(ticks):
        decisions, positions = tick(batch, crowd, people)
        step(crowd, decisions, positions)
        people = [(np.add(p, np.multiply(TICK_S, v)), v) for p, v in people]
    batch.close()
    back = np.argsort(order)
    return crowd.positions[back], decisions.paths[back], decisions.reasons[back]


@pytest.mark.parametrize("seed", [1, 2])
def test_neither_threads_nor_rows_matter_bit_for_bit(seed) -> None:
    actors, ticks = scaled(10, 3), scaled(12, 2)
    once = run(seed, actors, ticks)
    shuffled = np.random.default_rng(seed).permutation(actors)
    for other in (
        run(seed, actors, ticks, threads=2),
        run(seed, actors, ticks, threads=3),
        run(seed, actors, ticks, order=shuffled),
    ):
        for a, b in zip(once, other, strict=True):
            assert np.array_equal(a, b)


@pytest.mark.parametrize("seed", range(scaled(3, 1)))
@pytest.mark.parametrize(("radius_m", "speed_mps"), [(0.25, 1.7), (0.34, 4.0)])
def test_actors_never_touch_and_keep_their_limits(seed, radius_m, speed_mps) -> None:
    actors = scaled(10, 3)
    starts, goals, people = some(seed, actors)
    batch = Batch(open_grid(8.0), PLAN, RiskModel())
    crowd = crowd_of(starts, goals, radius_m=radius_m, max_speed_mps=speed_mps)
    nearest = math.inf
    for _ in range(scaled(60, 2)):
        before = crowd.velocities.copy()
        decisions, positions = tick(batch, crowd, people)
        speeds = np.hypot(*(positions - crowd.positions).T) / TICK_S
        assert (speeds <= speed_mps + 1e-6).all()
        change = np.hypot(*(decisions.wishes - before).T)
        assert (change <= 2.0 * TICK_S + 1e-9).all()
        step(crowd, decisions, positions)
        away = np.hypot(*(positions[:, None] - positions[None]).transpose(2, 0, 1))
        nearest = min(nearest, away[~np.eye(actors, dtype=bool)].min())
        assert ((positions >= 0.0) & (positions <= 8.0)).all()
    batch.close()
    assert nearest >= 2.0 * crowd.parameters["radius_m"][0]


def test_fast_wide_actors_see_each_other_in_time(batch) -> None:
    """Both would meet within one tick although they are more than a metre and a half apart."""
    crowd = crowd_of(
        [(3.0, 4.0), (4.7, 4.0)],
        [(7.0, 4.0), (1.0, 4.0)],
        velocities=[(4.0, 0.0), (-4.0, 0.0)],
        radius_m=0.5,
        max_speed_mps=4.0,
        speed_mps=3.0,
        max_acceleration_mps2=0.2,
    )
    _, positions = tick(batch, crowd)
    assert math.dist(*positions) >= 1.0


def test_who_is_told_to_be_slow_while_it_runs_is_seen_in_time(batch) -> None:
    """Braking takes a while: steps are longer than the new greatest speed allows.

    The edge of a bucket lies between the two.
    """
    crowd = crowd_of(
        [(2.225, 4.0), (3.425, 4.0)],
        [(7.0, 4.0), (1.0, 4.0)],
        velocities=[(4.0, 0.0), (-4.0, 0.0)],
        max_speed_mps=0.2,
        speed_mps=0.2,
        max_acceleration_mps2=0.2,
    )
    _, positions = tick(batch, crowd)
    assert math.dist(*positions) >= 0.5


def test_expansions_stay_within_the_budget(batch) -> None:
    crowd = crowd_of([(1.0, 4.0)], [(7.0, 4.0)], max_expansions=10)
    decisions, _ = tick(batch, crowd, [((4.0, 4.0), (-0.5, 0.0)), ((4.0, 4.6), (-0.5, 0.0))])
    assert 0 < decisions.expansions[0] <= 10


def test_the_last_check_gives_way_to_who_is_about_to_be_touched(batch) -> None:
    crowd = crowd_of([(4.0, 4.0)], [(7.0, 4.0)], velocities=[(1.3, 0.0)])
    free, _ = tick(batch, crowd)
    checked, positions = tick(batch, crowd, [((4.62, 4.0), (0.0, 0.0))])
    assert checked.wishes[0, 0] < free.wishes[0, 0] - 0.1
    assert math.dist(positions[0], (4.62, 4.0)) > 0.5


def test_the_last_check_minds_who_has_just_turned(batch) -> None:
    """By the mean of eq. (1) they still part; by the newest velocity they are about to touch."""
    crowd = crowd_of([(4.0, 4.0)], [(7.0, 4.0)], velocities=[(1.3, 0.0)])
    crowd.cells[:] = batch.grid.on_ground(crowd.positions, np.zeros(1))[1]
    prediction = walking([(5.5, 4.0)], [(1.0, 0.0)])
    parting, _ = decided(batch, crowd, guides_of(batch.grid, crowd), prediction)
    prediction.newest[0] = (-1.0, 0.0)
    turned, _ = decided(batch, crowd, guides_of(batch.grid, crowd), prediction)
    assert parting.reasons[0] != GIVING_WAY
    assert turned.reasons[0] == GIVING_WAY
    assert parting.wishes[0] == pytest.approx([1.3, 0.0])
    assert turned.wishes[0, 0] < 1.2


@pytest.mark.parametrize("closing_s", [0.0, 0.3, 1.0])
def test_to_walk_into_somebody_is_worse_than_to_be_walked_into(closing_s) -> None:
    """Both come as close, in the same time; only the actor that moves is to blame for it."""
    ahead = walking([(4.8, 4.0)], [(0.0, 0.0)])
    coming = walking([(4.8, 4.0)], [(-1.0, 0.0)])
    near = np.array([0])
    going = _separation(ahead, near, 0.0, 0.4, 0.55, closing_s, True, 4.0, 4.0, 4.4, 4.0)
    standing = _separation(coming, near, 0.0, 0.4, 0.55, closing_s, True, 4.0, 4.0, 4.0, 4.0)
    assert standing == pytest.approx(0.4)
    assert going == pytest.approx(0.4 - closing_s)
    clear = _separation(ahead, near, 0.0, 0.2, 0.55, closing_s, True, 4.0, 4.0, 4.2, 4.0)
    assert clear == pytest.approx(0.6)


def reason_of(batch, crowd, ticks=1, people=()) -> int:
    for _ in range(ticks):
        decisions, positions = tick(batch, crowd, people)
        step(crowd, decisions, positions)
    return int(decisions.reasons[0])


def test_without_a_goal_an_actor_stands_and_makes_way(batch) -> None:
    crowd = crowd_of([(4.0, 4.0)], [(7.0, 4.0)])
    crowd.potential_rows[0] = -1
    assert reason_of(batch, crowd, 2) == WAITING
    assert crowd.positions[0] == pytest.approx([4.0, 4.0], abs=1e-6)
    for k in range(4):
        people = [((4.9 - 0.12 * k, 4.1), (-1.2, 0.0))]
        decisions, positions = tick(batch, crowd, people)
        step(crowd, decisions, positions)
    assert math.dist(crowd.positions[0], (4.0, 4.0)) > 0.02


def test_at_its_goal_an_actor_has_arrived_and_stays(batch) -> None:
    crowd = crowd_of([(4.0, 4.0)], [(4.05, 4.0)])
    assert reason_of(batch, crowd, 3) == ARRIVED
    assert math.dist(crowd.positions[0], (4.05, 4.0)) < 0.1


@pytest.mark.parametrize("start", [(1.0, 1.0), (5.0, 1.0), (1.0, 5.0)])
def test_behind_walls_there_is_no_way(start) -> None:
    room = [
        ((4.0, 4.0), (6.0, 4.0)),
        ((6.0, 4.0), (6.0, 6.0)),
        ((6.0, 6.0), (4.0, 6.0)),
        ((4.0, 6.0), (4.0, 4.0)),
    ]
    batch = Batch(open_grid(8.0, room), PLAN, RiskModel())
    crowd = crowd_of([start], [(5.0, 5.0)])
    assert reason_of(batch, crowd, 2) == BLOCKED
    assert crowd.positions[0] == pytest.approx(start, abs=1e-6)
    batch.close()


def test_who_is_not_due_goes_on_along_the_path_that_it_has(batch) -> None:
    """It is the search that is left out: people who come near are evaded all the same."""
    crowd = crowd_of([(2.0, 3.0), (2.0, 5.0)], [(7.0, 3.0), (7.0, 5.0)])
    guides = guides_of(batch.grid, crowd)
    nobody = walking([], [])
    for _ in range(6):
        crowd.cells[:] = batch.grid.on_ground(crowd.positions, np.zeros(2))[1]
        step(crowd, *decided(batch, crowd, guides, nobody))
    crowd.cells[:] = batch.grid.on_ground(crowd.positions, np.zeros(2))[1]
    due = np.array([True, False])
    ahead = crowd.positions + np.array([0.7, 0.0])
    for people in (nobody, walking(ahead, np.zeros((2, 2)))):
        decisions, _, _ = batch.tick(crowd, guides, people, TICK_S, due)
        assert np.array_equal(decisions.replanned, due)
        assert np.array_equal(decisions.paths[1], batch.zone.world.reservations.paths[1])
        assert not decisions.renewed[1]
        assert decisions.expansions[1] == 0
    assert decisions.expansions[0] > 0
    assert decisions.wishes[1, 0] < crowd.velocities[1, 0] - 0.1
    crowd.known[1] = False
    decisions, _, _ = batch.tick(crowd, guides, people, TICK_S, due)
    assert decisions.replanned.all()


@pytest.mark.parametrize("slices", [0, 6])
def test_whose_path_is_soon_illegal_is_planned_though_it_is_not_due(slices) -> None:
    """Somebody of higher priority stands in the way all at once, a second ahead of the one."""
    batch = Batch(open_grid(8.0), PLAN, RiskModel(), rules=RuleModel(checked_slices=slices))
    crowd = crowd_of([(7.0, 7.0), (2.0, 3.0), (2.0, 5.0)], [(6.4, 7.0), (7.0, 3.0), (7.0, 5.0)])
    guides = guides_of(batch.grid, crowd)
    nobody = walking([], [])
    for _ in range(6):
        crowd.cells[:] = batch.grid.on_ground(crowd.positions, np.zeros(3))[1]
        step(crowd, *decided(batch, crowd, guides, nobody))
    crowd.positions[0] = crowd.positions[1] + np.array([1.2, 0.0])
    crowd.goals[0] = crowd.positions[0] + np.array([1.1, 0.0])
    guides = guides_of(batch.grid, crowd)
    crowd.known[0] = False
    crowd.cells[:] = batch.grid.on_ground(crowd.positions, np.zeros(3))[1]
    decisions, _, _ = batch.tick(crowd, guides, nobody, TICK_S, np.zeros(3, dtype=bool))
    assert decisions.replanned.tolist() == [True, slices > 0, False]
    assert decisions.renewed[1] == (slices > 0)
    batch.close()


def test_an_old_path_is_read_on_and_lengthened(batch) -> None:
    """A path that is almost over goes on straight down the potential."""
    crowd = crowd_of([(1.0, 4.0)], [(7.0, 4.0)], velocities=[(1.3, 0.0)])
    seconds = 0.2 * np.arange(PLAN.slices + 1)
    crowd.followed[0, :, 0] = 1.0 + 1.3 * np.minimum(seconds, 1.0)
    crowd.followed[0, :, 1] = 4.0
    crowd.known[0] = True
    crowd.ages[0] = 0
    decisions, _ = tick(batch, crowd)
    assert decisions.renewed[0]
    crowd.ages[0] = 30
    decisions, _ = tick(batch, crowd)
    assert decisions.paths[0, -1, 0] > 4.0


def test_a_batch_that_has_ticked_before_decides_like_a_new_one(batch) -> None:
    """The arrays that it has handed over to compiled code are never out of date."""
    ends = [(1.0, 4.0), (2.0, 5.0)], [(7.0, 4.2), (6.0, 2.0)]
    crowd = crowd_of(*ends)
    people = [((4.0 + 0.3 * k, 4.0), (-0.5, 0.1 * k)) for k in range(6)]
    grid = batch.grid
    potentials = guides_of(grid, crowd)
    crowd.cells[:] = grid.on_ground(crowd.positions, np.zeros(2))[1]
    room = GridArrays(*grid.arrays)
    slow = {"max_speed_mps": 1.0, "speed_mps": 0.6}
    for changes in ({}, {"radius_m": 0.4}, {"max_speed_mps": 3.0}, {"max_expansions": 200.0}, slow):
        for many in (0, 2, 6):
            for name, value in changes.items():
                crowd.parameters[name] = value
            prediction = walking([p for p, _ in people[:many]], [v for _, v in people[:many]])
            again, positions = decided(batch, crowd, potentials, prediction)
            fresh = Batch(grid, PLAN, RiskModel())
            anew, expected = decided(fresh, crowd, potentials, prediction)
            fresh.close()
            assert all(np.array_equal(a, b) for a, b in zip(again, anew, strict=True)), changes
            assert np.array_equal(positions, expected)
    grid.arrays = room._replace(clearance=np.full_like(room.clearance, 0.1))
    walled_in, _ = tick(batch, crowd)
    assert not np.array_equal(walled_in.paths, again.paths)
    one = crowd_of(ends[0][:1], ends[1][:1])
    assert tick(batch, one, people)[0].paths.shape == (1, PLAN.slices + 1, 2)


def test_a_prediction_of_other_slices_is_refused_in_every_tick(batch) -> None:
    crowd = crowd_of([(1.0, 4.0)], [(7.0, 4.0)])
    tick(batch, crowd, [((4.0, 4.0), (0.0, 0.0))])
    short = walking([(4.0, 4.0)], [(0.0, 0.0)], slices=4)
    with pytest.raises(ValueError, match="prediction 5"):
        batch.tick(crowd, guides_of(batch.grid, crowd), short, TICK_S)


def test_an_error_in_a_thread_comes_up(batch) -> None:
    def work(k: int) -> None:
        raise RuntimeError("no such kernel")

    with pytest.raises(RuntimeError, match="no such kernel"):
        batch._on_threads(work, 2)


def at_a_doorway(rows, threads):
    """Nine a side before a doorway in the wall x = 8, all of whom want through, after a while."""
    walls = (((8.0, 0.1), (8.0, 7.0)), ((8.0, 9.0), (8.0, 15.9)))
    grid = LayeredGrid.from_scene(Scene.open_space((0.0, 0.0, 16.0, 16.0), walls=walls), 0.25)
    batch = Batch(grid, PlanModel(threads=threads), RiskModel())
    west = np.array([(5.0 + 0.7 * (n // 3), 7.0 + 1.0 * (n % 3)) for n in range(9)])
    places = np.concatenate([west, (16.0, 16.0) - west])
    goals = np.repeat([(14.0, 8.0), (2.0, 8.0)], 9, axis=0)
    crowd = crowd_of(places[rows], goals[rows], ranks=rows)
    crowd.potential_rows[:] = rows // 9
    potentials = np.stack(
        [Potential(grid, goal, 0, 0.25).values for goal in ((14.0, 8.0), (2.0, 8.0))]
    )
    for _ in range(scaled(10, 4)):
        crowd.cells[:] = grid.on_ground(crowd.positions, np.zeros(18))[1]
        step(crowd, *decided(batch, crowd, potentials, walking([], [])))
    batch.close()
    return crowd


def test_at_a_contested_doorway_actors_keep_right_whatever_their_order_and_threads() -> None:
    crowd = at_a_doorway(np.arange(18), 1)
    assert np.allclose(crowd.passages["middle_x"], 8.0, rtol=0.0, atol=0.3)
    assert np.allclose(crowd.passages["middle_y"], 8.0, rtol=0.0, atol=0.3)
    to_the_right = np.where(np.arange(18) < 9, -1.0, 1.0) * crowd.velocities[:, 1]
    assert to_the_right.mean() > 0.05
    rows = np.random.default_rng(0).permutation(18)
    for threads in (1, 2, 3):
        other = at_a_doorway(rows, threads)
        assert np.array_equal(other.positions, crowd.positions[rows])
        assert np.array_equal(other.passages, crowd.passages[rows])


@pytest.mark.parametrize(
    ("name", "value"),
    [("radius_m", 0.4), ("max_speed_mps", 3.0), ("max_expansions", 5000.0)],
)
def test_a_zone_is_handed_over_anew_when_more_is_asked_and_only_then(batch, name, value) -> None:
    crowd = crowd_of([(1.0, 4.0), (2.0, 5.0)], [(7.0, 4.2), (6.0, 2.0)])
    crowd.cells[:] = batch.grid.on_ground(crowd.positions, np.zeros(2))[1]
    potentials, nobody = guides_of(batch.grid, crowd), walking([], [])
    zones = []
    for _ in range(2):
        for _ in range(2):
            batch.tick(crowd, potentials, nobody, TICK_S)
            zones.append(batch._zone)
        crowd.parameters[name] = value
    assert zones[0] is zones[1]
    assert zones[1] is not zones[2]
    assert zones[2] is zones[3]

"""Search in CT-space against a plain twin; statuses, budgets and the amount of work."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from esplanade.planning import SearchForm, SearchStatus, uncertain_bfp
from esplanade.planning.agents._branch_kernels import Moves
from esplanade.planning.agents._cost_kernels import room_for_near
from esplanade.planning.agents._perturb_kernels import path_cost
from esplanade.planning.agents._task_kernels import advance
from esplanade.planning.agents.search import compass_moves, lattice_moves
from esplanade.planning.routes.potential import Potential
from tests.naive import search as naive
from tests.planning.worlds import (
    STEP_S,
    field_of,
    holds,
    open_grid,
    points,
    reserved,
    scaled,
    standing,
    task,
    walking,
    world_of,
)

WALLS = [((3.0, 1.0), (3.0, 4.5)), ((5.0, 3.5), (5.0, 7.0))]
ROOM = [
    ((4.0, 3.0), (6.0, 3.0)),
    ((6.0, 3.0), (6.0, 5.0)),
    ((6.0, 5.0), (4.0, 5.0)),
    ((4.0, 5.0), (4.0, 3.0)),
]


def relative_moves(speed=1.3, fastest=1.7) -> Moves:
    table = compass_moves()
    return table._replace(speeds=np.where(table.speeds > 1.0, fastest, table.speeds * speed))


def lopsided_moves() -> Moves:
    """Left turns a little wider than right ones.

    Mirrored moves cost the same where nobody is near; rounding would decide which goes first.
    """
    table = relative_moves()
    turns = np.arctan2(table.sines, table.cosines) * np.where(table.sines > 0.0, 1.01, 1.0)
    return table._replace(cosines=np.cos(turns), sines=np.sin(turns))


def ground_of(question, steps=12, walls=(), people=(), others=None):
    grid = open_grid(8.0, walls)
    crowd = walking([p for p, _ in people], [v for _, v in people], slices=2 * steps)
    field = field_of(grid, crowd, slices=2 * steps)
    potential = Potential(grid, (question.goal_x, question.goal_y), 0, question.radius_m)
    if others is None:
        others = reserved(grid, np.full((1, 2 * steps + 1, 2), -1e3))
    return naive.Ground(grid, field, potential, others, standing(grid, question), STEP_S)


def found(ground, moves=None, form=SearchForm.ACCUMULATED, bound=math.inf, illegal=None):
    return uncertain_bfp(
        ground.field,
        ground.potential,
        ground.task,
        moves or relative_moves(),
        ground.reservations,
        ground.step_s,
        form,
        bound,
        illegal,
    )


def same_as_twin(ground, moves, form, bound=math.inf, illegal=None):
    ours = found(ground, moves, form, bound, illegal)
    steps = ground.field.slices // 2
    accumulate = form is SearchForm.ACCUMULATED
    known = None
    if illegal is not None:
        cost = priced(ground, illegal)
        known = naive.Known(illegal, cost.legal_steps, cost.seconds)
    status, path, expansions = naive.search(ground, moves, steps, accumulate, bound, known)
    assert ours.status == status
    assert ours.expansions == expansions
    assert ours.path == pytest.approx(path, abs=1e-6)
    return ours


def priced(ground, path):
    world = world_of(ground.field.grid, ground.field, ground.reservations)
    return path_cost(world, ground.potential.values, ground.task, path, room_for_near())


spots = st.tuples(st.floats(0.5, 2.5), st.floats(0.5, 7.5))
ends = st.tuples(st.floats(5.5, 7.5), st.floats(0.5, 7.5))
speeds = st.tuples(st.floats(-1.5, 1.5), st.floats(-1.5, 1.5))
people = st.lists(
    st.tuples(st.tuples(st.floats(1.0, 7.0), st.floats(1.0, 7.0)), speeds), max_size=4
)


@pytest.mark.parametrize("form", list(SearchForm))
@given(start=spots, goal=ends, crowd=people, walled=st.booleans())
@holds(15, 3)
def test_both_forms_are_their_twins(form, start, goal, crowd, walled) -> None:
    question = task(start, goal, max_expansions=40)
    ground = ground_of(question, 5, WALLS if walled else (), crowd)
    same_as_twin(ground, lopsided_moves(), form)


@given(start=spots, goal=ends, crowd=people, slack=st.floats(-1.0, 1.0))
@holds(15, 3)
def test_a_bound_holds_and_saves_work(start, goal, crowd, slack) -> None:
    ground = ground_of(task(start, goal, max_expansions=5000), 5, (), crowd)

    def cost(path) -> float:
        return priced(ground, path).seconds

    free = found(ground)
    bound = cost(free.path) + slack
    bounded = found(ground, bound=bound)
    assert bounded.expansions <= free.expansions or free.status is not SearchStatus.FOUND
    if bounded.status is SearchStatus.FOUND:
        # The search adds the same up in another order.
        assert cost(bounded.path) < bound + 1e-9


@given(
    start=spots, goal=ends, crowd=people, walled=st.booleans(), v=speeds, seed=st.integers(0, 99)
)
@holds(60, 5)
def test_a_path_costs_what_the_search_added_up(start, goal, crowd, walled, v, seed) -> None:
    rng = np.random.default_rng(seed)
    others = rng.uniform(1.0, 7.0, (4, 1, 2)) + 0.2 * np.arange(11)[None, :, None] * rng.uniform(
        -1.0, 1.0, (4, 1, 2)
    )
    held = reserved(open_grid(8.0), others, [0.25] * 4, rng.permutation(4))
    held.held_up[:], held.courses[:] = True, ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.6, 0.8))
    question = task(start, goal, v)
    ground = ground_of(question, 5, WALLS if walled else (), crowd, held)
    result = found(ground)
    if result.status is SearchStatus.FOUND:
        again = priced(ground, result.path).seconds
        assert result.cost_s == pytest.approx(again, abs=1e-12)


@given(start=spots, goal=ends, crowd=people, slack=st.floats(-0.5, 3.0))
@example(start=(1.0, 0.8125), goal=(6.0, 0.5), crowd=[((2.0, 1.0), (-1.0, 1.0))], slack=2.0)
@holds(15, 3)
def test_a_bounded_search_is_its_twin(start, goal, crowd, slack) -> None:
    ground = ground_of(task(start, goal, max_expansions=40), 5, (), crowd)
    bound = ground.seconds_left(start) + slack
    same_as_twin(ground, lopsided_moves(), SearchForm.ACCUMULATED, bound)


@given(start=spots, goal=ends, crowd=people)
@holds(15, 2)
def test_on_the_lattice_too(start, goal, crowd) -> None:
    """From a cell's centre: on an edge, rounding decides which cell a move ends in."""
    centre = tuple(0.25 * math.floor(4.0 * x) + 0.125 for x in start)
    question = task(centre, goal, max_speed_mps=0.9, max_expansions=60)
    same_as_twin(
        ground_of(question, 8, WALLS, crowd), lattice_moves(0.25, STEP_S, 0.9), SearchForm.PRINTED
    )


@given(goal=ends, crowd=people, away=points(-0.5, 0.5))
@holds(10, 2)
def test_and_for_who_stays_where_it_is(goal, crowd, away) -> None:
    goal = (goal[0] + 0.0137, goal[1] + 0.0071)  # moves along an edge of cells would be a toss-up
    question = task((goal[0] + away[0], goal[1] + away[1]), goal, max_expansions=40, hold=True)
    same_as_twin(ground_of(question, 5, (), crowd), lopsided_moves(), SearchForm.ACCUMULATED)


@given(goal=ends, crowd=people, away=points(-0.9, 0.9), v=speeds)
@holds(15, 3)
def test_and_for_who_arrives(goal, crowd, away, v) -> None:
    goal = (goal[0] + 0.0137, goal[1] + 0.0071)
    question = task((goal[0] + away[0], goal[1] + away[1]), goal, v, max_expansions=40)
    ground = ground_of(question, 5, (), crowd)
    result = same_as_twin(ground, lopsided_moves(), SearchForm.ACCUMULATED)
    if result.status is SearchStatus.FOUND:
        assert result.cost_s == pytest.approx(priced(ground, result.path).seconds, abs=1e-9)


def test_whoever_comes_to_the_goal_after_the_arrival_costs_nothing() -> None:
    """The trip has ended by then; one that stays at a place for good minds whoever comes there."""
    comes = [((6.0, 0.6), (0.0, 1.2))]
    path = np.column_stack([np.minimum(6.0, 5.0 + 0.26 * np.arange(19)), np.full(19, 4.0)])

    def seconds(hold, crowd) -> float:
        question = task((5.0, 4.0), (6.0, 4.0), (1.3, 0.0), hold=hold)
        return priced(ground_of(question, 9, (), crowd), path).seconds

    assert seconds(False, comes) == seconds(False, [])
    assert seconds(True, comes) > seconds(True, []) + 0.5


@given(goal=ends, crowd=people)
@holds(5, 1)
def test_and_for_who_minds_nobody(goal, crowd) -> None:
    goal = (goal[0] + 0.0137, goal[1] + 0.0071)
    question = task((1.0137, 4.0071), goal, risk_weight=0.0, max_expansions=40)
    same_as_twin(ground_of(question, 5, (), crowd), lopsided_moves(), SearchForm.ACCUMULATED)


@given(st.integers(0, 1000))
@holds(8, 2)
def test_and_among_certain_obstacles(seed) -> None:
    rng = np.random.default_rng(seed)
    start, goal = rng.uniform(1.0, 3.0, 2), rng.uniform(5.0, 7.0, 2)
    begin = np.concatenate([[start], rng.uniform(1.0, 7.0, (3, 2))])
    velocity = rng.uniform(-1.0, 1.0, (4, 2))
    paths = begin[:, None] + 0.2 * np.arange(11)[None, :, None] * velocity[:, None]
    others = reserved(open_grid(8.0), paths, [0.25] * 4, rng.permutation(4))
    question = task(tuple(start), tuple(goal), max_expansions=40)
    same_as_twin(ground_of(question, 5, others=others), lopsided_moves(), SearchForm.ACCUMULATED)


def crossed(seed):
    """The ground of one whose way others may cross, and the path that leads straight on."""
    rng = np.random.default_rng(seed)
    start = (1.0, rng.uniform(3.0, 5.0))
    slices = 0.2 * np.arange(11)[:, None]
    straight = np.array(start) + slices * (1.3, 0.0)
    begin = rng.uniform((1.5, 1.0), (5.0, 7.0), (5, 2))
    paths = begin[:, None] + slices[None] * rng.uniform(-1.0, 1.0, (5, 1, 2))
    paths = np.concatenate([straight[None], paths])
    others = reserved(open_grid(8.0), paths, [0.25] * 6, [5, 0, 1, 2, 3, 4])
    question = task(start, (7.0137, 4.0071), (1.3, 0.0), max_expansions=40)
    return ground_of(question, 5, others=others), straight


@given(st.integers(0, 1000))
@holds(25, 4)
def test_a_search_that_goes_on_from_an_illegal_path_is_its_twin(seed) -> None:
    ground, straight = crossed(seed)
    result = same_as_twin(ground, lopsided_moves(), SearchForm.ACCUMULATED, illegal=straight)
    if result.status is SearchStatus.FOUND:
        assert result.cost_s == pytest.approx(priced(ground, result.path).seconds, abs=1e-9)


def test_going_on_from_the_legal_steps_of_a_path_saves_work() -> None:
    fresh = gone_on = 0
    for seed in range(12):
        ground, straight = crossed(seed)
        if not priced(ground, straight).legal:
            fresh += found(ground).expansions
            gone_on += found(ground, illegal=straight).expansions
    assert 0 < 2 * gone_on < fresh


@given(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0), speeds, st.floats(0.01, 1.0))
@holds(40, 10)
def test_advance_is_a_velocity_that_changes_evenly(ux, uy, v, seconds) -> None:
    a_max, n = 2.0, 2000
    place, velocity = np.zeros(2), np.array(v)
    for _ in range(n):
        change = np.array([ux, uy]) - velocity
        most = a_max * seconds / n
        before = velocity
        velocity = velocity + change * min(1.0, most / max(math.hypot(*change), 1e-12))
        place = place + 0.5 * (before + velocity) * seconds / n
    x, y, vx, vy = advance(0.0, 0.0, *v, ux, uy, a_max, seconds)
    assert (x, y) == pytest.approx(place, abs=1e-5)
    assert (vx, vy) == pytest.approx(velocity, abs=1e-5)


def test_in_the_open_the_way_is_straight_and_costs_a_dozen_expansions() -> None:
    question = task((1.125, 4.125), (7.375, 4.125), velocity=(1.3, 0.0))
    result = found(ground_of(question))
    assert result.status is SearchStatus.FOUND
    assert result.expansions <= 16
    assert np.abs(result.path[:, 1] - 4.125).max() < 1e-5
    assert result.path[-1, 0] == pytest.approx(1.125 + 4.8 * 1.3, abs=0.2)


@pytest.mark.parametrize("seed", range(scaled(6, 1)))
def test_among_people_the_work_stays_within_the_budget(seed) -> None:
    rng = np.random.default_rng(seed)
    crowd = list(zip(rng.uniform(2.0, 6.0, (4, 2)), rng.normal(0.0, 0.8, (4, 2)), strict=True))
    result = found(ground_of(task((0.5, 4.0), (7.5, 4.0)), people=crowd))
    assert result.status in {SearchStatus.FOUND, SearchStatus.PARTIAL}
    assert result.expansions <= 400
    assert result.path[-1, 0] > 2.0


def test_a_path_keeps_the_speed_limit_and_the_walls() -> None:
    ground = ground_of(
        task((1.0, 3.0), (7.0, 5.0)), walls=WALLS, people=[((4.0, 5.0), (0.0, -0.5))]
    )
    result = found(ground)
    moved = np.hypot(*np.diff(result.path, axis=0).T)
    assert moved.max() <= 1.7 * STEP_S / 2 + 1e-9
    heights = np.zeros(len(result.path))
    assert ground.grid.is_free(result.path, heights, 0.25 - 1e-5).all()


@pytest.mark.parametrize("form", list(SearchForm))
def test_a_tiny_budget_gives_the_best_so_far(form) -> None:
    result = found(ground_of(task((1.0, 4.0), (7.0, 4.0), max_expansions=3)), form=form)
    assert result.status is SearchStatus.PARTIAL
    assert result.expansions == 3
    assert 1.0 < result.path[-1, 0] < 3.0


@pytest.mark.parametrize("form", list(SearchForm))
def test_into_a_closed_room_there_is_no_path(form) -> None:
    result = found(ground_of(task((1.0, 4.0), (5.0, 4.0)), walls=ROOM), form=form)
    assert result.status is SearchStatus.NO_PATH
    assert result.expansions == 0
    assert (result.path == (1.0, 4.0)).all()


def test_where_every_move_is_taken_there_is_no_path() -> None:
    around = [(1.0, 4.0)]
    around += [(1.0 + 0.55 * math.cos(t), 4.0 + 0.55 * math.sin(t)) for t in np.arange(6) * 1.0472]
    paths = np.repeat(np.array(around)[:, None], 25, axis=1)
    # They close in, so that even standing is a meeting.
    paths[1:, 1:] += 0.1 * (paths[:1, 1:] - paths[1:, 1:])
    others = reserved(open_grid(8.0), paths, [0.25] * 7, [6, 0, 1, 2, 3, 4, 5])
    result = found(ground_of(task((1.0, 4.0), (7.0, 4.0)), others=others))
    assert result.status is SearchStatus.NO_PATH
    assert result.expansions == 1


def test_the_printed_form_goes_from_cell_to_cell() -> None:
    start, goal = (1.125, 4.125), (4.125, 4.125)
    question = task(start, goal, max_acceleration_mps2=1e6, speed_mps=0.6, max_speed_mps=0.9)
    result = found(ground_of(question, 16), lattice_moves(0.25, STEP_S, 0.9), SearchForm.PRINTED)
    assert result.status is SearchStatus.FOUND
    cells = (result.path[::2] - 0.125) / 0.25
    assert cells == pytest.approx(np.round(cells), abs=1e-5)
    assert np.abs(np.diff(np.round(cells), axis=0)).max() == 1.0
    assert math.dist(result.path[-1], goal) <= 0.2
    assert result.expansions == 12


def test_the_printed_form_is_greedy_and_pays_more_risk() -> None:
    """It forgets the risk already taken, so it goes straight where a bend would cost less."""
    question = task((1.0, 4.0), (7.0, 4.0), max_acceleration_mps2=20.0)
    ground = ground_of(question, people=[((4.6, 4.05), (-0.4, 0.0)), ((4.0, 4.8), (0.0, -0.1))])
    printed = found(ground, form=SearchForm.PRINTED).path
    ours = found(ground).path
    assert naive.path_cost(ground, ours)[0] < naive.path_cost(ground, printed)[0]
    assert naive.path_cost(ground, ours)[1] < naive.path_cost(ground, printed)[1]


def test_lattice_moves_leave_out_what_is_too_fast() -> None:
    assert len(lattice_moves(0.25, 0.4, 0.9).speeds) == 8
    straight_only = lattice_moves(0.25, 0.4, 0.7)
    assert straight_only.cosines == pytest.approx([1.0, 0.0, -1.0, 0.0])
    assert straight_only.sines == pytest.approx([0.0, 1.0, 0.0, -1.0])
    assert len(lattice_moves(0.25, 0.1, 0.7).speeds) == 0


def test_a_search_names_what_is_wrong() -> None:
    ground = ground_of(task((1.0, 4.0), (7.0, 4.0)))
    odd = field_of(ground.grid, walking([], [], slices=5), slices=5)
    arguments = (ground.potential, ground.task, relative_moves(), ground.reservations)
    with pytest.raises(ValueError, match="multiple of 2 slices"):
        uncertain_bfp(odd, *arguments, STEP_S)
    with pytest.raises(ValueError, match="step_s"):
        uncertain_bfp(ground.field, *arguments, 0.0)
    with pytest.raises(ValueError, match="start must be finite"):
        found(replace(ground, task=ground.task._replace(x=math.nan)))

"""Costs of paths and their recursive perturbation against plain twins of figs. 7 and 8."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.planning.agents import _perturb_kernels as kernels
from esplanade.planning.agents._cost_kernels import room_for_near
from esplanade.planning.agents._task_kernels import TOO_MANY, needed_clearance
from tests.naive import search as naive
from tests.planning.agents.test_search import ground_of, people
from tests.planning.worlds import RULES, holds, lines, open_grid, reserved, task, world_of


def path_between(start, goal, speed=1.3):
    start, goal = np.array(start), np.array(goal)
    length = np.hypot(*(goal - start))
    way = np.minimum(speed * 0.2 * np.arange(25), length)
    return start + way[:, None] * (goal - start) / length


def test_a_bend_never_makes_an_actor_arrive_later() -> None:
    path, bends, *_ = bent([((5.0, 4.1), (0.0, 0.0))], question=task((4.0, 4.0), (6.0, 4.0)),
                           path=path_between((4.0, 4.0), (6.0, 4.0)))  # fmt: skip
    before = path_between((4.0, 4.0), (6.0, 4.0))
    arrival = int(np.argmax(np.hypot(*(before - (6.0, 4.0)).T) <= 0.2))
    assert bends >= 1
    assert np.array_equal(path[arrival:], before[arrival:])


def mean_risk(world, question, path):
    risks = np.zeros(len(path))
    kernels.risks_along(world, question, question.cell, path, 0, len(path) - 1, np.inf, risks)
    return risks[1:].mean()


def kernel_view(ground):
    return world_of(ground.grid, ground.field, ground.reservations), ground.potential.values


starts = st.tuples(st.floats(0.5, 2.0), st.floats(2.0, 6.0))
goals = st.tuples(st.floats(6.0, 7.5), st.floats(2.0, 6.0))


@given(starts, goals, people)
@holds(25, 4)
def test_a_paths_cost_is_its_sum(start, goal, crowd) -> None:
    ground = ground_of(task(start, goal, (1.0, 0.2)), people=crowd)
    world, potential = kernel_view(ground)
    path = path_between(start, goal)
    expected = naive.path_cost(ground, path)
    assert kernels.path_cost(world, potential, ground.task, path, room_for_near())[
        :2
    ] == pytest.approx(expected, rel=1e-5, abs=1e-5)


@given(starts, goals, lines(0.0, 8.0, 3), st.floats(1.0, 2.0), starts, goals)
@holds(100, 5)
def test_a_cost_tells_whether_the_whole_path_is_legal(
    start, goal, walls, speed, other_start, other_goal
) -> None:
    paths = np.stack([path_between(start, goal, speed), path_between(other_goal, other_start)])
    others = reserved(open_grid(8.0), paths, (0.25, 0.25), (1, 0))
    ground = ground_of(task(start, goal), walls=walls, others=others)
    world, potential = kernel_view(ground)
    legal = is_legal(ground, paths[0])
    assert (
        kernels.path_cost(world, potential, ground.task, paths[0], room_for_near()).legal == legal
    )


@given(starts, goals, people)
@holds(25, 3)
def test_perturbation_is_its_twin(start, goal, crowd) -> None:
    ground = ground_of(task(start, goal), people=crowd)
    world, potential = kernel_view(ground)
    ours, theirs = path_between(start, goal), path_between(start, goal)
    bends = kernels.update_path(
        world, potential, ground.task, ours, kernels.room_to_perturb(len(ours))
    )
    assert bends == naive.update_path(
        ground, theirs, RULES["offsets"], RULES["offset_m"], RULES["least_risk"]
    )
    assert ours == pytest.approx(theirs, abs=1e-9)


def is_legal(ground, path):
    world, potential = kernel_view(ground)
    need = needed_clearance(world, ground.task)
    edges = kernels.stretch_edges(
        world, potential, ground.task, need, ground.task.cell, 0.0, path, 0, 24
    )
    return bool(edges < TOO_MANY)


def bent(crowd, path=None, walls=(), others=None, question=None):
    question = question or task((1.0, 4.0), (7.0, 4.0))
    ground = ground_of(question, walls=walls, people=crowd, others=others)
    world, potential = kernel_view(ground)
    path = path_between((1.0, 4.0), (7.0, 4.0)) if path is None else path
    before = mean_risk(world, ground.task, path)
    bends = kernels.update_path(
        world, potential, ground.task, path, kernels.room_to_perturb(len(path))
    )
    after = mean_risk(world, ground.task, path)
    legal = is_legal(ground, path)
    return path, bends, before, after, legal


def test_without_risk_nothing_is_bent() -> None:
    path, bends, before, after, legal = bent([])
    assert (bends, before, after, legal) == (0, 0.0, 0.0, True)
    assert np.array_equal(path, path_between((1.0, 4.0), (7.0, 4.0)))


def test_a_path_bends_away_from_a_person_and_keeps_its_ends() -> None:
    path, bends, before, after, legal = bent([((4.0, 4.2), (0.0, 0.0))])
    assert bends >= 1
    assert after < before
    assert legal
    assert path[0].tolist() == [1.0, 4.0]
    assert path[-1] == pytest.approx(path_between((1.0, 4.0), (7.0, 4.0))[-1])
    assert path[:, 1].min() < 3.9


def test_a_stretch_without_a_middle_is_left_alone() -> None:
    """A path that arrives in the first slice has nothing that could bend."""
    start, goal = (4.0, 4.0), (4.25, 4.0)
    straight = path_between(start, goal)
    question = task(start, goal)
    path, bends, before, *_ = bent([((4.3, 4.1), (0.0, 0.0))], straight.copy(), question=question)
    assert before > RULES["least_risk"]
    assert bends == 0
    assert np.array_equal(path, straight)


def test_a_wall_allows_only_the_other_side() -> None:
    wall = ((2.0, 3.7), (6.0, 3.7))
    path, bends, _, _, legal = bent([((4.0, 4.2), (0.0, 0.0))], walls=[wall])
    assert legal
    assert bends >= 1
    assert path[:, 1].min() >= 3.9
    assert path[:, 1].max() > 4.1


def test_a_bend_never_goes_where_another_will_be() -> None:
    grid = open_grid(8.0)
    stands = np.full((25, 2), (4.0, 3.5))
    paths = np.stack([path_between((1.0, 4.0), (7.0, 4.0)), stands])
    others = reserved(grid, paths, (0.25, 0.2), (1, 0))
    free, *_ = bent([((4.0, 4.4), (0.0, 0.0))])
    hindered, _, _, _, legal = bent([((4.0, 4.4), (0.0, 0.0))], others=others)
    assert np.hypot(*(free - stands).T).min() < 0.45
    assert legal == (np.hypot(*(hindered - stands).T).min() >= 0.45)
    assert np.hypot(*(hindered - stands).T).min() >= 0.45


def test_bending_again_settles() -> None:
    path, _, _, risk, _ = bent([((4.0, 4.2), (0.0, 0.0))])
    for _ in range(40):
        path, bends, _, after, _ = bent([((4.0, 4.2), (0.0, 0.0))], path)
        assert after <= risk + 1e-9
        risk = after
        if bends == 0:
            break
    assert bends == 0


@pytest.mark.parametrize(
    ("spoil", "why"),
    [
        (lambda p: p.__setitem__((slice(12, None), 0), p[12:, 0] + 0.5), "too fast"),
        (lambda p: p.__setitem__(slice(20, None), (9.0, 4.0)), "out of bounds"),
        (lambda p: p.__setitem__((slice(None), 1), p[:, 1] * 0 + 3.75), "in the wall"),
    ],
)
def test_what_is_illegal(spoil, why) -> None:
    ground = ground_of(task((1.0, 4.0), (7.0, 4.0)), walls=[((2.0, 3.7), (6.0, 3.7))])
    path = path_between((1.0, 4.0), (7.0, 4.0))
    assert is_legal(ground, path)
    spoil(path)
    assert not is_legal(ground, path), why

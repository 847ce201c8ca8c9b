"""Live actors in passages that leave them 1.5 to 5 cm on each side, and the lengths of their ways.

Each of the plans is one in which an actor that only ever took steps of the search stood still.
"""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from benchmarks import _four_answers as four
from benchmarks._turned_plans import random_plan
from benchmarks._turned_scenes import Case, Turn, low_flight, scene_of

from esplanade.actors import ActorParameters, Navigator, Reason
from esplanade.planning import Body, LayeredGrid, PlanModel, find_path

TICK_S = 0.1
WALKS_MPS = 0.3

Walked = list[tuple[float, float, float]]
"""x, y and the heading of an actor, tick by tick."""


@pytest.mark.parametrize(
    ("number", "degrees", "aside_m"),
    [
        (30, 0.0, (0.200875, 0.159454)),
        (38, 72.0, (0.181445, 0.200164)),
        (148, 36.0, (0.193769, 0.004776)),
        (197, 18.0, (0.125108, 0.239001)),
        (345, 72.0, (0.203326, 0.047933)),
    ],
)
def test_an_actor_gets_through_a_passage_hardly_wider_than_it(number, degrees, aside_m) -> None:
    case = random_plan(np.random.default_rng([0, number])).turned(Turn(degrees, aside_m))
    assert four.actor(LayeredGrid.from_scene(case.scene), case)


def test_an_actor_comes_out_of_a_gap_that_is_just_too_narrow() -> None:
    """At its mouth an actor is in a cell that belongs to the other side, where the goal is near."""
    plan = random_plan(np.random.default_rng([11, 338]))
    case = plan.turned(Turn(72.0, (0.198597, 0.228605)))
    assert four.actor(LayeredGrid.from_scene(case.scene), case, back=False)


def two_flights(turn: Turn, width_m: float) -> Case:
    """Two flights side by side, with a landing between them, up to a floor."""
    aside, steps = 0.5 * width_m + 0.05, 8
    stairs = [
        {
            "start": turn.at(side * -1.2, side * aside),
            "end": turn.at(side * 1.2, side * aside),
            "width_m": width_m,
            "bottom_m": bottom,
            "top_m": bottom + 1.6,
            "steps": steps,
        }
        for side, bottom in ((1.0, 0.0), (-1.0, 1.6))
    ]
    wide = width_m + 0.1
    landing = turn.rectangle(1.2, -wide, 1.4 + width_m, wide)
    floor = turn.rectangle(-5.0, -wide, -1.2, -0.05)
    parts = {
        "stairs": stairs,
        "polygons": [
            {"kind": "floor", "points": landing, "height_m": 1.6},
            {"kind": "floor", "points": floor, "offset_m": 3.0, "height_m": 0.2},
        ],
    }
    ends = (*turn.at(-3.0, aside), 0.0), (*turn.at(-3.0, -aside), 3.2)
    return Case(scene_of(parts, 9.0), *ends, Body.adult())


@pytest.mark.parametrize("degrees", [18.0, 33.0, 211.0])
def test_an_actor_turns_on_a_landing_between_flights_of_60_cm(degrees: float) -> None:
    case = two_flights(Turn(degrees, (0.125, 0.125)), 0.6)
    assert four.actor(LayeredGrid.from_scene(case.scene), case)


def walked(grid: LayeredGrid, case: Case) -> Walked:
    """The way of a live actor, which arrives."""
    navigator = Navigator(grid, tick_s=TICK_S, plan=PlanModel(threads=1))
    (x, y, z), (gx, gy, gz) = case.start, case.goal
    parameters = ActorParameters(edge_cells=case.body.edge_cells)
    navigator.add_actor("a", (x, y), (gx, gy), parameters, z_m=z, goal_z_m=gz)
    way: Walked = []
    for _ in range(300):
        navigator.observe({})
        state = navigator.tick()["a"]
        way.append((*state.position, state.heading))
        if state.reason is Reason.ARRIVED:
            break
    navigator.close()
    assert state.reason is Reason.ARRIVED
    return way


def counted_flight(turn: Turn) -> tuple[LayeredGrid, Case]:
    """A flight of low steps, and a body with the greatest M that is counted on it."""
    case = low_flight(turn, 24, Body.adult())
    grid = LayeredGrid.from_scene(case.scene)
    most = max(m for m in range(10, 64) if grid.bounds_edges(Body(edge_cells=m)))
    return grid, replace(case, body=Body(edge_cells=most))


@pytest.mark.parametrize("degrees", [0.0, 18.0, 45.0, 72.0])
def test_ways_where_m_counts_are_as_straight_as_those_of_find_path(degrees: float) -> None:
    grid, case = counted_flight(Turn(degrees, (0.06, 0.11)))
    path = find_path(grid, case.start, case.goal, case.body)
    on_plan = sum(math.dist(a[:2], b[:2]) for a, b in pairwise(path.points.tolist()))
    way = walked(grid, case)
    went = sum(math.dist(a[:2], b[:2]) for a, b in pairwise(way))
    assert 0.9 * on_plan < went < 1.05 * on_plan


def test_headings_are_the_directions_of_motion_where_m_counts() -> None:
    grid, case = counted_flight(Turn(18.0))
    for (ax, ay, _), (bx, by, heading) in pairwise(walked(grid, case)):
        if math.dist((ax, ay), (bx, by)) > WALKS_MPS * TICK_S:
            course = math.atan2(by - ay, bx - ax)
            assert abs(math.remainder(heading - course, math.tau)) < 1e-6

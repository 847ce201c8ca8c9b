"""Random walls, doors, corridors and pillars at any angle: the four answer as the plan says.

Plans and judgements are those of `benchmarks.turned`, which asks about narrower passages too.
"""

import numpy as np
import pytest
from benchmarks import _four_answers as four
from benchmarks._turned_plans import Plan, random_plan
from benchmarks._turned_scenes import Turn
from hypothesis import assume, given
from hypothesis import strategies as st

from esplanade.planning import LayeredGrid
from tests.planning.worlds import holds, of_all

plans = st.integers(0, 10**6).map(lambda seed: random_plan(np.random.default_rng(seed)))
turns = st.builds(Turn, st.floats(0.0, 360.0), st.tuples(*[st.floats(0.0, 0.25)] * 2))


@given(plans, turns)
@holds(80, 1)
def test_tool_and_check_answer_as_the_plan_says(plan: Plan, turn: Turn) -> None:
    assume(plan.room_m >= 0.03)
    case = plan.turned(turn)
    grid = LayeredGrid.from_scene(case.scene)
    assert four.tool(grid, case) is plan.has_way
    assert four.check(grid, case) is plan.has_way


@given(plans, turns)
@holds(40, 1)
def test_a_person_walks_where_the_plan_has_a_way(plan: Plan, turn: Turn) -> None:
    assume(plan.room_m >= 0.03)
    case = plan.turned(turn)
    assert four.person(LayeredGrid.from_scene(case.scene), case) is plan.has_way


@given(plans, turns)
@holds(15, 1)
def test_an_actor_goes_where_the_plan_has_a_way(plan: Plan, turn: Turn) -> None:
    assume(plan.room_m >= 0.03)
    case = plan.turned(turn)
    assert four.actor(LayeredGrid.from_scene(case.scene), case) is plan.has_way


@pytest.mark.parametrize(
    ("number", "degrees", "aside_m"),
    of_all(
        [
            (2, 36.0, (0.105221, 0.213559)),
            (86, 72.0, (0.164415, 0.171211)),
            (167, 54.0, (0.007047, 0.158789)),
            (197, 0.0, (0.143998, 0.1995400)),
            (272, 90.0, (0.133029, 0.202845)),
            (365, 36.0, (0.094008, 0.225495)),
        ]
    ),
)
def test_a_person_gets_past_pillars_that_leave_1_to_3_cm(number, degrees, aside_m) -> None:
    """Routes do not lead through gaps that are narrower than the body by some millimetres, and
    between two pillars nobody who is pushed out of one is caught by the other."""
    case = random_plan(np.random.default_rng([0, number])).turned(Turn(degrees, aside_m))
    assert four.person(LayeredGrid.from_scene(case.scene), case)


@pytest.mark.parametrize(
    ("seed", "number", "degrees", "aside_m"),
    of_all(
        [
            (0, 343, 9.0, (0.177821, 0.246354)),
            (0, 460, 9.0, (0.185897, 0.055032)),
            (1, 49, 9.0, (0.132842, 0.131207)),
            (1, 203, 9.0, (0.047241, 0.089071)),
            (2, 149, 0.0, (0.189521, 0.092443)),
            (21, 368, 9.0, (0.221268, 0.087270)),
        ]
    ),
)
def test_ways_lead_between_corners_that_lie_aslant(seed, number, degrees, aside_m) -> None:
    """Steps bend at their tightest point, and anchors stay in passages that lead to more room."""
    case = random_plan(np.random.default_rng([seed, number])).turned(Turn(degrees, aside_m))
    grid = LayeredGrid.from_scene(case.scene)
    assert four.tool(grid, case)
    assert four.person(grid, case)


@pytest.mark.parametrize(
    ("seed", "number", "degrees", "aside_m"),
    of_all([(1, 483, 18.0, (0.233910, 0.113815)), (3, 164, 72.0, (0.014053, 0.068925))]),
)
def test_a_person_gets_through_a_gap_narrower_by_a_rounding(seed, number, degrees, aside_m) -> None:
    case = random_plan(np.random.default_rng([seed, number])).turned(Turn(degrees, aside_m))
    assert four.person(LayeredGrid.from_scene(case.scene), case)

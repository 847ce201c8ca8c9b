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
from tests.planning.worlds import holds

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
    [
        (2, 36.0, (0.105221, 0.213559)),
        (86, 72.0, (0.164415, 0.171211)),
        (167, 54.0, (0.007047, 0.158789)),
        (197, 0.0, (0.143998, 0.1995400)),
        (365, 36.0, (0.094008, 0.225495)),
    ],
)
def test_a_person_gets_past_pillars_that_leave_1_to_3_cm(number, degrees, aside_m) -> None:
    """Routes do not lead through gaps that are narrower than the body by some millimetres, and
    between two pillars nobody who is pushed out of one is caught by the other."""
    case = random_plan(np.random.default_rng([0, number])).turned(Turn(degrees, aside_m))
    assert four.person(LayeredGrid.from_scene(case.scene), case)

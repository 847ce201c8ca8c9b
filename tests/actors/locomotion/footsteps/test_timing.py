import numpy as np
import pytest

from esplanade.actors.locomotion.footsteps.timing import (
    CLOSING_S,
    SHORTEST_S,
    SHORTEST_UP_S,
    durations_s,
)
from tests.actors.locomotion.courses import LEG, course, standing_on


@pytest.mark.parametrize("speed", [0.8, 1.0, 1.3, 1.8])
def test_faster_bodies_take_longer_and_quicker_steps(speed: float) -> None:
    under = standing_on(0.3, -0.09)
    slower, faster = (
        float(durations_s(course((v, 0.0)), under, LEG, np.ones(1))[0])
        for v in (speed, 1.2 * speed)
    )
    assert faster < slower
    assert 1.2 * speed * faster > speed * slower - 1e-9
    assert speed * slower <= 0.73 * 0.9


def test_a_step_that_goes_nowhere_draws_the_other_foot_up() -> None:
    under = standing_on(0.0, -0.09)
    assert durations_s(course((0.0, 0.0)), under, LEG, np.ones(1)).tolist() == [CLOSING_S]


def test_a_start_is_quick_and_stairs_are_not() -> None:
    under = standing_on(0.0, -0.09)
    start = durations_s(course((1.6, 0.0)), under, LEG, np.ones(1))
    walking = durations_s(course((1.6, 0.0)), standing_on(0.35, -0.09), LEG, np.ones(1))
    assert SHORTEST_S <= start[0] < walking[0]
    level = durations_s(course((0.9, 0.0)), standing_on(0.1, 0.0), LEG, np.ones(1))
    up = durations_s(course((0.9, 0.0), rise_mps=0.6), standing_on(0.1, 0.0), LEG, np.ones(1))
    assert SHORTEST_UP_S <= up[0] < 0.75 * level[0]

import pytest

from esplanade.actors.locomotion.footsteps._timing_kernels import (
    CLOSING_S,
    SHORTEST_S,
    SHORTEST_UP_S,
    duration_s,
)
from esplanade.actors.locomotion.footsteps.course import Course
from esplanade.planning.compiled.arrays import Floats
from tests.actors.locomotion.courses import LEG, course, standing_on


def duration(way: Course, under: Floats) -> float:
    """Seconds that the next step takes while the foot stands on a footprint (1, 4)."""
    return duration_s(way.ahead[0], under[0], float(LEG[0]), 1.0)


@pytest.mark.parametrize("speed", [0.8, 1.0, 1.3, 1.8])
def test_faster_bodies_take_longer_and_quicker_steps(speed: float) -> None:
    under = standing_on(0.3, -0.09)
    slower, faster = (duration(course((v, 0.0)), under) for v in (speed, 1.2 * speed))
    assert faster < slower
    assert 1.2 * speed * faster > speed * slower - 1e-9
    assert speed * slower <= 0.73 * 0.9


def test_a_step_that_goes_nowhere_draws_the_other_foot_up() -> None:
    under = standing_on(0.0, -0.09)
    assert duration(course((0.0, 0.0)), under) == CLOSING_S


def test_a_start_is_quick_and_stairs_are_not() -> None:
    under = standing_on(0.0, -0.09)
    start = duration(course((1.6, 0.0)), under)
    walking = duration(course((1.6, 0.0)), standing_on(0.35, -0.09))
    assert SHORTEST_S <= start < walking
    level = duration(course((0.9, 0.0)), standing_on(0.1, 0.0))
    up = duration(course((0.9, 0.0), rise_mps=0.6), standing_on(0.1, 0.0))
    assert SHORTEST_UP_S <= up < 0.75 * level

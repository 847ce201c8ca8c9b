import numpy as np
import pytest

from esplanade.actors.locomotion.footsteps._limit_kernels import (
    LONGEST_WALK,
    PAST_STANDING,
    PAST_TOE,
    clamped_distance,
    clamped_foot,
    distance_and_limit,
    longest_step,
    wrapped,
)
from tests.actors.locomotion.courses import standing_on


def test_a_body_may_get_further_past_the_toe_of_its_standing_foot() -> None:
    foot = standing_on(1.0, 2.0, heading=np.pi / 2.0)[0]
    for place, allowed in (
        ((1.0, 2.4), PAST_STANDING + PAST_TOE),
        ((1.0, 1.6), PAST_STANDING),
        ((1.4, 2.0), PAST_STANDING),
    ):
        distance, limit = distance_and_limit(*place, foot, 1.5)
        assert distance == pytest.approx(0.4)
        assert limit == pytest.approx(allowed)


def test_a_runner_gets_further_past_the_toe_and_only_there() -> None:
    foot = standing_on(0.0, 0.0)[0]
    more = longest_step(2.9) - LONGEST_WALK
    assert more > 0.3
    for x, expected in ((1.0, PAST_STANDING + PAST_TOE + more), (-1.0, PAST_STANDING)):
        _, limit = distance_and_limit(x, 0.0, foot, 2.9)
        assert limit == pytest.approx(expected)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_foot_stays_on_its_own_side_and_within_reach(side: float) -> None:
    foot, middle = standing_on(0.0, 0.0)[0], 0.0
    longest = LONGEST_WALK
    near = clamped_foot(0.2, -0.5 * side, foot, middle, side, longest, 0.9)
    assert near == pytest.approx((0.2, side * 0.11 * 0.9))
    far = clamped_foot(9.0, 9.0 * side, foot, middle, side, longest, 0.9)
    assert far == pytest.approx((0.86 * 0.9, side * 0.55 * 0.9))
    running = clamped_foot(9.0, 9.0 * side, foot, middle, side, longest + 0.3, 0.9)
    assert running == pytest.approx((1.16 * 0.9, side * 0.55 * 0.9))
    kept = clamped_foot(0.3, 0.2 * side, foot, middle, side, longest, 0.9)
    assert kept == pytest.approx((0.3, 0.2 * side))


def test_points_are_drawn_to_their_origin_only_beyond_the_limit() -> None:
    assert clamped_distance(3.0, 4.0, 0.0, 0.0, 1.0) == pytest.approx((0.6, 0.8))
    assert clamped_distance(0.3, 0.4, 0.0, 0.0, 1.0) == pytest.approx((0.3, 0.4))


def test_angles_are_wrapped_to_half_a_turn_on_either_side() -> None:
    for angle in (-np.pi, -0.5, 0.0, 3.0):
        assert wrapped(angle) == pytest.approx(angle)
        assert wrapped(angle + 4.0 * np.pi) == pytest.approx(angle)
    assert wrapped(np.pi) == -np.pi

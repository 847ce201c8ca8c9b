import numpy as np
import pytest

from esplanade.actors.locomotion.footsteps._limit_kernels import (
    PAST_STANDING,
    PAST_TOE,
    clamped_distance,
    clamped_foot,
    distance_and_limit,
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
        distance, limit = distance_and_limit(*place, foot)
        assert distance == pytest.approx(0.4)
        assert limit == pytest.approx(allowed)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_foot_stays_on_its_own_side_and_within_reach(side: float) -> None:
    foot, middle = standing_on(0.0, 0.0)[0], 0.0
    near = clamped_foot(0.2, -0.5 * side, foot, middle, side, 0.9)
    assert near == pytest.approx((0.2, side * 0.11 * 0.9))
    far = clamped_foot(9.0, 9.0 * side, foot, middle, side, 0.9)
    assert far == pytest.approx((0.86 * 0.9, side * 0.55 * 0.9))
    kept = clamped_foot(0.3, 0.2 * side, foot, middle, side, 0.9)
    assert kept == pytest.approx((0.3, 0.2 * side))


def test_points_are_drawn_to_their_origin_only_beyond_the_limit() -> None:
    assert clamped_distance(3.0, 4.0, 0.0, 0.0, 1.0) == pytest.approx((0.6, 0.8))
    assert clamped_distance(0.3, 0.4, 0.0, 0.0, 1.0) == pytest.approx((0.3, 0.4))


def test_angles_are_wrapped_to_half_a_turn_on_either_side() -> None:
    for angle in (-np.pi, -0.5, 0.0, 3.0):
        assert wrapped(angle) == pytest.approx(angle)
        assert wrapped(angle + 4.0 * np.pi) == pytest.approx(angle)
    assert wrapped(np.pi) == -np.pi

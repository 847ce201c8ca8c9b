import numpy as np
import pytest

from esplanade.actors.locomotion.footsteps.limits import (
    PAST_STANDING,
    PAST_TOE,
    clamped_distance,
    clamped_foot,
    distance_and_limit,
)
from tests.actors.locomotion.courses import LEG, standing_on


def test_a_body_may_get_further_past_the_toe_of_its_standing_foot() -> None:
    foot = standing_on(1.0, 2.0, heading=np.pi / 2.0)
    for place, allowed in (
        ((1.0, 2.4), PAST_STANDING + PAST_TOE),
        ((1.0, 1.6), PAST_STANDING),
        ((1.4, 2.0), PAST_STANDING),
    ):
        distance, limit = distance_and_limit(np.array([place]), foot)
        assert distance[0] == pytest.approx(0.4)
        assert limit[0] == pytest.approx(allowed)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_foot_stays_on_its_own_side_and_within_reach(side: float) -> None:
    foot, middle, sides = standing_on(0.0, 0.0), np.zeros(1), np.array([side])
    near = clamped_foot(np.array([[0.2, -0.5 * side]]), foot, middle, sides, LEG)
    assert near[0] == pytest.approx((0.2, side * 0.11 * 0.9))
    far = clamped_foot(np.array([[9.0, 9.0 * side]]), foot, middle, sides, LEG)
    assert far[0] == pytest.approx((0.86 * 0.9, side * 0.55 * 0.9))
    kept = clamped_foot(np.array([[0.3, 0.2 * side]]), foot, middle, sides, LEG)
    assert kept[0] == pytest.approx((0.3, 0.2 * side))


def test_points_are_drawn_to_their_origin_only_beyond_the_limit() -> None:
    points, origin = np.array([[3.0, 4.0], [0.3, 0.4]]), np.zeros((2, 2))
    moved = clamped_distance(points, origin, np.ones(2))
    assert moved == pytest.approx(np.array([[0.6, 0.8], [0.3, 0.4]]))

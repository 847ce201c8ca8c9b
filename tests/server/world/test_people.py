import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from esplanade.server.world.inputs import Detach, Follow, Steer, SteerMany
from esplanade.server.world.people import BLOCKED_TICKS
from tests.server.worlds import FIELD, TICK_S, Trial


def test_a_person_walks_in_the_direction_they_steer_until_told_otherwise() -> None:
    trial = Trial()
    (ann,) = trial.join((3.0, 3.0))
    trial.tick(Steer(ann, 1, math.pi / 2.0, 1.5))
    trial.ticks(19)
    assert trial.position(ann) == pytest.approx((3.0, 4.5))
    assert trial.speed(ann) == pytest.approx(1.5)
    trial.tick(Steer(ann, 2, 0.0, 0.0))
    assert trial.position(ann) == pytest.approx((3.0, 4.5))
    assert trial.speed(ann) == 0.0


def test_nobody_is_faster_than_the_rules_allow() -> None:
    trial = Trial()
    (ann,) = trial.join((3.0, 3.0))
    trial.tick(Steer(ann, 1, 0.0, 100.0))
    assert trial.position(ann)[0] == pytest.approx(3.0 + 3.0 * TICK_S)


def test_walls_stop_a_person_at_their_clearance_and_let_them_slide() -> None:
    trial = Trial()
    (ann,) = trial.join((9.0, 5.0))
    trial.tick(Steer(ann, 1, math.pi / 4.0, 2.0))
    trial.ticks(20)
    x, y = trial.position(ann)
    assert x == pytest.approx(9.75, abs=0.02)
    assert y > 6.0


def test_the_bounds_hold_everyone_inside() -> None:
    trial = Trial()
    (ann,) = trial.join((1.0, 1.0))
    trial.tick(Steer(ann, 1, math.pi, 3.0))
    trial.ticks(20)
    assert trial.position(ann)[0] >= 0.0


def test_a_detached_person_stands() -> None:
    trial = Trial()
    (ann,) = trial.join((3.0, 3.0))
    trial.tick(Steer(ann, 1, 0.0, 1.0))
    before = trial.position(ann)
    trial.tick(Detach(ann))
    assert trial.position(ann) == before


def test_following_a_way_ends_exactly_at_its_end() -> None:
    trial = Trial()
    (ann,) = trial.join((3.0, 3.0))
    trial.tick(Follow(ann, 1, ((3.0, 5.0, 0), (4.0, 5.0, 0))))
    assert trial.speed(ann) == pytest.approx(1.6)
    trial.ticks(50)
    assert trial.position(ann) == pytest.approx((4.0, 5.0), abs=1e-6)
    assert trial.speed(ann) == 0.0


def test_steering_cancels_a_way_and_a_way_cancels_steering() -> None:
    trial = Trial()
    (ann,) = trial.join((3.0, 3.0))
    trial.tick(Follow(ann, 1, ((3.0, 9.0, 0),)))
    trial.tick(Steer(ann, 2, 0.0, 1.0))
    trial.ticks(3)
    assert trial.position(ann) == pytest.approx((3.0 + 4 * TICK_S, 3.0 + 1.6 * TICK_S))
    trial.tick(Follow(ann, 3, ((3.0, 3.0, 0),)))
    trial.ticks(10)
    assert trial.position(ann) == pytest.approx((3.0, 3.0), abs=1e-6)


def test_a_way_through_a_wall_is_given_up() -> None:
    trial = Trial()
    (ann,) = trial.join((9.0, 5.0))
    trial.tick(Follow(ann, 1, ((12.0, 5.0, 0),)))
    trial.ticks(10 + BLOCKED_TICKS)
    assert trial.position(ann)[0] <= 9.75
    trial.tick()
    assert trial.speed(ann) == 0.0
    assert not trial.world.state.speeds.any()


def test_a_corner_a_hair_nearer_to_a_wall_than_bodies_get_is_passed() -> None:
    trial = Trial()
    (ann,) = trial.join((9.0, 5.0))
    trial.tick(Follow(ann, 1, ((9.7505, 5.0, 0), (9.0, 6.0, 0))))
    trial.ticks(60)
    assert trial.position(ann) == pytest.approx((9.0, 6.0))


def test_people_pass_through_each_other() -> None:
    trial = Trial(scene=FIELD)
    ann, ben = trial.join((10.0, 10.0), (11.0, 10.0))
    trial.tick(Steer(ann, 1, 0.0, 2.0), Steer(ben, 1, math.pi, 2.0))
    trial.ticks(19)
    assert trial.position(ann) == pytest.approx((12.0, 10.0))
    assert trial.position(ben) == pytest.approx((9.0, 10.0))


WISHES = st.tuples(st.floats(-1000.0, 1000.0), st.floats(0.0, 100.0))


@given(st.lists(WISHES, min_size=4, max_size=4), st.sets(st.integers(0, 3)))
def test_many_steer_as_each_would_alone(wishes: list[tuple[float, float]], some: set[int]) -> None:
    apart, together = Trial(), Trial()
    for trial in (apart, together):
        ids = trial.join(*((2.0 + k, 5.0) for k in range(4)))
        trial.tick(Follow(ids[1], 1, ((8.0, 8.0, 0.0),)))
    steers = [Steer(ids[k], 2 + k, *wishes[k]) for k in sorted(some)]
    news = [
        apart.frame(*steers),
        together.frame(
            SteerMany(
                (*(each.id for each in steers), 999),
                (*(each.seq for each in steers), 1),
                np.array([*(each.direction_rad for each in steers), 0.0]),
                np.array([*(each.speed_mps for each in steers), 1.0]),
            )
        ),
    ]
    assert news[0].acks == news[1].acks == {each.id: each.seq for each in steers}
    for trial in (apart, together):
        trial.ticks(2)
    states = [trial.world.state for trial in (apart, together)]
    assert states[0].positions.tobytes() == states[1].positions.tobytes()
    assert states[0].headings.tobytes() == states[1].headings.tobytes()

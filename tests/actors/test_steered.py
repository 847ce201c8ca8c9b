"""Actors whose velocity is decided elsewhere go by it, within their limits, and plan nothing."""

import numpy as np
import pytest

from esplanade.actors import Navigator, Reason
from esplanade.planning import Scene, Wall
from tests.actors.worlds import BODY, TICK_S, navigator

OPEN = Scene(bounds=(0.0, 0.0, 12.0, 12.0))


def steered(nav: Navigator, velocity: tuple[float, float], ticks: int, who: str = "a") -> None:
    """Let one actor go at a velocity for some ticks, where nobody else is."""
    for _ in range(ticks):
        nav.observe({})
        nav.advance({who: velocity})


def test_it_goes_as_it_is_told_and_not_to_its_goal() -> None:
    nav = navigator(OPEN)
    nav.add_actor("a", (2.0, 6.0), (10.0, 6.0), BODY)
    before = np.zeros(2)
    for _ in range(20):
        steered(nav, (0.0, 0.8), 1)
        velocity = np.array(nav.state("a").velocity)
        assert np.hypot(*(velocity - before)) <= BODY.max_acceleration_mps2 * TICK_S + 1e-9
        before = velocity
    state = nav.state("a")
    assert state.velocity == pytest.approx((0.0, 0.8))
    assert state.position[0] == pytest.approx(2.0)
    assert state.reason is Reason.MOVING
    ahead = state.path[-1, :2] - state.path[0, :2]
    assert ahead == pytest.approx((0.0, 0.8 * nav.plan.slices * nav.plan.slice_s))
    nav.close()


def test_it_is_no_faster_than_it_may_be() -> None:
    nav = navigator(OPEN)
    nav.add_actor("a", (2.0, 2.0), None, BODY)
    steered(nav, (30.0, 40.0), 30)
    speed = np.hypot(*nav.state("a").velocity)
    nav.close()
    assert speed == pytest.approx(BODY.max_speed_mps)


def test_a_wall_stops_it_and_its_path() -> None:
    nav = navigator(OPEN.model_copy(update={"walls": (Wall(start=(5.0, 0.0), end=(5.0, 12.0)),)}))
    nav.add_actor("a", (4.0, 6.0), (10.0, 6.0), BODY)
    steered(nav, (1.3, 0.0), 40)
    state = nav.state("a")
    nav.close()
    assert state.position[0] == pytest.approx(4.75, abs=0.02)
    assert state.path[:, 0].max() <= 4.76
    assert state.reason is Reason.NO_PATH


def test_another_actor_keeps_clear_of_it_and_stops_it() -> None:
    nav = navigator(OPEN)
    nav.add_actor("a", (2.0, 6.0), None, BODY)
    nav.add_actor("b", (8.0, 6.0), (2.5, 6.0), BODY)
    for _ in range(60):
        nav.observe({})
        nav.advance({"a": (1.0, 0.0)})
        apart = np.subtract(nav.state("a").position, nav.state("b").position)
        assert np.hypot(*apart) >= 2.0 * BODY.radius_m - 1e-6
    passed = nav.state("b").position[0] < nav.state("a").position[0]
    nav.close()
    assert passed


def test_it_arrives_and_plans_again_when_nobody_steers_it() -> None:
    nav = navigator(OPEN)
    nav.add_actor("a", (2.0, 6.0), (4.0, 6.0), BODY)
    steered(nav, (1.3, 0.0), 15)
    assert nav.state("a").position[0] > 3.0
    for _ in range(40):
        nav.observe({})
        nav.advance()
    assert nav.state("a").reason is Reason.ARRIVED
    nav.set_goal("a", (2.0, 6.0))
    for _ in range(60):
        left = np.array([2.0, 6.0]) - nav.state("a").position
        steered(nav, tuple((1.0 * left / max(1.0, np.hypot(*left))).tolist()), 1)
    assert nav.state("a").reason is Reason.ARRIVED
    nav.close()


def test_the_way_to_its_goal_is_told_corner_by_corner() -> None:
    nav = navigator(OPEN.model_copy(update={"walls": (Wall(start=(6.0, 3.0), end=(6.0, 12.0)),)}))
    nav.add_actor("a", (4.0, 9.0), (8.0, 9.0), BODY)
    nav.add_actor("b", (8.0, 3.0), (8.0, 9.0), BODY)
    nav.add_actor("c", (2.0, 2.0), None, BODY)
    x, y = nav.waypoint("a") or (0.0, 0.0)
    assert 5.0 < x < 7.0
    assert 2.0 < y < 4.0
    assert nav.waypoint("b") == pytest.approx((8.0, 9.0), abs=0.01)
    assert nav.waypoint("c") is None
    nav.close()

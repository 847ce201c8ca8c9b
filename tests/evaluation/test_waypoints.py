"""Waypoints around walls."""

import numpy as np

from esplanade.evaluation.waypoints import WallMap, Waypoints
from esplanade.recordings import Obstacles
from tests.evaluation.worlds import replay, walk

HEDGE = Obstacles(segments=(((5.0, -3.0), (5.0, 3.0)),))
CROSSING = (walk("1", 0.0, (0, 0), (10, 0)), walk("2", 0.0, (0, 6), (10, -6)))


def test_a_goal_in_sight_is_the_waypoint() -> None:
    goal = np.array([10.0, 0.0])
    open_ground = Waypoints(WallMap(replay(*CROSSING)), goal)
    assert open_ground.next_from(np.zeros(2)) is goal
    behind = Waypoints(WallMap(replay(*CROSSING, obstacles=HEDGE)), goal)
    np.testing.assert_array_equal(behind.next_from(np.array([6.0, 0.0])), goal)


def test_waypoints_lead_around_the_wall() -> None:
    walls = WallMap(replay(*CROSSING, obstacles=HEDGE))
    goal = np.array([10.0, 0.0])
    waypoints = Waypoints(walls, goal)
    here = np.zeros(2)
    length_m = 0.0
    clearances = []
    while np.hypot(*(goal - here)) > 0.1:
        offset = waypoints.next_from(here) - here
        step = offset / max(1.0, np.hypot(*offset) / 0.1)
        here = here + step
        length_m += float(np.hypot(*step))
        clearances.append(float(np.hypot(max(0.0, abs(here[1]) - 3.0), here[0] - 5.0)))
        assert length_m < 20.0
    assert min(clearances) > 0.2
    assert length_m < 2.0 * np.hypot(5.0, 3.5)


def test_a_robot_beside_a_wall_may_leave_it() -> None:
    walls = WallMap(replay(*CROSSING, obstacles=HEDGE))
    assert walls.has_line_of_sight(np.array([4.9, 0.0]), np.array([1.0, 0.0]))
    assert not walls.has_line_of_sight(np.array([4.9, 0.0]), np.array([9.0, 0.0]))

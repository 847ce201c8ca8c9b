"""One episode: limits, the sensor, pop-ins, and the end."""

import numpy as np
import pytest

from esplanade.evaluation.policies.human import Human
from esplanade.evaluation.policies.policy import Observation, Policy
from esplanade.evaluation.rules import Rules
from esplanade.evaluation.simulation import Sensor, limit_velocity, run_episode
from esplanade.recordings import Obstacles
from tests.evaluation.worlds import RULES, Scripted, environment, trip, walk

EAST = walk("1", 0.0, (0, 0), (12, 0))


def test_the_pedestrian_whose_place_is_taken_is_not_there() -> None:
    place = environment(EAST, walk("2", 0.0, (6, 3), (6, -3)))
    policy = Scripted((1.3, 0.0))
    result = run_episode(place, trip(place.replay), policy, RULES)
    assert policy.seen()[0] == [1]
    assert result.score.pedestrian == "1"
    assert result.score.reached


def test_speed_and_acceleration_are_limited() -> None:
    np.testing.assert_allclose(limit_velocity(RULES, np.zeros(2), np.array([9.0, 0.0])), [0.2, 0.0])
    np.testing.assert_allclose(
        limit_velocity(RULES, np.array([1.6, 0]), np.array([9.0, 0])), [1.7, 0.0]
    )
    free = Rules(max_acceleration_mps2=None)
    np.testing.assert_allclose(limit_velocity(free, np.zeros(2), np.array([9.0, 0.0])), [1.7, 0.0])
    np.testing.assert_allclose(limit_velocity(RULES, np.zeros(2), np.array([0.1, 0.1])), [0.1, 0.1])


def test_a_velocity_that_is_not_finite_means_to_stand() -> None:
    place = environment(EAST)
    result = run_episode(place, trip(place.replay), Scripted((np.nan, 1.0)), RULES)
    assert not result.score.reached
    assert np.ptp(result.trajectory, axis=0).max() == 0.0
    assert result.score.decisions == 600
    assert np.isnan(result.score.time_s)


def test_people_who_appear_beside_the_robot_are_left_out() -> None:
    place = environment(
        EAST, walk("2", 2.0, (1.5, 0.9), (1.5, 5.0)), walk("3", 2.0, (1.5, 4), (9, 4))
    )
    policy = Scripted((0.0, 0.0))
    score = run_episode(place, trip(place.replay), policy, Rules(time_limit_s=6.0)).score
    assert score.pop_ins == 0
    near = environment(
        EAST, walk("2", 2.0, (1.0, 0.9), (1.0, 5.0)), walk("3", 2.0, (1.5, 4), (9, 4))
    )
    score = run_episode(near, trip(near.replay), policy, Rules(time_limit_s=6.0)).score
    assert score.pop_ins == 1
    assert all(1 not in people for people in policy.seen())
    assert policy.seen()[20] == [2]


def test_people_present_from_the_beginning_are_no_pop_ins() -> None:
    place = environment(EAST, walk("2", 0.0, (0.0, 1.0), (5.0, 1.0)))
    sensor = Sensor(place.replay, RULES, trip(place.replay))
    assert [p.id for p in sensor.people(0, np.zeros(2))] == [1]
    assert sensor.pop_ins == 0


def test_only_the_near_are_seen_with_their_past() -> None:
    place = environment(
        EAST, walk("2", -10.0, (0, -4), (0, 20)), walk("3", 0.0, (15.5, 0), (15.5, 9))
    )
    sensor = Sensor(place.replay, RULES, trip(place.replay))
    (person,) = sensor.people(0, np.zeros(2))
    assert person.id == 1
    assert person.track.shape == (33, 2)
    np.testing.assert_array_equal(person.position, place.replay.at(1, 0))


def test_after_the_recording_nobody_is_there() -> None:
    place = environment(EAST, walk("2", 0.0, (6, 1), (6, 4)))
    policy = Scripted((0.0, 0.0))
    run_episode(place, trip(place.replay), policy, Rules(time_limit_s=20.0))
    assert policy.seen()[0] == [1]
    assert policy.seen()[-1] == []


def test_walls_are_touched_by_bodies() -> None:
    wall = Obstacles(segments=(((3.0, -0.1), (9.0, -0.1)),))
    place = environment(EAST, obstacles=wall)
    assert run_episode(place, trip(place.replay), Scripted((1.3, 0.0)), RULES).score.wall_contact
    farther = Obstacles(segments=(((3.0, -0.2), (9.0, -0.2)),))
    place = environment(EAST, obstacles=farther)
    score = run_episode(place, trip(place.replay), Scripted((1.3, 0.0)), RULES).score
    assert not score.wall_contact


def test_the_recorded_trajectory_is_walked_to_its_end_without_limits() -> None:
    place = environment(walk("1", 0.0, (0, 0), (6, 0), (6, 6), speed_mps=2.5))
    result = run_episode(place, trip(place.replay), Human(), RULES)
    np.testing.assert_allclose(
        result.trajectory, place.replay.trajectory(0)[: len(result.trajectory)], atol=1e-9
    )
    assert result.score.reached
    assert len(result.trajectory) >= len(place.replay.trajectory(0)) - 1
    assert result.score.acceleration_max_mps2 > RULES.max_speed_mps


def test_the_callback_is_called_after_every_decision() -> None:
    place = environment(EAST)
    seen: list[float] = []

    def on_decision(observation: Observation, policy: Policy) -> None:
        seen.append(observation.t)

    result = run_episode(place, trip(place.replay), Scripted((1.3, 0.0)), RULES, on_decision)
    assert len(seen) == result.score.decisions
    assert seen[:3] == pytest.approx([0.0, 0.1, 0.2])

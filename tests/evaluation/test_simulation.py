"""One episode: limits, sight, pop-ins, and how it ends."""

import numpy as np
import pytest

from esplanade.evaluation.policies.human import Human
from esplanade.evaluation.policies.policy import Policy, View
from esplanade.evaluation.rules import Rules
from esplanade.evaluation.simulation import Sight, limited, run_episode
from esplanade.recordings import Obstacles
from tests.evaluation.worlds import RULES, Scripted, ground, trip, walk

EAST = walk("1", 0.0, (0, 0), (12, 0))


def test_the_pedestrian_whose_place_is_taken_is_not_there() -> None:
    place = ground(EAST, walk("2", 0.0, (6, 3), (6, -3)))
    policy = Scripted((1.3, 0.0))
    run = run_episode(place, trip(place.replay), policy, RULES)
    assert policy.seen()[0] == [1]
    assert run.score.pedestrian == "1"
    assert run.score.reached


def test_speed_and_acceleration_are_limited() -> None:
    np.testing.assert_allclose(limited(RULES, np.zeros(2), np.array([9.0, 0.0])), [0.2, 0.0])
    np.testing.assert_allclose(limited(RULES, np.array([1.6, 0]), np.array([9.0, 0])), [1.7, 0.0])
    free = Rules(max_acceleration_mps2=None)
    np.testing.assert_allclose(limited(free, np.zeros(2), np.array([9.0, 0.0])), [1.7, 0.0])
    np.testing.assert_allclose(limited(RULES, np.zeros(2), np.array([0.1, 0.1])), [0.1, 0.1])


def test_a_wish_that_is_no_number_means_to_stand() -> None:
    place = ground(EAST)
    run = run_episode(place, trip(place.replay), Scripted((np.nan, 1.0)), RULES)
    assert not run.score.reached
    assert np.ptp(run.way, axis=0).max() == 0.0
    assert run.score.decisions == 600
    assert np.isnan(run.score.time_s)


def test_who_appears_beside_the_robot_is_never_there() -> None:
    place = ground(EAST, walk("2", 2.0, (1.5, 0.9), (1.5, 5.0)), walk("3", 2.0, (1.5, 4), (9, 4)))
    policy = Scripted((0.0, 0.0))
    score = run_episode(place, trip(place.replay), policy, Rules(time_limit_s=6.0)).score
    assert score.pop_ins == 0
    near = ground(EAST, walk("2", 2.0, (1.0, 0.9), (1.0, 5.0)), walk("3", 2.0, (1.5, 4), (9, 4)))
    score = run_episode(near, trip(near.replay), policy, Rules(time_limit_s=6.0)).score
    assert score.pop_ins == 1
    assert all(1 not in people for people in policy.seen())
    assert policy.seen()[20] == [2]


def test_who_is_there_from_the_beginning_is_no_pop_in() -> None:
    place = ground(EAST, walk("2", 0.0, (0.0, 1.0), (5.0, 1.0)))
    sight = Sight(place.replay, RULES, trip(place.replay))
    assert [p.id for p in sight.people(0, np.zeros(2))] == [1]
    assert sight.pop_ins == 0


def test_only_the_near_are_seen_with_their_past() -> None:
    place = ground(EAST, walk("2", -10.0, (0, -4), (0, 20)), walk("3", 0.0, (15.5, 0), (15.5, 9)))
    sight = Sight(place.replay, RULES, trip(place.replay))
    (person,) = sight.people(0, np.zeros(2))
    assert person.id == 1
    assert person.track.shape == (33, 2)
    np.testing.assert_array_equal(person.position, place.replay.at(1, 0))


def test_after_the_recording_nobody_is_there() -> None:
    place = ground(EAST, walk("2", 0.0, (6, 1), (6, 4)))
    policy = Scripted((0.0, 0.0))
    run_episode(place, trip(place.replay), policy, Rules(time_limit_s=20.0))
    assert policy.seen()[0] == [1]
    assert policy.seen()[-1] == []


def test_walls_are_touched_by_bodies() -> None:
    wall = Obstacles(segments=(((3.0, -0.1), (9.0, -0.1)),))
    place = ground(EAST, obstacles=wall)
    assert run_episode(place, trip(place.replay), Scripted((1.3, 0.0)), RULES).score.wall_contact
    farther = Obstacles(segments=(((3.0, -0.2), (9.0, -0.2)),))
    place = ground(EAST, obstacles=farther)
    score = run_episode(place, trip(place.replay), Scripted((1.3, 0.0)), RULES).score
    assert not score.wall_contact


def test_the_recorded_way_is_walked_to_its_end_without_limits() -> None:
    place = ground(walk("1", 0.0, (0, 0), (6, 0), (6, 6), speed_mps=2.5))
    run = run_episode(place, trip(place.replay), Human(), RULES)
    np.testing.assert_allclose(run.way, place.replay.way(0)[: len(run.way)], atol=1e-9)
    assert run.score.reached
    assert len(run.way) >= len(place.replay.way(0)) - 1
    assert run.score.acceleration_max_mps2 > RULES.max_speed_mps


def test_a_watcher_is_called_after_every_decision() -> None:
    place = ground(EAST)
    seen: list[float] = []

    def watch(view: View, policy: Policy) -> None:
        seen.append(view.t)

    run = run_episode(place, trip(place.replay), Scripted((1.3, 0.0)), RULES, watch)
    assert len(seen) == run.score.decisions
    assert seen[:3] == pytest.approx([0.0, 0.1, 0.2])

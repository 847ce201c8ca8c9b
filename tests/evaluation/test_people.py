"""People who react to the robot in an episode, and what it imposes on them."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from esplanade.evaluation.episodes import choose_episodes
from esplanade.evaluation.people import ReactingPeople
from esplanade.evaluation.policies.human import Human
from esplanade.evaluation.policies.straight import Straight
from esplanade.evaluation.replay import Replay
from esplanade.evaluation.rules import Rules
from esplanade.evaluation.simulation import Environment, run_episode
from esplanade.recordings import Obstacles
from tests.evaluation.worlds import RULES, Scripted, busy_plaza, environment, trip, walk

REACTING = Rules(people="reacting")
EAST = walk("1", 0.0, (0, 0), (12, 0))
DETOUR = walk("1", 0.0, (0, 0), (4, -4), (8, -4), (12, 0))
"""The robot takes the place of somebody who kept out of the way."""
ONCOMING = walk("2", 0.0, (12, 0.1), (0, 0.1))


def test_an_oncoming_person_makes_room_only_if_people_react() -> None:
    place = environment(DETOUR, ONCOMING)
    straight = Straight()
    recorded = run_episode(place, trip(place.replay), straight, RULES).score
    reacting = run_episode(place, trip(place.replay), straight, REACTING).score
    assert recorded.touched
    assert recorded.displacement_m == 0.0
    assert reacting.clearance_m > recorded.clearance_m + 0.2
    assert 0.2 < reacting.displacement_m < 1.5
    assert (recorded.imposed_delay_s, recorded.imposed_peak_mps2, recorded.gave_way) == (0, 0, 0)
    assert reacting.gave_way == 1
    assert 0.0 <= reacting.imposed_delay_s < 1.0
    assert 0.3 < reacting.imposed_peak_mps2 < 20.0


def test_the_policy_sees_people_where_they_have_walked() -> None:
    place = environment(DETOUR, ONCOMING)
    policy = Scripted((1.3, 0.0))
    run_episode(place, trip(place.replay), policy, REACTING)
    tracks = [o.people[0].track for o in policy.observations if o.people]
    aside = [abs(float(track[-1][1]) - 0.1) for track in tracks]
    assert aside[0] == 0.0
    assert max(aside) > 0.2
    for before, after in pairwise(tracks):
        shared = min(len(before), len(after) - 1)
        np.testing.assert_array_equal(before[-shared:], after[-shared - 1 : -1])


def test_at_scale_0_every_episode_is_that_of_the_replay() -> None:
    place = Environment.of(Replay(busy_plaza()))
    still = replace(REACTING, reaction=0.0)
    for episode in choose_episodes(place.replay, RULES, 8, seed=1):
        recorded, reacting = (
            run_episode(place, episode, Straight(), rules) for rules in (RULES, still)
        )
        np.testing.assert_array_equal(recorded.trajectory, reacting.trajectory)
        assert reacting.score.displacement_m == 0.0
        assert reacting.score.imposed_peak_mps2 == 0.0
        assert reacting.score.gave_way == 0
        for name in ("people_touched", "clearance_m", "near_s", "pop_ins", "moved_toward"):
            assert getattr(recorded.score, name) == getattr(reacting.score, name)


def test_the_recorded_person_imposes_nothing_and_a_reversed_trip_does() -> None:
    place = environment(EAST, ONCOMING)
    assert run_episode(place, trip(place.replay), Human(), REACTING).score.displacement_m == 0.0
    beside = environment(EAST, walk("2", 0.0, (0, 0.4), (12, 0.4)))
    backward = trip(beside.replay, reverse=True)
    assert run_episode(beside, backward, Straight(), REACTING).score.displacement_m > 0.2


def test_the_same_episode_is_the_same_after_others() -> None:
    place = Environment.of(Replay(busy_plaza()))
    first, *others = choose_episodes(place.replay, RULES, 4, seed=1)
    once = run_episode(place, first, Straight(), REACTING).score
    for episode in others:
        run_episode(place, episode, Straight(), REACTING)
    again = run_episode(place, first, Straight(), REACTING).score
    assert again.displacement_m == once.displacement_m > 0.0
    other = run_episode(place, first, Straight(), replace(REACTING, people_seed=1)).score
    assert other.displacement_m != once.displacement_m


def test_who_appears_beside_the_robot_is_out_of_the_episode_for_everyone() -> None:
    near = walk("2", 2.0, (1.0, 0.9), (1.0, 5.0))
    place = environment(EAST, near)
    rules = replace(REACTING, time_limit_s=6.0)
    score = run_episode(place, trip(place.replay), Scripted((0.0, 0.0)), rules).score
    assert score.pop_ins == 1
    assert score.displacement_m == 0.0


def test_what_is_imposed_is_the_greatest_displacement_of_each_in_sum() -> None:
    place = environment(DETOUR, ONCOMING, walk("3", 0.0, (8, -4), (8, 6)))
    episode = trip(place.replay)
    people = ReactingPeople(place.replay, REACTING, episode)
    greatest = np.zeros(3)
    for tick in range(80):
        people.step(np.array([0.13 * tick, 0.0]), np.array([1.3, 0.0]), 0.25)
        for k in (1, 2):
            if tick + 1 <= people.last[k]:
                away = people.at(k, tick + 1) - place.replay.at(k, tick + 1)
                greatest[k] = max(greatest[k], float(np.hypot(*away)))
    assert people.imposed.displacement_m == pytest.approx(greatest.sum())
    assert (greatest[1:] > 0.05).all()


def test_people_are_not_driven_through_walls() -> None:
    wall = Obstacles(segments=(((-20.0, 0.6), (30.0, 0.6)),))
    place = environment(DETOUR, ONCOMING, obstacles=wall)
    people = ReactingPeople(place.replay, replace(REACTING, reaction=5.0), trip(place.replay))
    for tick in range(90):
        people.step(np.array([0.13 * tick, -0.1]), np.array([1.3, 0.0]), 0.25)
        assert people.at(1, tick + 1)[1] < 0.6
    assert people.imposed.displacement_m > 0.2

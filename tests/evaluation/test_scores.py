"""Scores of one episode and of many."""

import math
from dataclasses import replace

import numpy as np
import pytest

from esplanade.evaluation.contacts import ContactMonitor
from esplanade.evaluation.scores import Score, score, summarise
from tests.evaluation.worlds import RULES, Point, replay, trip, walk


def score_of(*velocities: Point, reached: bool = True, wall_m: float = 9.0) -> Score:
    walked = replay(walk("1", 0.0, (0, 0), (9.6, 0)))
    speeds = np.array(velocities)
    trajectory = np.concatenate([np.zeros((1, 2)), np.cumsum(0.1 * speeds, axis=0)])
    contacts = ContactMonitor(walked, RULES)
    return score(
        walked, RULES, trip(walked), contacts, 0, trajectory, speeds, wall_m, reached,
        [0.001] * len(speeds),
    )  # fmt: skip


def test_time_and_path_are_held_against_the_straight_way() -> None:
    found = score_of(*[(1.3, 0.0)] * 93)
    distance_m = 9.6 - RULES.goal_tolerance_m
    assert found.time_s == pytest.approx(9.3)
    assert found.time_ratio == pytest.approx(9.3 / (distance_m / 1.3))
    assert found.path_ratio == pytest.approx(93 * 0.13 / distance_m)
    assert (found.turn_rms_radps, found.acceleration_max_mps2, found.failed) == (0.0, 0.0, False)


def test_episodes_that_do_not_arrive_have_no_time() -> None:
    found = score_of((1.3, 0.0), (1.3, 0.0), reached=False)
    assert math.isnan(found.time_ratio)
    assert math.isnan(found.path_ratio)
    assert found.failed


def test_turns_count_while_walking_and_around_the_back() -> None:
    back = [(-1.0, 0.01), (-1.0, -0.01)]
    assert score_of(*back).turn_rms_radps == pytest.approx(0.2, rel=1e-3)
    slow = [(0.1, 0.0), (0.0, 0.1)]
    assert score_of(*slow).turn_rms_radps == 0.0


def test_a_single_tick_has_a_score() -> None:
    found = score_of((1.0, 0.0))
    assert (found.acceleration_rms_mps2, found.jerk_rms_mps3, found.decisions) == (0.0, 0.0, 1)


def test_walls_may_be_drawn_a_little_wrong() -> None:
    assert not score_of((1.0, 0.0), wall_m=0.151).wall_contact
    assert score_of((1.0, 0.0), wall_m=0.149).wall_contact


def test_a_summary_is_over_episodes_and_decisions() -> None:
    well = score_of(*[(1.3, 0.0)] * 93)
    lost = replace(
        well, reached=False, people_touched=2, moved_toward=True, clearance_m=-0.1,
        time_ratio=math.nan, path_ratio=math.nan, decisions=907, decision_ms=2.0,
        decision_max_ms=50.0,
    )  # fmt: skip
    both = summarise([well, lost])
    assert (both.episodes, both.contacts_percent, both.moved_toward_percent) == (2, 50.0, 50.0)
    assert both.reached_percent == 50.0
    assert both.time_ratio == pytest.approx(well.time_ratio)
    assert both.clearance_m == pytest.approx((well.clearance_m - 0.1) / 2)
    assert both.decision_ms == pytest.approx((93 * 1.0 + 907 * 2.0) / 1000)
    assert both.decision_max_ms == 50.0


def test_a_summary_of_those_who_never_arrive() -> None:
    assert math.isnan(summarise([score_of((1.0, 0.0), reached=False)]).time_ratio)

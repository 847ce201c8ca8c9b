"""Measures of many actors, on ways made by hand."""

import numpy as np
import pytest
from benchmarks._walks import Walks, judge

TICK_S = 0.5
SECONDS = 40


def walks(*tracks, goals):
    """Of actors of radius 0.25 m at 1 m/s in the open; each track is (T + 1, 2)."""
    positions = np.stack([np.asarray(track, dtype=float) for track in tracks], axis=1)
    left_m = np.hypot(*np.moveaxis(positions - np.asarray(goals, dtype=float), -1, 0))
    return Walks(positions, left_m, TICK_S, 0.25, 1.0, 0.2)


def straight(start, goal, speed_mps=1.0, wait_s=0.0):
    """Positions of one who waits, goes straight, and stays there."""
    start, goal = np.asarray(start, dtype=float), np.asarray(goal, dtype=float)
    walked_m = speed_mps * np.maximum(0.0, TICK_S * np.arange(2 * SECONDS + 1) - wait_s)
    way_m = np.hypot(*(goal - start))
    return start + np.minimum(1.0, walked_m / way_m)[:, None] * (goal - start)


def test_those_who_pass_between_two_ticks_have_touched() -> None:
    """At ticks they are 0.5 m to either side of each other, between them in the same place."""
    ways = [((-2.25, 0.0), (7.75, 0.0)), ((2.25, 0.0), (-7.75, 0.0))]
    found = walks(*(straight(*way) for way in ways), goals=[goal for _, goal in ways])
    assert np.hypot(*(found.positions[:, 0] - found.positions[:, 1]).T).min() == 0.5
    assert found.clearances_m[0, 1] == pytest.approx(-0.5)
    assert judge(found, np.ones(80)).contacts == 1


def test_clearance_is_the_smallest_of_all_pairs() -> None:
    ways = [((0.0, y), (10.0, y)) for y in (0.0, 1.0, 1.7)]
    found = walks(*(straight(*way) for way in ways), goals=[goal for _, goal in ways])
    verdict = judge(found, np.ones(80))
    assert verdict.contacts == 0
    assert verdict.clearance_m == pytest.approx(0.2)
    assert np.isinf(np.diag(found.clearances_m)).all()


def test_time_is_held_against_the_way_alone() -> None:
    ways = [((0.0, 0.0), (10.0, 0.0)), ((0.0, 5.0), (10.0, 5.0))]
    found = walks(straight(*ways[0]), straight(*ways[1], 0.5), goals=[goal for _, goal in ways])
    assert found.arrivals_s == pytest.approx([10.0, 20.0])
    assert found.time_ratios == pytest.approx([1.0, 2.0])
    verdict = judge(found, np.arange(101.0))
    assert (verdict.arrived_percent, verdict.last_s) == (100.0, 20.0)
    assert verdict.time_ratio == pytest.approx(1.5)
    assert verdict.worst_time_ratio == pytest.approx(2.0)
    assert (verdict.tick_p50_ms, verdict.tick_p99_ms) == (50.0, 99.0)


def test_who_never_arrives_has_no_time() -> None:
    found = walks(straight((0, 0), (5, 0)), straight((0, 5), (5, 5)), goals=[(5, 0), (30, 5)])
    verdict = judge(found, np.ones(80))
    assert (verdict.arrived_percent, verdict.last_s) == (50.0, None)
    assert verdict.time_ratio == pytest.approx(1.0)
    nobody = judge(walks(straight((0, 0), (1, 0)), goals=[(9, 0)]), np.ones(80))
    assert (nobody.time_ratio, nobody.worst_time_ratio) == (None, None)


@pytest.mark.parametrize(
    ("wait_s", "speed_mps", "stuck"),
    [(0.0, 1.0, False), (19.0, 1.0, False), (20.0, 1.0, True), (0.0, 0.02, True)],
)
def test_stuck_is_who_comes_no_nearer_in_twenty_seconds(wait_s, speed_mps, stuck) -> None:
    found = walks(straight((0.0, 0.0), (10.0, 0.0), speed_mps, wait_s), goals=[(10.0, 0.0)])
    assert found.stuck.tolist() == [stuck]


def test_nobody_is_stuck_after_arriving() -> None:
    found = walks(straight((0.0, 0.0), (2.0, 0.0)), goals=[(2.0, 0.0)])
    assert found.stuck.tolist() == [False]


def test_walking_to_and_fro_is_no_progress() -> None:
    """Only coming nearer than ever before counts."""
    to_and_fro = np.zeros((2 * SECONDS + 1, 2))
    to_and_fro[:, 0] = np.sin(np.arange(2 * SECONDS + 1))
    assert walks(to_and_fro, goals=[(9.0, 0.0)]).stuck.tolist() == [True]

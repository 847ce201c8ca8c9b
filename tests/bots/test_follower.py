"""Steering along a track, against a simulated server with rounding, delay and a speed limit."""

import math
import random
from collections.abc import Callable

import numpy as np
import pytest

from esplanade.bots.follower import Follower, Timeline
from esplanade.recordings import Track

TICK_S = 0.05
Vector = tuple[float, float]


def track_of(*samples: tuple[float, float, float]) -> Track:
    table = np.array(samples, dtype=np.float64)
    return Track("1", table[:, 0], table[:, 1:])


def winding_track(seed: int = 1, seconds: float = 20.0) -> Track:
    """Somebody who walks about, stops and turns, sampled every 0.4 s like the recordings."""
    rng = random.Random(seed)
    samples = [(0.0, 2.0, 3.0)]
    direction, speed = 0.0, 1.3
    while samples[-1][0] < seconds:
        t, x, y = samples[-1]
        direction += rng.gauss(0.0, 0.5)
        speed = 0.0 if rng.random() < 0.15 else min(max(speed + rng.gauss(0.0, 0.3), 0.4), 2.0)
        step = 0.4 * speed
        samples.append((t + 0.4, x + step * math.cos(direction), y + step * math.sin(direction)))
    return track_of(*samples)


def simulate(
    follower: Follower,
    timeline: Timeline,
    start: Vector,
    ticks: int,
    delay: Callable[[], int] = lambda: 0,
    max_speed_mps: float = 10.0,
) -> tuple[list[float], list[Vector]]:
    """A server's ticks: a command counts `delay()` ticks after the one that follows it.

    Returns deviations in metres on the track's time, and every position as reported.
    """
    position, velocity, ack = start, (0.0, 0.0), 0
    under_way: list[tuple[int, int, Vector]] = []
    deviations, positions = [], []
    for tick in range(timeline.base_tick, timeline.base_tick + ticks):
        for due, seq, wish in sorted(under_way):
            if due <= tick and seq > ack:
                ack, velocity = seq, wish
        under_way = [entry for entry in under_way if entry[0] > tick]
        position = (position[0] + velocity[0] * TICK_S, position[1] + velocity[1] * TICK_S)
        reported = (round(position[0], 2), round(position[1], 2))
        positions.append(reported)
        deviation = follower.deviation_m(tick, reported)
        if deviation is not None:
            deviations.append(deviation)
        command = follower.steer(tick, ack, reported)
        if command is not None:
            speed = min(command.speed, max_speed_mps)
            wish = (speed * math.cos(command.direction), speed * math.sin(command.direction))
            under_way.append((tick + 1 + delay(), command.seq, wish))
    return deviations, positions


def timeline_for(track: Track, speedup: float = 1.0) -> Timeline:
    """Begins a quarter of a second before the track, as a replay does."""
    return Timeline(400, track.start_s - 0.25 * speedup, TICK_S, speedup)


@pytest.mark.parametrize("speedup", [1.0, 4.0])
@pytest.mark.parametrize("delay_ticks", [0, 1, 3])
def test_it_stays_on_a_winding_track(speedup: float, delay_ticks: int) -> None:
    track = winding_track()
    timeline = timeline_for(track, speedup)
    follower = Follower(track, timeline, max_speed_mps=20.0)
    ticks = int((track.end_s / speedup + 0.5) / TICK_S)
    deviations, _ = simulate(
        follower, timeline, track.at(0.0), ticks, lambda: delay_ticks, max_speed_mps=20.0
    )
    assert len(deviations) > track.end_s / speedup / TICK_S - 2
    settled = deviations[2 * delay_ticks + 2 :]
    assert max(settled) < 0.03


def test_it_stays_near_when_the_delay_varies() -> None:
    track, rng = winding_track(seed=5), random.Random(2)
    timeline = timeline_for(track)
    follower = Follower(track, timeline, max_speed_mps=10.0)
    deviations, _ = simulate(
        follower, timeline, track.at(0.0), 400, lambda: rng.choice((0, 0, 0, 1, 2))
    )
    assert max(deviations) < 0.1
    assert sorted(deviations)[len(deviations) // 2] < 0.02


def test_it_recovers_from_a_wrong_start() -> None:
    track = track_of((0.0, 0.0, 0.0), (20.0, 20.0, 0.0))
    timeline = timeline_for(track)
    follower = Follower(track, timeline, max_speed_mps=10.0)
    deviations, _ = simulate(follower, timeline, (-1.0, 2.0), 100)
    assert max(deviations[10:]) < 0.02


def test_who_is_to_stand_stands_still() -> None:
    track = track_of((0.0, 1.0, 1.0), (10.0, 1.0, 1.0))
    timeline = timeline_for(track)
    follower = Follower(track, timeline, max_speed_mps=10.0)
    _, positions = simulate(follower, timeline, (1.01, 1.0), 50)
    assert set(positions) == {(1.01, 1.0)}


def test_a_command_that_changes_nothing_is_not_sent() -> None:
    track = track_of((0.0, 1.0, 1.0), (10.0, 1.0, 1.0))
    follower = Follower(track, timeline_for(track), max_speed_mps=10.0)
    commands = [follower.steer(400 + tick, 0, (1.0, 1.0)) for tick in range(10)]
    assert [command is not None for command in commands] == [True] + [False] * 9


def test_a_track_beyond_the_limit_is_capped_and_said_so() -> None:
    track = track_of((0.0, 0.0, 0.0), (10.0, 50.0, 0.0))
    timeline = Timeline(0, 0.0, TICK_S, 1.0)
    command = Follower(track, timeline, max_speed_mps=3.0).steer(10, 0, (0.0, 0.0))
    assert command is not None
    assert command.speed == pytest.approx(3.0)
    assert command.capped
    slow = Follower(track, timeline, max_speed_mps=5.5).steer(0, 0, (-1.0, 0.0))
    assert slow is not None
    assert slow.speed == pytest.approx(5.5)
    assert not slow.capped


def test_deviation_is_only_told_on_the_way() -> None:
    track = track_of((1.0, 0.0, 0.0), (2.0, 4.0, 0.0))
    follower = Follower(track, Timeline(0, 0.0, TICK_S, 1.0), max_speed_mps=5.0)
    assert follower.deviation_m(19, (0.0, 0.0)) is None
    assert follower.deviation_m(30, (2.0, 3.0)) == pytest.approx(3.0)
    assert follower.deviation_m(41, (0.0, 0.0)) is None


def test_a_timeline_scales_time() -> None:
    timeline = Timeline(base_tick=100, base_s=7.0, tick_s=TICK_S, speedup=4.0)
    assert timeline.recorded_s(100) == 7.0
    assert timeline.recorded_s(120) == pytest.approx(11.0)
    assert timeline.recorded_s(80) == pytest.approx(3.0)

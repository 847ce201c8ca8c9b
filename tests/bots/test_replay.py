"""Replay over real sockets against a scripted server."""

import asyncio
import math

import numpy as np
import pytest

from esplanade.bots.replay import NEAR_M, ReplayJob
from esplanade.bots.tally import Tally
from esplanade.protocol.messages import Move
from esplanade.recordings import Track, read_crowd
from tests.bots.scripted import scripted_server, until
from tests.patience import PATIENCE_S
from tests.recordings.data import recorded


def track(name: str, start_s: float, end_s: float, speed_mps: float = 1.3) -> Track:
    """Somebody who walks a slow curve, sampled every 0.4 s."""
    times = np.arange(start_s, end_s + 1e-9, 0.4)
    angles = 0.3 * (times - start_s)
    radius_m = speed_mps / 0.3
    ways = np.stack([radius_m * np.cos(angles), radius_m * np.sin(angles)], axis=1)
    return Track(name, times, ways)


TRACKS = (track("7", 10.0, 14.0), track("8", 11.0, 13.0, speed_mps=0.6), track("9", 12.0, 15.0))


@pytest.fixture(autouse=True)
def _early(monkeypatch: pytest.MonkeyPatch) -> None:
    """Everybody joins so early that they stand at their first place on a slow machine too."""
    monkeypatch.setattr("esplanade.bots.replay.LEAD_S", 2.0)


async def test_everyone_joins_follows_and_leaves_at_their_time() -> None:
    tally = Tally()
    async with scripted_server() as server:
        await ReplayJob(server.url, TRACKS, speedup=2.0, linger_s=0.0).run(tally, asyncio.Event())
        await until(lambda: not server.people)
    assert (tally.expected, tally.joined, tally.left) == (3, 3, 3)
    assert tally.well
    assert tally.capped == 0
    # 9 recorded seconds at twice the speed are 90 ticks of 50 ms.
    assert 80 <= tally.deviation_m.count <= 93
    # The first commands may be late.
    assert tally.near > 0.9 * tally.deviation_m.count
    assert [person.hello.name for person in server.all_people] == [
        "Pedestrian 7",
        "Pedestrian 8",
        "Pedestrian 9",
    ]
    for person, walked in zip(server.all_people, TRACKS, strict=True):
        assert person.hello.at is not None
        assert person.hello.at[:2] == pytest.approx(walked.at(walked.start_s))


async def test_delayed_commands_are_compensated() -> None:
    tally = Tally()
    async with scripted_server(delay_ticks=2) as server:
        await ReplayJob(server.url, TRACKS[:1], 1.0, 0.0).run(tally, asyncio.Event())
    middle = tally.deviation_m.percentile(50)
    assert middle is not None
    assert middle < NEAR_M / 2


async def test_lingering_is_standing_at_the_end() -> None:
    tally = Tally()
    async with scripted_server() as server:
        job = ReplayJob(server.url, TRACKS[1:2], speedup=4.0, linger_s=1.0)
        running = asyncio.create_task(job.run(tally, asyncio.Event()))
        end = TRACKS[1].at(99.0)
        await until(
            lambda: bool(server.people) and math.dist(server.people[1].position, end) < 0.05
        )
        tick = server.tick
        await until(lambda: not server.people)
        assert server.tick - tick >= 15
        await running
    last = [message for message in server.all_people[0].heard if isinstance(message, Move)][-1]
    assert last.speed == 0.0


async def test_a_speed_limit_caps_and_is_counted() -> None:
    tally = Tally()
    async with scripted_server(max_speed=1.0) as server:
        await ReplayJob(server.url, TRACKS[:1], 2.0, 0.0).run(tally, asyncio.Event())
    assert tally.capped > 0
    assert tally.left == 1
    speeds = [message.speed for message in server.all_people[0].heard if isinstance(message, Move)]
    assert max(speeds) <= 1.0 + 1e-9


async def test_stop_takes_everyone_out() -> None:
    tally, stop = Tally(), asyncio.Event()
    async with scripted_server() as server:
        running = asyncio.create_task(ReplayJob(server.url, TRACKS, 1.0, 0.0).run(tally, stop))
        await until(lambda: tally.joined >= 1)
        stop.set()
        await asyncio.wait_for(running, PATIENCE_S)
        await until(lambda: not server.people)
    assert tally.present == 0
    assert tally.lost == 0


async def test_a_recorded_crowd() -> None:
    """People who left within the first twenty seconds of a recording are replayed in five."""
    crowd = read_crowd(recorded("zara1"))
    tracks = tuple(each for each in crowd.tracks if each.end_s < 20.0)
    tally = Tally()
    async with scripted_server(max_speed=20.0) as server:
        await ReplayJob(server.url, tracks, speedup=4.0, linger_s=0.0).run(tally, asyncio.Event())
    assert tally.joined == tally.left == len(tracks) > 5
    assert tally.well
    assert tally.near > 0.9 * tally.deviation_m.count

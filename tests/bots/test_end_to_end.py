"""Bots against the real server, in this process, over real sockets."""

import asyncio
import json
import math
import time
from collections.abc import AsyncIterator
from pathlib import Path

import numpy as np
import pytest

from esplanade import bots
from esplanade.bots.load import LoadJob
from esplanade.bots.replay import ReplayJob
from esplanade.bots.tally import Tally
from esplanade.protocol import Gesture
from esplanade.protocol.messages import Chat, GestureMade, Travel
from esplanade.recordings import Crowd, read_crowd
from esplanade.server.app import Running, running
from esplanade.server.net.schedule import Schedule
from esplanade.server.settings import ServerSettings
from tests.bots.scripted import until
from tests.server.zones import BEFORE_GATE, IN_GATE, YARD, write_town


def two_people() -> str:
    """Two who cross in the middle of a square, one of them through a wall's end."""
    lines = ["t,id,x,y"]
    for step in range(16):
        t = 0.4 * step
        lines.append(f"{t:.1f},ann,{-4 + 1.3 * t:.3f},0.3")
        lines.append(f"{t + 0.2:.1f},bob,0.2,{-3 + t:.3f}")
    return "\n".join(lines) + "\n"


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    path = tmp_path / "crossing.csv"
    path.write_text(two_people())
    path.with_suffix(".walls.json").write_text('{"segments": [[0.1, -1, 3, -1]]}')
    return path


@pytest.fixture
def crowd(recording: Path) -> Crowd:
    return read_crowd(recording)


class Unhurried(Schedule):
    """A schedule of ticks at least a period apart, so that every snapshot can be answered."""

    def begin(self, now: float) -> None:
        super().begin(now)
        self._next = max(self._next, now + self._period_s)


@pytest.fixture
async def server(recording: Path, monkeypatch: pytest.MonkeyPatch) -> AsyncIterator[Running]:
    monkeypatch.setattr("esplanade.server.served_zone.Schedule", Unhurried)
    monkeypatch.setattr("esplanade.bots.replay.LEAD_S", 2.0)
    settings = ServerSettings(
        crowd=recording, actors=0, host="127.0.0.1", port=0, private_port=0, resume_seconds=20.0
    )
    async with running(settings) as server:
        yield server


def url_of(server: Running) -> str:
    return f"ws://127.0.0.1:{server.port}"


@pytest.fixture
async def town(tmp_path: Path) -> AsyncIterator[Running]:
    """A world of two zones. Whoever comes in without the key to stand where they wish comes in amid
    the gate."""
    world = write_town(tmp_path)
    spawns = [{"position": IN_GATE[:2], "radius_m": 0.5}]
    (tmp_path / "yard.json").write_text(json.dumps({**YARD, "spawns": spawns}))
    settings = ServerSettings(
        world=world,
        actors=0,
        host="127.0.0.1",
        port=0,
        private_port=0,
        operator_key="key",
    )
    async with running(settings) as server:
        yield server


async def test_a_bot_walks_through_a_portal_and_looks_about_anew(town: Running) -> None:
    async with (
        bots.connect(url_of(town), "Ann", at=BEFORE_GATE, operator="key") as ann,
        bots.connect(url_of(town), "Bob", at=(14.0, 9.0, 0.0), operator="key") as bob,
    ):
        await until(lambda: bob.id in ann.others)
        token = ann.resume_token
        await ann.move(0.0, 2.0)
        async for event in ann.events():
            if isinstance(event, Travel):
                assert (event.zone, event.portal) == ("hall", "door")
                break
        await until(lambda: math.dist(ann.position[:2], (4.0, 6.0)) < 0.1)
        assert ann.welcome.scene["name"] == "The hall"
        assert ann.others == {}
        assert ann.resume_token == token
        await ann.move(0.0, 2.0)
        await until(lambda: ann.position[0] > 6.0)


async def test_visitors_go_on_in_the_zone_that_they_have_come_into(town: Running) -> None:
    tally, stop = Tally(), asyncio.Event()
    job = LoadJob(url_of(town), count=3, first=0, step=1, seed=1, join_rate=50.0, duration_s=0.0)
    running = asyncio.create_task(job.run(tally, stop))
    hall = town.zones["hall"].hub
    await until(lambda: len(hall.sessions) == 3)
    ids = list(hall.sessions)
    places = {one: town.zones["hall"].world.where(one) for one in ids}
    received = tally.snapshots_received
    # They walk in the hall as in any scene, and their snapshots are counted on.
    await until(
        lambda: (
            any(
                one in hall.sessions
                and math.dist(town.zones["hall"].world.where(one), places[one]) > 1.0
                for one in ids
            )
            and tally.snapshots_received > received + 20
        )
    )
    stop.set()
    await running
    assert (tally.joined, tally.left, tally.lost) == (3, 3, 0)


async def test_bots_wave_and_know_who_is_away(server: Running) -> None:
    url = url_of(server)
    async with bots.connect(url, name="Ann") as ann, bots.connect(url, name="Bob") as bob:
        await until(lambda: bob.id in ann.others)
        await bob.be_away()
        await until(lambda: ann.others[bob.id].away)
        await bob.be_away(False)
        await until(lambda: not ann.others[bob.id].away)
        await bob.gesture(Gesture.WAVE)
        async for event in ann.events():
            if isinstance(event, GestureMade):
                assert (event.id, event.gesture) == (bob.id, Gesture.WAVE)
                break


async def test_two_bots_meet_walk_and_talk(server: Running) -> None:
    url = url_of(server)
    async with (
        bots.connect(url, name="Ann", at=(-2.0, 2.0, 0)) as ann,
        bots.connect(url, name="Bob", at=(2.0, 2.0, 0)) as bob,
    ):
        assert ann.position[:2] == pytest.approx((-2.0, 2.0), abs=0.5)
        await until(lambda: bob.id in ann.others and ann.id in bob.others)
        assert ann.others[bob.id].name == "Bob"
        start = bob.position
        sequence = await bob.move(math.pi / 2, 1.0)
        await until(lambda: bob.acknowledged >= sequence and bob.position[1] > start[1] + 0.3)
        await until(lambda: ann.others[bob.id].y > start[1] + 0.3)
        await bob.stop()
        await ann.walk_to(1.0, 1.0)
        await until(lambda: math.dist(ann.position[:2], (1.0, 1.0)) < 0.3)
        begin_s = time.monotonic()
        assert 0.0 < await ann.ping() <= time.monotonic() - begin_s
        await ann.chat("good day")
        async for event in bob.events():
            if isinstance(event, Chat):
                assert (event.id, event.name, event.text) == (ann.id, "Ann", "good day")
                break
        me = bob.id
    async with bots.connect(url, name="Cid") as cid:
        await until(lambda: me not in cid.others)


async def test_a_lost_bot_comes_back_as_the_same_avatar(server: Running) -> None:
    url = url_of(server)
    async with bots.connect(url, name="Ann", at=(2.0, 2.0, 0)) as ann:
        first, token, place = ann.id, ann.resume_token, ann.position
        ann._connection._socket.transport.abort()
        with pytest.raises(bots.Disconnected):
            async for _ in ann.events():
                pass
    async with bots.connect(url, name="Ann", resume=token) as again:
        assert again.id == first
        assert again.welcome.resumed
        assert again.position == pytest.approx(place, abs=0.02)


async def test_visitors_do_well(server: Running) -> None:
    tally, stop = Tally(), asyncio.Event()
    job = LoadJob(url_of(server), count=8, first=0, step=1, seed=3, join_rate=50.0, duration_s=0.0)
    running = asyncio.create_task(job.run(tally, stop))
    await until(lambda: tally.round_trip_s.count >= 8 * 3 and tally.snapshot_age_s.count > 8)
    stop.set()
    await running
    assert (tally.joined, tally.left, tally.lost) == (8, 8, 0)
    assert tally.well


async def test_recorded_people_follow_their_way_past_walls(server: Running, crowd: Crowd) -> None:
    tally = Tally()
    job = ReplayJob(url_of(server), crowd.tracks, speedup=1.0, linger_s=0.0)
    await job.run(tally, asyncio.Event())
    assert (tally.joined, tally.left) == (2, 2)
    assert tally.well
    assert tally.capped == 0
    expected = sum(np.ptp(track.times) for track in crowd.tracks) * 20
    assert tally.deviation_m.count > 0.5 * expected
    # A busy machine may make a command late: most must hold, not all.
    assert tally.near > 0.9 * tally.deviation_m.count
    middle = tally.deviation_m.percentile(50)
    assert middle is not None
    assert middle < 0.02

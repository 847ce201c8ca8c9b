"""Movements are leases: a client that falls silent while its avatar walks loses it."""

import time
from typing import cast

import pytest
from websockets.protocol import State

from esplanade.protocol import ByeCode, CloseCode, ErrorCode
from esplanade.protocol.messages import Bye, Error, WalkTo
from esplanade.server.net import leases
from esplanade.server.net.leases import (
    CHECK_S,
    END_S,
    IDLE_END_S,
    IDLE_PING_S,
    HeardConnection,
    Lease,
    Leases,
)
from tests.server.client import Client, joined
from tests.server.conftest import Serving


class QuietConnection:
    """A connection whose signs of life a test gives."""

    state = State.OPEN

    def __init__(self) -> None:
        self.heard = True
        self.pings = 0

    def ask_for_sign(self) -> None:
        self.pings += 1


class Silence:
    """One avatar that moves or not, and a clock."""

    def __init__(self, moves: bool) -> None:
        self.moves = moves
        self.connection = QuietConnection()
        self.lease = Lease(cast(HeardConnection, self.connection))
        self.leases = Leases(lambda _: self.moves)
        self.now = 100.0
        self.lapsed: list[float] = []
        self.gone: list[float] = []
        self.begin = self.now

    def wait(self, seconds: float, period: float = 0.05) -> None:
        """Let time go by in ticks, and note when the avatar lapses and the client is gone."""
        for _ in range(round(seconds / period)):
            self.now += period
            lapsed, gone = self.leases.check([(7, self.lease)], self.now)
            self.lapsed += [self.now - self.begin] * len(lapsed)
            self.gone += [self.now - self.begin] * len(gone)


def test_a_silent_walker_is_pinged_once_then_stands_then_is_gone() -> None:
    silence = Silence(moves=True)
    silence.wait(1.0)
    assert silence.connection.pings == 0
    silence.wait(0.6)
    assert (silence.connection.pings, silence.lapsed) == (1, [])
    silence.wait(10.0)
    assert silence.connection.pings == 1
    assert len(silence.lapsed) == 1
    assert 2.0 <= silence.lapsed[0] <= 2.0 + 4 * CHECK_S
    assert END_S <= silence.gone[0] <= 10.0


def test_signs_keep_a_walker_going() -> None:
    silence = Silence(moves=True)
    for _ in range(20):
        silence.wait(1.8)
        silence.connection.heard = True
    assert (silence.lapsed, silence.gone) == ([], [])
    assert silence.connection.pings == 20


def test_who_stands_is_pinged_late_and_gone_later() -> None:
    silence = Silence(moves=False)
    silence.wait(IDLE_PING_S - 0.5)
    assert silence.connection.pings == 0
    silence.wait(1.5)
    assert silence.connection.pings == 1
    silence.wait(IDLE_END_S - IDLE_PING_S)
    assert silence.lapsed == []
    assert IDLE_END_S <= silence.gone[0] <= IDLE_END_S + 4 * CHECK_S


def test_a_walk_that_begins_late_is_not_ended_before_a_ping_was_sent() -> None:
    silence = Silence(moves=False)
    silence.wait(5.0)
    silence.moves = True
    silence.wait(0.5)
    assert (silence.connection.pings, silence.lapsed) == (1, [])
    silence.wait(1.6)
    assert len(silence.lapsed) == 1


def test_time_in_which_the_server_did_not_listen_does_not_count() -> None:
    silence = Silence(moves=True)
    silence.wait(0.5)
    silence.now += 60.0
    silence.wait(0.25)
    assert (silence.connection.pings, silence.lapsed, silence.gone) == (0, [], [])


async def freeze(client: Client) -> None:
    """Stop a client as one whose process is stopped: it reads nothing, and answers nothing."""
    client.connection.transport.pause_reading()


async def stood_still_s(watcher: Client, avatar_id: int) -> float:
    """Watch a walker until it stands for a while; the seconds until its last move."""
    began = last = time.monotonic()
    place = watcher.positions[avatar_id]
    while time.monotonic() - last < 1.5:
        await watcher.ticks(1)
        if watcher.positions[avatar_id] != place:
            place, last = watcher.positions[avatar_id], time.monotonic()
    return last - began


@pytest.mark.parametrize("way", ["move", "walk_to"])
async def test_a_frozen_client_stands_within_three_seconds(serving: Serving, way: str) -> None:
    async with (
        serving(person_walk_speed_mps=0.5) as server,
        joined(server.port, "Eve", at=(5.0, 5.0, 0)) as eve,
        joined(server.port, "Ann", at=(2.0, 2.0, 0)) as ann,
    ):
        if way == "move":
            await ann.move(1.5708, 0.5)
        else:
            await ann.send(WalkTo(seq=1, x=2.0, y=18.0))
        await eve.wait_for(lambda: eve.positions.get(ann.id, (0.0, 0.0))[1] > 2.2)
        await freeze(ann)
        assert 0.5 < await stood_still_s(eve, ann.id) <= 3.0
        assert eve.positions[ann.id][1] < 4.0
        ann.connection.transport.resume_reading()
        assert (await ann.until(Error)).error is ErrorCode.LEASE_ENDED
        # A sign of life later the client is in command again.
        await ann.move(0.0, 1.0)
        await ann.wait_for(lambda: ann.position[0] > 2.5)


async def test_a_client_that_only_answers_pings_walks_on(serving: Serving) -> None:
    async with serving() as server, joined(server.port, at=(2.0, 2.0, 0)) as client:
        # The library answers pings, as browsers do for a hidden tab; nothing else is sent.
        await client.move(1.5708, 0.5)
        await client.wait_for(lambda: client.position[1] > 2.2)
        began, tick = client.position[1], client.tick
        await client.ticks(100)
        walked_m = client.position[1] - began
        assert walked_m == pytest.approx(0.5 * (client.tick - tick) / 20.0, abs=0.2)


async def test_a_frozen_walker_gives_its_seat_up_and_may_come_back(
    serving: Serving, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(leases, "END_S", 3.0)
    async with serving() as server, joined(server.port, "Ann", at=(2.0, 2.0, 0)) as ann:
        await ann.move(0.0, 0.5)
        await ann.wait_for(lambda: ann.position[0] > 2.2)
        await freeze(ann)
        async with joined(server.port, "Eve") as eve:
            await eve.wait_for(lambda: b"esplanade_clients_away 1.0" in server.metrics.exposition())
        ann.connection.transport.resume_reading()
        messages, code = await ann.last_words()
        # A client that stays frozen is cut off in the end, and hears of nothing.
        assert code in (CloseCode.SILENT, 1006)
        if code == CloseCode.SILENT:
            assert [m.reason for m in messages if isinstance(m, Bye)] == [ByeCode.SILENT]
        assert ann.welcome is not None
        async with joined(server.port, "Ann", resume=ann.welcome.resume) as again:
            assert again.id == ann.id


async def test_an_idle_client_is_pinged_and_stays(
    serving: Serving, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(leases, "IDLE_PING_S", 0.5)
    monkeypatch.setattr(leases, "IDLE_END_S", 3.0)
    async with serving() as server, joined(server.port) as idle:
        await idle.ticks(100)
        assert b"esplanade_clients 1.0" in server.metrics.exposition()
        await freeze(idle)
        async with joined(server.port, "Eve") as eve:
            await eve.wait_for(lambda: b"esplanade_clients_away 1.0" in server.metrics.exposition())
        idle.connection.transport.abort()

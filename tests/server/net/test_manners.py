"""Gestures, and who is away: told to those who have the avatar in view."""

import pytest

from esplanade.protocol import CloseCode, ErrorCode, Gesture
from esplanade.protocol.messages import (
    Away,
    Error,
    GestureMade,
    Hello,
    MakeGesture,
    Presence,
    Snapshot,
    Welcome,
)
from esplanade.server.net.session import GESTURE_BURST
from tests.server.client import PLACING_KEY, connected, joined
from tests.server.conftest import Serving


async def test_a_gesture_is_seen_by_those_who_see_the_avatar(serving: Serving) -> None:
    async with (
        serving() as server,
        joined(server.port, "Ann", at=(2.0, 2.0, 0)) as ann,
        joined(server.port, "Ben", at=(2.0, 3.0, 0)) as ben,
    ):
        await ann.send(MakeGesture(gesture=Gesture.WAVE))
        for client in (ann, ben):
            assert await client.until(GestureMade) == GestureMade(id=ann.id, gesture=Gesture.WAVE)


async def test_gestures_are_bounded_in_rate(serving: Serving) -> None:
    async with serving() as server, joined(server.port) as ann:
        for _ in range(GESTURE_BURST + 1):
            await ann.send(MakeGesture(gesture=Gesture.NOD))
        error = await ann.until(Error)
        assert (error.error, error.text[:24]) == (ErrorCode.FLOODING, "you make gestures too fa")
        await ann.ticks(2)


@pytest.mark.parametrize("gesture", [0, 7])
async def test_a_gesture_that_nobody_knows_is_refused(serving: Serving, gesture: int) -> None:
    wrong = MakeGesture.model_construct(gesture=gesture)
    async with serving() as server, joined(server.port) as ann:
        await ann.send(wrong)
        assert await ann.refusal() == (ErrorCode.INVALID, CloseCode.INVALID)


async def test_others_are_told_who_is_away_and_back(serving: Serving) -> None:
    async with (
        serving() as server,
        joined(server.port, "Ann", at=(2.0, 2.0, 0)) as ann,
        joined(server.port, "Ben", at=(2.0, 3.0, 0)) as ben,
    ):
        for away in (True, False, True):
            await ann.send(Presence(away=away))
            assert await ben.until(Away) == Away(id=ann.id, away=away)
        # Whoever comes later learns of it once they see the avatar.
        async with connected(server.port) as cid:
            hello = Hello(name="Cid", version=5, at=(3.0, 2.0, 0), operator=PLACING_KEY)
            await cid.send(hello)
            assert await cid.until(Away) == Away(id=ann.id, away=True)
            assert ann.id in cid.entities


async def test_an_avatar_that_waits_for_its_person_is_away(serving: Serving) -> None:
    async with serving() as server, joined(server.port, "Ben", at=(2.0, 3.0, 0)) as ben:
        async with joined(server.port, "Ann", at=(2.0, 2.0, 0)) as ann:
            assert ann.welcome is not None
            token = ann.welcome.resume
            await ann.connection.close(CloseCode.GOING_AWAY)
            assert await ben.until(Away) == Away(id=ann.id, away=True)
        async with joined(server.port, "Ann", resume=token) as again:
            assert again.id == ann.id
            assert await ben.until(Away) == Away(id=ann.id, away=False)


async def test_a_client_of_the_version_before_is_served(serving: Serving) -> None:
    async with serving() as server, connected(server.port) as old:
        await old.send(Hello(name="Old", version=4))
        assert (await old.until(Welcome)).version == 4
        await old.until(Snapshot)

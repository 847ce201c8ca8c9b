"""Looks of people: told to those who see them, kept with the avatar wherever it goes."""

import math
from pathlib import Path

from esplanade.protocol import VERSION, CloseCode, ErrorCode
from esplanade.protocol.looks import NO_LOOK, Look
from esplanade.protocol.messages import ChooseLook, Error, Hello, Reshape, Travel, Welcome
from esplanade.server.net.session import LOOK_BURST
from tests.server.client import PLACING_KEY, Client, connected, joined
from tests.server.conftest import Serving
from tests.server.zones import BEFORE_GATE, until, write_town

RED = Look(shirt=1, trousers=3, hair=2, hair_colour=4, skin=5, stature_cm=185)
BLUE = Look(shirt=2, stature_cm=155)


def look_of(client: Client, avatar_id: int) -> Look | None:
    """The look of somebody in a client's view; None while they are not."""
    known = client.entities.get(avatar_id)
    return None if known is None else known.look


async def test_others_see_the_look_of_somebody_who_comes_in(serving: Serving) -> None:
    async with (
        serving() as server,
        joined(server.port, "Ben", at=(2.0, 3.0, 0)) as ben,
        joined(server.port, "Ann", at=(2.0, 2.0, 0), look=RED) as ann,
    ):
        await ben.wait_for(lambda: ann.id in ben.entities)
        for client in (ann, ben):
            assert client.entities[ann.id].look == RED
            assert math.isclose(client.entities[ann.id].stature_m, 1.85)
            assert client.entities[ben.id].look == NO_LOOK
        # A taller body has longer legs in the same measure.
        assert 0.9 < ann.entities[ann.id].leg_m < 1.05


async def test_a_look_that_is_changed_is_told_and_found_later(serving: Serving) -> None:
    async with (
        serving() as server,
        joined(server.port, "Ben", at=(2.0, 3.0, 0)) as ben,
        joined(server.port, "Ann", at=(2.0, 2.0, 0)) as ann,
    ):
        natural_m = ann.entities[ann.id].stature_m
        await ben.wait_for(lambda: ann.id in ben.entities)
        await ann.send(ChooseLook(look=BLUE))
        for client in (ann, ben):
            told = await client.until(Reshape)
            assert (told.id, told.look) == (ann.id, BLUE)
            assert math.isclose(told.stature_m, 1.55)
        async with joined(server.port, "Cid", at=(3.0, 2.0, 0)) as cid:
            assert cid.entities[ann.id].look == BLUE
        # Without one the avatar is again as its id has it.
        await ann.send(ChooseLook(look=NO_LOOK))
        told = await ben.until(Reshape)
        assert (told.look, told.stature_m) == (NO_LOOK, natural_m)


async def test_a_look_comes_back_with_its_person(serving: Serving) -> None:
    async with serving() as server, joined(server.port, "Ben", at=(2.0, 3.0, 0)) as ben:
        async with joined(server.port, "Ann", at=(2.0, 2.0, 0), look=RED) as ann:
            assert ann.welcome is not None
            token = ann.welcome.resume
            await ann.connection.close(CloseCode.GOING_AWAY)
        async with joined(server.port, "Ann", resume=token) as again:
            assert (again.id, again.entities[again.id].look) == (ann.id, RED)
            assert again.welcome is not None
            token = again.welcome.resume
            await again.connection.close(CloseCode.GOING_AWAY)
        async with joined(server.port, "Ann", resume=token, look=BLUE) as changed:
            await changed.wait_for(lambda: look_of(changed, ann.id) == BLUE)
            await ben.wait_for(lambda: look_of(ben, ann.id) == BLUE)


async def test_a_look_goes_along_through_a_portal(serving: Serving, tmp_path: Path) -> None:
    async with (
        serving(scene=None, world=write_town(tmp_path)) as server,
        joined(server.port, at=BEFORE_GATE, look=RED) as ann,
    ):
        before = ann.entities[ann.id]
        await ann.move(0.0, 2.0)
        await ann.until(Travel)
        await ann.until(Welcome)
        await ann.wait_for(lambda: ann.id in ann.entities)
        after = ann.entities[ann.id]
        assert (after.look, after.leg_m, after.stature_m) == (RED, before.leg_m, before.stature_m)
        await until(lambda: server.zones["hall"].world.state.look(ann.id) == RED)


async def test_a_look_that_does_not_exist_is_refused_by_its_field(serving: Serving) -> None:
    wrong = ChooseLook.model_construct(look=Look(shirt=13))
    async with serving() as server, joined(server.port) as ann:
        await ann.send(wrong)
        messages, code = await ann.last_words()
        (error,) = [message for message in messages if isinstance(message, Error)]
        assert (error.error, code) == (ErrorCode.INVALID, CloseCode.INVALID)
        assert "shirt is 13; it can be 0 or 1 to 12" in error.text


async def test_looks_are_bounded_in_rate(serving: Serving) -> None:
    async with serving() as server, joined(server.port) as ann:
        for number in range(LOOK_BURST + 1):
            await ann.send(ChooseLook(look=Look(shirt=number + 1)))
        error = await ann.until(Error)
        assert (error.error, error.text[:28]) == (
            ErrorCode.FLOODING,
            "you change your look too fast"[:28],
        )


async def test_a_client_of_the_version_before_is_served(serving: Serving) -> None:
    async with (
        serving() as server,
        joined(server.port, "Ann", at=(2.0, 2.0, 0), look=RED) as ann,
        connected(server.port) as old,
    ):
        await old.send(Hello(name="Old", version=5, at=(3.0, 2.0, 0), operator=PLACING_KEY))
        assert VERSION > (await old.until(Welcome)).version == 5
        await old.wait_for(lambda: ann.id in old.entities)

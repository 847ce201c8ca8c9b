"""People who walk through portals, over real sockets."""

import asyncio
import math
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack
from pathlib import Path

import pytest
import pytest_asyncio

from esplanade.protocol import VERSION, CloseCode, ErrorCode, NoticeCode
from esplanade.protocol.messages import (
    Chat,
    ChatLine,
    Hello,
    MutePerson,
    Notice,
    Travel,
    Welcome,
)
from esplanade.server.app import Running
from esplanade.server.net import hops
from tests.server.client import Client, connected, joined
from tests.server.conftest import Serving
from tests.server.http import get
from tests.server.zones import BEFORE_GATE, IN_GATE, until, write_town

EAST, WEST = 0.0, math.pi


async def travelled(client: Client) -> Welcome:
    """Read on until the client is in another zone and has seen itself there."""
    await client.until(Travel)
    client.entities.clear()
    client.positions.clear()
    client.tick = 0
    welcome = await client.until(Welcome)
    await client.wait_for(lambda: client.id in client.positions)
    return welcome


def zones_of(server: Running, avatar_id: int) -> list[str]:
    return [name for name, zone in server.zones.items() if avatar_id in zone.world.state]


@pytest_asyncio.fixture
async def town(serving: Serving, tmp_path: Path) -> AsyncIterator[Running]:
    async with serving(scene=None, world=write_town(tmp_path)) as server:
        yield server


async def test_a_person_walks_through_a_portal_on_the_same_connection(town: Running) -> None:
    async with joined(town.port, at=BEFORE_GATE) as ann:
        before = ann.welcome
        assert before is not None
        own = ann.entities[ann.id]
        await ann.move(EAST, 2.0)
        after = await travelled(ann)
        assert after.scene["name"] == "The hall"
        assert (after.id, after.name, after.resume) == (before.id, before.name, before.resume)
        assert (after.operator, after.resumed) == (before.operator, False)
        assert math.dist(ann.position, (4.0, 6.0)) < 0.1
        # The body goes along, and so does the place in the zone: nobody is in two of them.
        assert ann.entities[ann.id].leg_m == own.leg_m
        assert ann.entities[ann.id].stature_m == own.stature_m
        await until(lambda: zones_of(town, ann.id) == ["hall"])
        # The avatar stands, and moves by what is sent from now on.
        await ann.ticks(3)
        assert math.dist(ann.position, (4.0, 6.0)) < 0.1
        await ann.move(EAST, 2.0)
        await ann.wait_for(lambda: ann.position[0] > 6.0)
        metrics = (await get(town.private_port, "/metrics")).body.decode()
    assert 'esplanade_hops_total{result="made"} 1.0' in metrics


async def test_whoever_comes_out_of_a_portal_can_walk_in_again(town: Running) -> None:
    async with (
        joined(town.port, "Bob", at=(12.0, 12.0, 0)) as bob,
        joined(town.port, "Ann", at=BEFORE_GATE) as ann,
    ):
        await bob.wait_for(lambda: ann.id in bob.entities)
        await ann.move(EAST, 2.0)
        await travelled(ann)
        await bob.wait_for(lambda: ann.id not in bob.entities)
        await ann.move(WEST, 2.0)
        welcome = await travelled(ann)
        assert welcome.scene["name"] == "The yard"
        await bob.wait_for(lambda: ann.id in bob.positions)
        assert math.dist(bob.positions[ann.id], (14.0, 10.0)) < 0.1
        await until(lambda: zones_of(town, ann.id) == ["yard"])


async def test_a_name_is_taken_in_all_zones(town: Running) -> None:
    async with joined(town.port, "Ann", at=IN_GATE) as ann:
        await travelled(ann)
        async with joined(town.port, "Ann") as other:
            assert other.welcome is not None
            assert other.welcome.name == "Ann 2"
    await until(lambda: not any(zone.hub.people for zone in town.zones.values()))
    async with joined(town.port, "Ann") as ann:
        assert ann.welcome is not None
        assert ann.welcome.name == "Ann"


async def test_a_resume_token_takes_the_seat_where_the_person_is(town: Running) -> None:
    async with joined(town.port, at=BEFORE_GATE) as ann:
        await ann.move(EAST, 2.0)
        welcome = await travelled(ann)
        ann.connection.transport.abort()
    async with joined(town.port, resume=welcome.resume) as again:
        assert again.welcome is not None
        assert again.welcome.resumed
        assert again.welcome.scene["name"] == "The hall"
        assert again.id == welcome.id


async def test_chat_is_heard_in_the_zone_where_it_is_said(town: Running) -> None:
    async with (
        joined(town.port, "Ann", at=IN_GATE) as ann,
        joined(town.port, "Bob", at=(17.0, 9.0, 0)) as bob,
        joined(town.port, "Cid", at=(12.0, 10.0, 0)) as cid,
    ):
        await travelled(ann)
        await travelled(bob)
        await ann.wait_for(lambda: bob.id in ann.entities)
        await ann.send(ChatLine(text="in the hall"))
        heard = await bob.until(Chat)
        assert (heard.text, heard.id) == ("in the hall", ann.id)
        await cid.send(ChatLine(text="in the yard"))
        own = await cid.until(Chat)
        assert own.text == "in the yard"
        assert own.line != heard.line


async def test_what_one_has_muted_stays_muted(town: Running) -> None:
    async with (
        joined(town.port, "Ann", at=BEFORE_GATE) as ann,
        joined(town.port, "Bob", at=(15.0, 9.0, 0)) as bob,
    ):
        await ann.wait_for(lambda: bob.id in ann.entities)
        await ann.send(MutePerson(id=bob.id, muted=True))
        await ann.ticks(2)
        await ann.move(EAST, 2.0)
        await bob.move(EAST, 2.0)
        await travelled(ann)
        await travelled(bob)
        await ann.wait_for(lambda: bob.id in ann.entities)
        await bob.wait_for(lambda: ann.id in bob.entities)
        await bob.send(ChatLine(text="she does not hear this"))
        await bob.until(Chat)
        await ann.send(ChatLine(text="nor does he say more"))
        assert (await ann.until(Chat)).text == "nor does he say more"


async def test_a_mute_of_an_operator_goes_along(town: Running) -> None:
    async with joined(town.port, at=BEFORE_GATE) as ann:
        town.zone.hub.moderation.mutes.put(ann.id, 600.0)
        await ann.move(EAST, 2.0)
        await travelled(ann)
        assert town.zones["hall"].hub.moderation.muted_s(ann.id) > 590.0
        assert town.zones["yard"].hub.moderation.muted_s(ann.id) == 0.0


async def test_of_two_who_race_for_the_last_place_one_gets_it(
    serving: Serving, tmp_path: Path
) -> None:
    world = write_town(tmp_path, people=1)
    async with serving(scene=None, world=world) as server, AsyncExitStack() as stack:
        places = [(17.0, 9.0, 0), (17.0, 11.0, 0)]
        both = [
            await stack.enter_async_context(joined(server.port, f"P{k}", at=place))
            for k, place in enumerate(places)
        ]
        hall = server.zones["hall"].hub
        await until(lambda: len(hall.sessions) == 1)
        (lucky,) = (one for one in both if one.id in hall.sessions)
        (other,) = (one for one in both if one is not lucky)
        await travelled(lucky)
        notice = await other.until(Notice)
        assert notice.notice == NoticeCode.NOT_LET_IN
        assert notice.arguments["zone"] == "hall"
        assert "room for 1 people" in notice.text
        # Whoever is not let in walks on as before, and may come back when there is room.
        await other.move(WEST, 2.0)
        await other.wait_for(lambda: other.position[0] < 15.5)
        assert zones_of(server, other.id) == ["yard"]
        await lucky.connection.close()
        await until(lambda: hall.people == 0)
        await other.move(EAST, 2.0)
        welcome = await travelled(other)
        assert welcome.scene["name"] == "The hall"


async def test_a_zone_that_does_not_answer_keeps_nobody_standing(
    town: Running, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(hops, "LONGEST_S", 0.2)
    monkeypatch.setattr(town.zones["hall"].hub._seating._arrivals, "joins", list)
    async with joined(town.port, at=BEFORE_GATE) as ann:
        await ann.move(EAST, 2.0)
        notice = await ann.until(Notice)
        assert notice.notice == NoticeCode.NOT_LET_IN
        await ann.move(WEST, 2.0)
        await ann.wait_for(lambda: ann.position[0] < 15.5)
        assert town.zones["hall"].hub.people == 0


async def test_a_connection_that_is_lost_on_the_way_loses_no_avatar(
    town: Running, monkeypatch: pytest.MonkeyPatch
) -> None:
    arrivals = town.zones["hall"].hub._seating._arrivals
    with monkeypatch.context() as held:
        held.setattr(arrivals, "joins", list)
        async with joined(town.port, at=BEFORE_GATE) as ann:
            await ann.move(EAST, 2.0)
            await until(lambda: len(arrivals) == 1)
            assert ann.welcome is not None
            token = ann.welcome.resume
            ann.connection.transport.abort()
        await until(lambda: not town.zone.hub.sessions)
    # The place is kept yet, but nobody comes.
    await until(lambda: zones_of(town, ann.id) == ["yard"])
    async with joined(town.port, resume=token) as again:
        assert again.welcome is not None
        assert again.welcome.scene["name"] == "The yard"
        assert again.welcome.resumed
        # Whoever comes back to an avatar that stands in a portal goes through it.
        welcome = await travelled(again)
        assert (welcome.id, welcome.scene["name"]) == (ann.id, "The hall")
        await until(lambda: zones_of(town, ann.id) == ["hall"])


async def test_the_world_is_full_for_all_its_zones_together(
    serving: Serving, tmp_path: Path
) -> None:
    world = write_town(tmp_path)
    async with (
        serving(scene=None, world=world, max_clients=1) as server,
        joined(server.port, at=IN_GATE) as ann,
        connected(server.port) as bob,
    ):
        await travelled(ann)
        await bob.send(Hello(name="Bob", version=VERSION))
        assert await bob.refusal() == (ErrorCode.SERVER_FULL.value, CloseCode.SERVER_FULL)


async def test_a_stopping_world_says_goodbye_in_every_zone(
    serving: Serving, tmp_path: Path
) -> None:
    async with AsyncExitStack() as stack:
        async with serving(scene=None, world=write_town(tmp_path)) as server:
            ann = await stack.enter_async_context(joined(server.port, "Ann", at=IN_GATE))
            bob = await stack.enter_async_context(joined(server.port, "Bob"))
            await travelled(ann)
            reading = [asyncio.create_task(one.last_words()) for one in (ann, bob)]
        codes = [code for _, code in await asyncio.gather(*reading)]
    assert codes == [1001, 1001]

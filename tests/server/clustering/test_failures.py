"""The failure table: processes are killed and frozen, servers go away, and nobody is lost."""

import asyncio
import math
import signal
from contextlib import AsyncExitStack

import pytest
from websockets.exceptions import ConnectionClosed

from esplanade.protocol import VERSION
from esplanade.protocol.codes import CloseCode
from esplanade.protocol.messages import Bye, Chat, ChatLine, Hello, Travel
from tests.server.brokers import NatsServer
from tests.server.client import Client, connected, joined
from tests.server.clustering.clusters import Cluster
from tests.server.clustering.people import back, go_on, sees, walk
from tests.server.databases import PostgresqlServer
from tests.server.zones import BEFORE_GATE

PLACE = (6.0, 10.0, 0)
OTHER = (6.0, 12.0, 0)
LEASE_S = 3.0
SEEN_M = 0.02
RACES = 5


def people_of(client: Client) -> list[str]:
    """The names of all people whom somebody has in view."""
    return sorted(each.name for each in client.entities.values() if each.kind == "person")


async def test_a_host_that_is_killed_is_followed_by_one_that_stood_by(at_town: Cluster) -> None:
    east, west = at_town.ports
    async with joined(east, "Ann", PLACE) as ann, joined(west, "Ben", OTHER) as ben:
        await walk(ben, 1.5)
        await sees(ann, ben)
        await ann.send(ChatLine(text="hello"))
        assert (await ben.until(Chat)).text == "hello"
        await go_on(ann, ben, ticks=60)  # longer than from one checkpoint to the next
        place, tick, epoch = ben.position, ann.tick, at_town.owner("yard")[1]
        at_town.owning("yard").kill()
        await at_town.taken_over("yard", epoch)
        await asyncio.gather(ann.until_tick(tick + 40), ben.until_tick(tick + 40))
        assert math.dist(ben.position, place) <= SEEN_M
        await walk(ben, 1.0)
        await sees(ann, ben)
        await ben.send(ChatLine(text="still here"))
        assert (await ann.until(Chat)).text == "still here"
        assert people_of(ann) == people_of(ben) == ["Ann", "Ben"]


async def test_a_host_that_was_frozen_changes_nothing_when_it_wakes(at_town: Cluster) -> None:
    east, west = at_town.ports
    async with joined(east, "Ann", PLACE) as ann, joined(west, "Ben", OTHER) as ben:
        await walk(ben, 1.0)
        await sees(ann, ben)
        owner, epoch = at_town.owning("yard"), at_town.owner("yard")[1]
        owner.freeze()
        other = await at_town.taken_over("yard", epoch)
        await go_on(ann, ben)
        await walk(ben, 1.0)
        epoch, tick = at_town.owner("yard")[1], ann.tick
        owner.thaw()
        await owner.told("the zone is another host's")
        await go_on(ann, ben, ticks=40)
        await sees(ann, ben)
        assert at_town.owner("yard") == (other.name, epoch)
        assert ann.tick > tick
        assert people_of(ann) == people_of(ben) == ["Ann", "Ben"]
        assert owner.is_running  # it stands by


async def test_people_go_through_a_portal_to_a_zone_of_another_host(at_town: Cluster) -> None:
    east, west = at_town.ports
    assert at_town.owner("yard")[0] != at_town.owner("hall")[0]
    async with joined(east, "Ann", BEFORE_GATE) as ann, joined(west, "Ben", PLACE) as ben:
        await sees(ben, ann)
        assert ann.welcome is not None
        person, token = ann.id, ann.welcome.resume
        await ann.move(0.0, 1.5)
        travel = await ann.until(Travel)
        assert (travel.zone, travel.portal) == ("hall", "door")
        await ann.wait_for(lambda: ann.welcome is not None and ann.welcome.resume == token)
        await ann.wait_for(lambda: ann.id in ann.positions and ann.position[0] < 6.0)
        assert (ann.id, ann.welcome.name) == (person, "Ann")
        await ben.wait_for(lambda: person not in ben.entities)
        await walk(ann, 1.0)
        assert people_of(ann) == ["Ann"]
        async with back(west, token) as again:
            assert again.id == person
            assert again.welcome is not None
            assert again.welcome.scene["name"] == "The hall"


async def test_people_of_a_killed_gateway_come_back_at_another_one(at_town: Cluster) -> None:
    east, west = at_town.ports
    async with joined(west, "Ben", OTHER) as ben:
        async with joined(east, "Ann", PLACE) as ann:
            await walk(ann, 1.0)
            await sees(ben, ann)
            person, place = ann.id, ann.position
            assert ann.welcome is not None
            token, seen = ann.welcome.resume, ben.tick
            at_town.gateways[0].kill()
            with pytest.raises(ConnectionClosed):
                await ann.until(Chat)
        async with back(west, token) as ann:
            assert ann.welcome is not None
            assert (ann.id, ann.welcome.resumed, ann.welcome.name) == (person, True, "Ann")
            assert math.dist(ann.position, place) <= SEEN_M
            assert ann.welcome.resume != token
            await walk(ann, 1.0)
            await sees(ben, ann)
            assert people_of(ben) == ["Ann", "Ben"]
        assert ben.tick > seen


async def test_a_gateway_that_was_frozen_steers_nobody_when_it_wakes(at_town: Cluster) -> None:
    east, west = at_town.ports
    frozen = at_town.gateways[0]
    async with joined(west, "Ben", OTHER) as ben, joined(east, "Ann", PLACE) as ann:
        await walk(ann, 0.5)
        assert ann.welcome is not None
        await ann.move(0.0, 1.5)
        frozen.freeze()
        # Her avatar stands once the gateway has said nothing for a while.
        await ben.wait_for(lambda: ann.id in ben.positions)
        await ben.ticks(80)
        async with back(west, ann.welcome.resume) as again:
            place = again.position
            await ann.move(math.pi, 1.5)
            frozen.thaw()
            words, code = await ann.last_words()
            assert isinstance(words[-1], Bye)
            assert code == CloseCode.REPLACED
            await again.ticks(20)
            assert math.dist(again.position, place) <= SEEN_M
            await walk(again, 0.5)
            await sees(ben, again)
            assert people_of(ben) == ["Ann", "Ben"]


async def test_a_token_at_two_gateways_steers_at_the_later_one(at_town: Cluster) -> None:
    east, west = at_town.ports
    async with joined(east, "Ann", PLACE) as ann:
        assert ann.welcome is not None
        async with back(west, ann.welcome.resume) as later:
            words, code = await ann.last_words()
            assert isinstance(words[-1], Bye)
            assert code == CloseCode.REPLACED
            assert later.id == ann.id
            await walk(later, 1.0)


async def test_of_two_who_take_a_seat_at_once_one_steers(at_town: Cluster) -> None:
    east, west = at_town.ports
    async with AsyncExitStack() as stack:
        ann = await stack.enter_async_context(joined(east, "Ann", PLACE))
        assert ann.welcome is not None
        person, token = ann.id, ann.welcome.resume
        for _ in range(RACES):
            both = [await stack.enter_async_context(connected(port)) for port in (east, west)]
            hello = Hello(name="Ann", version=VERSION, resume=token)
            await asyncio.gather(*(each.send(hello) for each in both))
            ends = [asyncio.create_task(each.last_words()) for each in both]
            ended, _ = await asyncio.wait(ends, return_when=asyncio.FIRST_COMPLETED)
            assert [end.result()[1] for end in ended] == [CloseCode.REPLACED]
            [(winner, end)] = [
                pair for pair in zip(both, ends, strict=True) if pair[1] not in ended
            ]
            end.cancel()
            await asyncio.gather(end, return_exceptions=True)
            await winner.wait_for(lambda one=winner: one.welcome is not None and one.tick > 0)
            assert winner.welcome is not None
            assert winner.id == person
            token = winner.welcome.resume
            await walk(winner, 0.3)


async def test_a_broker_that_is_away_for_a_second_cuts_nobody_off(
    at_town: Cluster, broker: NatsServer
) -> None:
    east, west = at_town.ports
    async with joined(east, "Ann", PLACE) as ann, joined(west, "Ben", OTHER) as ben:
        await walk(ben, 0.5)
        epoch = at_town.owner("yard")[1]
        broker.kill()
        await asyncio.sleep(1.0)
        broker.start()
        await go_on(ann, ben, ticks=20)
        await walk(ben, 0.5)
        await sees(ann, ben)
        broker.signal(signal.SIGSTOP)
        await asyncio.sleep(1.0)
        broker.signal(signal.SIGCONT)
        await go_on(ann, ben, ticks=20)
        await walk(ben, 0.5)
        await sees(ann, ben)
        assert at_town.owner("yard")[1] == epoch


async def test_people_walk_on_while_the_database_is_away(
    at_town: Cluster, database: PostgresqlServer
) -> None:
    east, west = at_town.ports
    async with joined(east, "Ann", PLACE) as ann, joined(west, "Ben", OTHER) as ben:
        held = at_town.owner("yard")
        await asyncio.to_thread(database.stop)
        await walk(ben, 0.5)
        await sees(ann, ben)
        async with connected(east) as eve:
            await eve.send(Hello(name="Eve", version=VERSION))
            assert await eve.refusal() == ("busy", CloseCode.BUSY)
        await asyncio.sleep(LEASE_S + 1.0)
        await walk(ben, 0.5)
        await asyncio.to_thread(database.start)
        async with back(east, "no such token") as eve:
            await sees(ben, eve)
            await ben.send(ChatLine(text="welcome"))
            assert (await ann.until(Chat)).text == "welcome"
        await asyncio.sleep(LEASE_S)
        assert at_town.owner("yard") == held

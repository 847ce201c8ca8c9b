"""The failure table: processes are killed and frozen, servers go away, and nobody is lost."""

import asyncio
import math
import signal
from collections.abc import Iterator
from pathlib import Path

import pytest
from websockets.exceptions import ConnectionClosed

from esplanade.protocol import VERSION
from esplanade.protocol.codes import CloseCode
from esplanade.protocol.messages import Chat, ChatLine, Hello
from tests.server.brokers import NatsServer
from tests.server.client import connected, joined
from tests.server.clustering.clusters import Cluster, cluster
from tests.server.clustering.people import back, go_on, sees, walk
from tests.server.clustering.test_takeover import OTHER, PLACE, owner_and_other
from tests.server.databases import PostgresqlServer, postgresql_server

LEASE_S = 3.0


async def test_a_host_that_was_frozen_changes_nothing_when_it_wakes(at_town: Cluster) -> None:
    hosts = [at_town.host("yard", name=name) for name in ("ash", "birch")]
    east = at_town.gateway(name="east")
    owner, other = await owner_and_other(at_town, *hosts)
    async with joined(east.port, "Ann", PLACE) as ann, joined(east.port, "Ben", OTHER) as ben:
        await walk(ben, 1.0)
        await sees(ann, ben)
        owner.freeze()
        await other.told("open", zone="yard")
        await go_on(ann, ben)
        await walk(ben, 1.0)
        epoch, tick = at_town.owner("yard")[1], ann.tick
        owner.thaw()
        await owner.told("the zone is another host's")
        await go_on(ann, ben, ticks=40)
        await sees(ann, ben)
        assert at_town.owner("yard") == (other.name, epoch)
        assert ann.tick > tick
        assert sorted(e.name for e in ann.entities.values() if e.kind == "person") == ["Ann", "Ben"]
    assert owner.is_running  # it stands by again


async def test_people_of_a_killed_gateway_come_back_at_another_one(at_town: Cluster) -> None:
    hosts = [at_town.host("yard", name="ash")]
    east, west = (at_town.gateway(name=name) for name in ("east", "west"))
    await hosts[0].told("open", zone="yard")
    async with joined(west.port, "Ben", OTHER) as ben:
        async with joined(east.port, "Ann", PLACE) as ann:
            await walk(ann, 1.0)
            await sees(ben, ann)
            person, place = ann.id, ann.position
            assert ann.welcome is not None
            token, seen = ann.welcome.resume, ben.tick
            east.kill()
            with pytest.raises(ConnectionClosed):
                await ann.until(Chat)
        async with back(west.port, token) as ann:
            assert ann.welcome is not None
            assert (ann.id, ann.welcome.resumed, ann.welcome.name) == (person, True, "Ann")
            assert math.dist(ann.position, place) <= 0.02
            assert ann.welcome.resume != token
            await walk(ann, 1.0)
            await sees(ben, ann)
        await ben.wait_for(lambda: person not in ben.entities or ben.tick > seen + 60)
        assert ben.tick > seen


async def test_a_token_at_two_gateways_steers_at_the_later_one(at_town: Cluster) -> None:
    at_town.host("yard", name="ash")
    east, west = (at_town.gateway(name=name) for name in ("east", "west"))
    at_town.processes[0].wait_for("open")
    async with joined(east.port, "Ann", PLACE) as ann:
        assert ann.welcome is not None
        async with back(west.port, ann.welcome.resume) as later:
            words, code = await ann.last_words()
            assert (words[-1].code.name, code) == ("BYE", CloseCode.REPLACED)
            assert later.id == ann.id
            await walk(later, 1.0)


async def test_a_broker_that_is_away_for_a_second_cuts_nobody_off(
    at_town: Cluster, broker: NatsServer
) -> None:
    at_town.host("yard", name="ash").wait_for("open")
    east = at_town.gateway(name="east")
    async with joined(east.port, "Ann", PLACE) as ann, joined(east.port, "Ben", OTHER) as ben:
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


@pytest.fixture
def database() -> Iterator[PostgresqlServer]:
    with postgresql_server() as server:
        yield server


async def test_people_walk_on_while_the_database_is_away(
    database: PostgresqlServer, broker: NatsServer, town: Path
) -> None:
    with cluster(database.address, broker) as at_town:
        at_town.init(town)
        host, standby = (at_town.host("yard", name=name) for name in ("ash", "birch"))
        owner, _ = await owner_and_other(at_town, host, standby)
        east = at_town.gateway(name="east")
        async with joined(east.port, "Ann", PLACE) as ann, joined(east.port, "Ben", OTHER) as ben:
            held = at_town.owner("yard")
            await asyncio.to_thread(database.stop)
            await walk(ben, 0.5)
            await sees(ann, ben)
            async with connected(east.port) as eve:
                await eve.send(Hello(name="Eve", version=VERSION))
                assert await eve.refusal() == ("server_full", CloseCode.SERVER_FULL)
            await asyncio.sleep(LEASE_S + 1.0)
            await walk(ben, 0.5)
            await asyncio.to_thread(database.start)
            async with back(east.port, "no such token") as eve:
                await sees(eve, ben)
                await ben.send(ChatLine(text="welcome"))
                assert (await eve.until(Chat)).text == "welcome"
            await asyncio.sleep(LEASE_S)
            assert at_town.owner("yard") == held
            assert owner.is_running

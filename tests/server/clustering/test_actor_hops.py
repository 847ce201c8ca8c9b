"""Actors go through portals to zones of other hosts; whichever host dies, each is in one zone."""

import asyncio
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.patience import PATIENCE_S
from tests.server.brokers import NatsServer
from tests.server.clustering.clusters import Cluster, cluster
from tests.server.console.operators import Operator
from tests.server.databases import PostgresqlServer, new_database
from tests.server.zones import IN_GATE, write_town

ZONES = ("yard", "hall")
BEHAVIOUR = {"kind": "wander", "least_pause_s": 2.0, "most_pause_s": 7.0}


@pytest.fixture(scope="module")
def made(
    tmp_path_factory: pytest.TempPathFactory, database: PostgresqlServer, broker: NatsServer
) -> Iterator[Cluster]:
    """A cluster of its own, whose actors may walk from the yard to the hall."""
    town = write_town(tmp_path_factory.mktemp("town"), with_actors=True)
    with cluster(new_database(database.address), broker) as begun:
        begun.init(Path(town))
        yield begun


@pytest.fixture
def town(made: Cluster) -> Cluster:
    made.settle()
    return made


async def actors(asked: Operator, zone: str) -> dict[str, dict[str, Any]] | None:
    """The actors of a zone by their ids; None while no host answers for it."""
    status, body = await Operator(asked.port, asked.token, zone).get("/actors")
    assert status in {200, 503, 504}, body
    return {each["id"]: each for each in body["actors"]} if status == 200 else None


async def zones_of(asked: Operator, actor: str) -> list[str]:
    """The zones that have an actor, once all of them answer."""
    async with asyncio.timeout(PATIENCE_S):
        while True:
            found = {zone: await actors(asked, zone) for zone in ZONES}
            if None not in found.values():
                return [zone for zone, there in found.items() if there and actor in there]
            await asyncio.sleep(0.05)


async def until_in(asked: Operator, actor: str, zone: str) -> None:
    """Wait until an actor is in a zone, and in no other one."""
    async with asyncio.timeout(PATIENCE_S):
        while await zones_of(asked, actor) != [zone]:  # noqa: ASYNC110 - nothing tells of it
            await asyncio.sleep(0.02)


async def until_settled(town: Cluster) -> None:
    """Wait until the checkpoints of both zones know of all hops."""
    async with asyncio.timeout(PATIENCE_S):
        while await asyncio.to_thread(town.ask, on_their_way):  # noqa: ASYNC110
            await asyncio.sleep(0.1)


async def sent(asked: Operator, number: int) -> str:
    """An actor of the yard that comes to stand in the gate, and is in the hall alone; its id."""
    new = {
        "id": f"traveller-{number}",
        "name": f"Traveller {number}",
        "place": [*IN_GATE],
        "behaviour": BEHAVIOUR,
    }
    adding = {"op": "add_actors", "actors": [new]}
    yard = Operator(asked.port, asked.token, "yard")
    async with asyncio.timeout(PATIENCE_S):
        while (answer := await yard.send(adding))[0] in {503, 504}:  # noqa: ASYNC110
            await asyncio.sleep(0.1)
    assert answer[0] == 200, answer
    actor = f"main/traveller-{number}"
    await until_in(asked, actor, "hall")
    return actor


async def test_an_actor_goes_to_the_zone_of_another_host(town: Cluster) -> None:
    asked = town.operator("admin")
    actor = await sent(asked, 1)
    hall = Operator(asked.port, asked.token, "hall")
    status, found = await hall.get(f"/actors/{actor}")
    assert (status, found["name"], found["behaviour"]) == (200, "Traveller 1", BEHAVIOUR)
    await until_settled(town)
    assert await zones_of(asked, actor) == ["hall"]


@pytest.mark.parametrize("victim", ZONES)
async def test_an_actor_whose_zone_dies_behind_it_or_before_it_is_in_one_zone(
    town: Cluster, victim: str
) -> None:
    """The host dies before its checkpoint knows of the hop, or about then."""
    asked = town.operator("admin")
    actor = await sent(asked, 2 + ZONES.index(victim))
    epoch = town.owner(victim)[1]
    town.owning(victim).kill()
    await town.taken_over(victim, epoch)
    await until_in(asked, actor, "hall")
    await until_settled(town)
    assert await zones_of(asked, actor) == ["hall"]


async def test_an_actor_waits_in_the_portal_for_nobody(town: Cluster) -> None:
    """A zone without a host takes nobody in: the actor stays, and goes on."""
    asked = town.operator("admin")
    frozen = town.owning("hall")
    standing_by = town.standing_by()
    for process in (frozen, standing_by):
        process.freeze()
    new = {"id": "stays", "place": [*IN_GATE]}
    yard = Operator(asked.port, asked.token, "yard")
    assert (await yard.send({"op": "add_actors", "actors": [new]}))[0] == 200
    host = town.owning("yard")
    line = await host.told("an actor stays", actor="main/stays")
    assert line["zone"] == "hall"
    there = await actors(asked, "yard")
    assert there is not None
    assert "main/stays" in there
    town.thaw()


def on_their_way(connection: Any) -> list[Any]:
    """The actors of whom a row tells yet."""
    return list(connection.exec_driver_sql("select actor from cluster_travellers").scalars())

"""Copies of a crowded zone in a cluster: hosts that stand by open and shut them."""

import asyncio
import math
from collections.abc import Iterator
from contextlib import AsyncExitStack
from pathlib import Path

import pytest

from esplanade.protocol.messages import Travel, Welcome
from tests.patience import COMPILING_PATIENCE_S, PATIENCE_S
from tests.server.brokers import NatsServer
from tests.server.client import Client, joined
from tests.server.clustering.clusters import Cluster, Gateway, Process, cluster
from tests.server.clustering.people import go_on
from tests.server.databases import PostgresqlServer, new_database
from tests.server.zones import write_town

PEOPLE = 5
FULL_ENOUGH = 4
BEFORE_DOOR = (3.0, 6.0, 0)
HOSTS = ("ash", "birch", "cedar", "dogwood")
"""Owners of the hall, the yard and the copy, and one that stands by then."""


@pytest.fixture
def halls(
    database: PostgresqlServer, broker: NatsServer, tmp_path: Path
) -> Iterator[tuple[Cluster, list[Gateway]]]:
    """A world that people enter in the hall, of which there may be a copy; a host stands by."""
    with cluster(new_database(database.address), broker) as made:
        made.init(write_town(tmp_path, start="hall", copies=2, people=PEOPLE))
        hosts = [made.host(name=name, actors=0) for name in HOSTS]
        for host in hosts:
            host.wait_for("ready to claim", COMPILING_PATIENCE_S)
        gateways = [made.gateway(name=name) for name in ("east", "west")]
        for gateway in gateways:
            gateway.wait_for("open")
        yield made, gateways


def zone_of(client: Client) -> str:
    assert client.welcome is not None
    return str(client.welcome.scene["zone"])


async def opened(made: Cluster, zone: str) -> Process:
    """Wait until a host runs a zone."""
    async with asyncio.timeout(PATIENCE_S):
        while not made.runs(zone):  # noqa: ASYNC110 - nothing tells of it
            await asyncio.sleep(0.05)
    return made.owning(zone)


async def test_a_copy_opens_for_a_crowd_and_shuts_when_it_is_of_no_use(
    halls: tuple[Cluster, list[Gateway]],
) -> None:
    made, (east, west) = halls
    for zone in ("hall", "yard"):
        await opened(made, zone)
    assert made.owner("hall-2")[0] is None
    status = await asyncio.to_thread(made.command, "status")
    while "there is no gateway" in status.output:  # they say that they are there now and then
        await asyncio.sleep(0.2)
        status = await asyncio.to_thread(made.command, "status")
    assert (status.code, "shut" in status.output) == (0, True), status
    async with AsyncExitStack() as stack:
        first = [
            await stack.enter_async_context(joined(gateway.port, "Ann"))
            for gateway in (east, west, east, west)
        ]
        assert [zone_of(each) for each in first] == ["hall"] * FULL_ENOUGH
        copy = await opened(made, "hall-2")
        # Gateways go by the same numbers: either of them sends a newcomer to the copy.
        people = [
            await stack.enter_async_context(joined(gateway.port, "Ben")) for gateway in (west, east)
        ]
        assert [zone_of(each) for each in people] == ["hall-2", "hall-2"]
        await people[1].wait_for(lambda: people[0].id in people[1].entities)
        assert people[0].id not in first[0].entities
        friend = await stack.enter_async_context(joined(west.port, "Cleo", zone="hall"))
        assert zone_of(friend) == "hall"
        late = await stack.enter_async_context(joined(west.port, "Dan", zone="hall"))
        assert zone_of(late) == "hall-2"
        walker = await stack.enter_async_context(joined(east.port, "Walker", at=BEFORE_DOOR))
        assert zone_of(walker) == "hall-2"
        for direction, zone in ((math.pi, "yard"), (0.0, "hall-2")):
            await walker.move(direction, 2.0)
            assert (await walker.until(Travel)).zone == zone
            await walker.until(Welcome)
            await walker.ticks(5)
        # A copy that loses its host is taken over as any zone is, since people belong there.
        epoch = made.owner("hall-2")[1]
        copy.kill()
        successor = await made.taken_over("hall-2", epoch)
        await go_on(*people, late, walker)
    await successor.told("the copy is shut", zone="hall-2")
    await successor.told("given back", zone="hall-2")
    assert made.owner("hall-2")[0] is None
    assert made.owner("hall")[0] is not None

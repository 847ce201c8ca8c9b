"""Three brokers that are one: any of them may die, and nobody is cut off."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from esplanade.protocol.messages import Chat, ChatLine
from tests.patience import COMPILING_PATIENCE_S
from tests.server.brokers import NatsServer, NatsServers, nats_servers
from tests.server.client import joined
from tests.server.clustering.clusters import Cluster, Process, cluster
from tests.server.clustering.people import go_on, sees, walk
from tests.server.databases import PostgresqlServer, new_database
from tests.server.zones import until

PLACE = (6.0, 10.0, 0)
OTHER = (6.0, 12.0, 0)


@pytest.fixture
def brokers() -> Iterator[NatsServers]:
    with nats_servers(3) as running:
        yield running


@pytest.fixture
def at_three(database: PostgresqlServer, brokers: NatsServers, town: Path) -> Iterator[Cluster]:
    """A cluster at three brokers, with a host for the yard and one gateway."""
    with cluster(new_database(database.address), brokers) as made:
        made.init(town)
        host = made.host("yard", name="oak")
        made.gateway(name="east").wait_for("open")
        host.wait_for("open", COMPILING_PATIENCE_S)
        yield made


def used_by(process: Process, brokers: NatsServers) -> NatsServer:
    """The broker to which a process has come last, as its log tells."""
    came = [
        line["server"] for line in process.lines if line["event"] in {"broker there", "broker back"}
    ]
    return next(each for each in brokers.servers if each.address.endswith(came[-1]))


async def test_the_broker_in_use_is_killed_and_people_walk_on(
    at_three: Cluster, brokers: NatsServers
) -> None:
    async with joined(at_three.ports[0], "Ann", PLACE) as ann:
        epoch = at_three.owner("yard")[1]
        for process in at_three.processes:
            killed = used_by(process, brokers)
            killed.kill()
            await until(lambda one=process, old=killed: used_by(one, brokers) is not old)
            await go_on(ann, ticks=10)
            await walk(ann, 0.3)
            killed.start()
        brokers.servers[0].kill()
        late = at_three.gateway(name="west")
        await late.told("open")
        async with joined(late.port, "Ben", OTHER) as ben:
            await sees(ben, ann)
            await ben.send(ChatLine(text="hello"))
            assert (await ann.until(Chat)).text == "hello"
        assert at_three.owner("yard")[1] == epoch

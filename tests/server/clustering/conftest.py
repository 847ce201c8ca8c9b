"""A broker, a database and a cluster for each test; the database server is of the session."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.server.brokers import NatsServer, nats_server
from tests.server.clustering.clusters import Cluster, cluster
from tests.server.databases import new_database
from tests.server.zones import write_town


@pytest.fixture
def broker() -> Iterator[NatsServer]:
    with nats_server() as server:
        yield server


@pytest.fixture
def town(tmp_path: Path) -> Path:
    """The file of a world of two zones; newcomers enter the yard."""
    return write_town(tmp_path)


@pytest.fixture
def at_town(database_server: str, broker: NatsServer, town: Path) -> Iterator[Cluster]:
    """A cluster whose database has the town, and no process yet."""
    with cluster(new_database(database_server), broker) as made:
        made.init(town)
        yield made

"""One cluster for all tests here: what one takes away is there again for the next."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.server.brokers import NatsServer, nats_server
from tests.server.clustering.clusters import Cluster, cluster
from tests.server.databases import PostgresqlServer, postgresql_server
from tests.server.zones import write_town


@pytest.fixture(scope="package")
def broker() -> Iterator[NatsServer]:
    with nats_server() as server:
        yield server


@pytest.fixture(scope="package")
def database() -> Iterator[PostgresqlServer]:
    """A database server that tests may stop."""
    with postgresql_server() as server:
        yield server


@pytest.fixture(scope="package")
def town(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The file of a world of two zones; newcomers enter the yard."""
    return write_town(tmp_path_factory.mktemp("town"))


@pytest.fixture(scope="package")
def empty(database: PostgresqlServer, broker: NatsServer, town: Path) -> Iterator[Cluster]:
    """A cluster whose database has the town, and no process yet."""
    with cluster(database.address, broker) as made:
        made.init(town)
        yield made


@pytest.fixture(scope="package")
def kept(empty: Cluster) -> Cluster:
    """A cluster with an owner for each zone, one host that stands by, and two gateways."""
    empty.settle()
    return empty


@pytest.fixture
def at_town(kept: Cluster) -> Iterator[Cluster]:
    """The same, whatever the test before has done."""
    kept.settle()
    yield kept
    kept.thaw()

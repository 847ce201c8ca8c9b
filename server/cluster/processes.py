"""The processes of a cluster in the database: hosts and gateways, and which of them are to end."""

from dataclasses import dataclass
from typing import Final

from sqlalchemy import ColumnElement, Connection, delete, insert, select, update

from esplanade.server.cluster.database_time import NOW_US
from esplanade.server.store.store import ZONE
from esplanade.server.store.tables import CLUSTER_PROCESSES

HOST: Final = "host"
GATEWAY: Final = "gateway"
THERE_US: Final = 4_000_000
"""A process that has not said for so long that it is there is taken for gone."""
FORGOTTEN_US: Final = 24 * 3600 * 1_000_000
"""After so long nothing is known of it any more."""


@dataclass(frozen=True)
class ClusterProcess:
    """A host or a gateway as the database has it."""

    name: str
    kind: str
    address: str
    """The address at which people reach a gateway; empty for a host."""
    ago_us: int
    """For how long it has not said that it is there."""
    people: int
    """The people whose connections it has, or who are in its zone."""
    drained: bool

    @property
    def is_there(self) -> bool:
        return self.ago_us < THERE_US


def begin(connection: Connection, name: str, kind: str, address: str) -> None:
    """Note that a process has begun; whatever was wanted of one of that name before is void."""
    table = CLUSTER_PROCESSES.c
    connection.execute(
        delete(CLUSTER_PROCESSES).where(
            (table.name == name) | (table.seen_us < NOW_US - FORGOTTEN_US)
        )
    )
    connection.execute(
        insert(CLUSTER_PROCESSES).values(
            zone=ZONE,
            name=name,
            kind=kind,
            address=address,
            seen_us=NOW_US,
            people=0,
            drained=False,
        )
    )


def beat(connection: Connection, name: str, people: int) -> bool:
    """Note that a process is there; returns whether it is to end."""
    changed = (
        update(CLUSTER_PROCESSES)
        .where(CLUSTER_PROCESSES.c.name == name)
        .values(seen_us=NOW_US, people=people)
        .returning(CLUSTER_PROCESSES.c.drained)
    )
    return bool(connection.execute(changed).scalar())


def end(connection: Connection, name: str) -> None:
    """Note that a process has ended in order."""
    connection.execute(delete(CLUSTER_PROCESSES).where(CLUSTER_PROCESSES.c.name == name))


def drain(connection: Connection, name: str) -> bool:
    """Let a process end in order; returns False if there is none of that name."""
    changed = update(CLUSTER_PROCESSES).where(CLUSTER_PROCESSES.c.name == name)
    return connection.execute(changed.values(drained=True)).rowcount > 0


def processes(connection: Connection) -> list[ClusterProcess]:
    """All processes, by kind and name."""
    table = CLUSTER_PROCESSES.c
    ago_us: ColumnElement[int] = NOW_US - table.seen_us
    chosen = select(
        table.name, table.kind, table.address, ago_us, table.people, table.drained
    ).order_by(table.kind, table.name)
    return [ClusterProcess(*row) for row in connection.execute(chosen)]

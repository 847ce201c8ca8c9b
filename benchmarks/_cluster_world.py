"""A cluster of real processes for benchmarks, whose people have seats before they come in."""

import json
import tempfile
import urllib.request
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from benchmarks._live_servers import Usage, field_of
from chaos.server import Samples, samples
from sqlalchemy import Connection, text
from tests.patience import COMPILING_PATIENCE_S
from tests.ports import free_ports
from tests.server.brokers import NatsServer, nats_server
from tests.server.clustering.clusters import Cluster, Gateway, Process, cluster
from tests.server.databases import postgresql_server

from esplanade.server.cluster.person_record import PersonRecord, encode_record
from esplanade.server.cluster.seats import take

SIDE_M: Final = 100.0
AWAY_S: Final = 3600.0
"""Nobody's seat is given up in a run."""
SHEPHERD: Final = "shepherd"
"""The gateway of those who walk and do not look."""


@dataclass(frozen=True)
class Seat:
    """The seat of somebody who has not come in yet."""

    zone: str
    person: int
    name: str
    token: str


@dataclass(frozen=True)
class Reading:
    """A running cluster at one moment: what its processes have taken so far."""

    hosts: list[Usage]
    gateways: list[Usage]
    broker: Usage
    told: Samples
    """Sums over all processes of metrics, by their names without labels."""
    traffic: dict[str, int]
    """`in_msgs`, `out_msgs`, `in_bytes` and `out_bytes` of the broker."""
    commits: int
    """Transactions of the database."""


@dataclass
class World:
    """A cluster with an owner for each zone."""

    cluster: Cluster
    broker: NatsServer
    zones: list[str]
    monitor: int
    """The port at which the broker tells of itself."""

    @property
    def hosts(self) -> list[Process]:
        """The hosts that run."""
        return [each for each in self.cluster.processes if each.is_host and each.is_running]

    @property
    def gateways(self) -> list[Gateway]:
        """The gateways that run."""
        return self.cluster.gateways

    def begin_gateways(self, number: int, people: int) -> None:
        """Begin so many gateways, each for so many people."""
        words = ("--max-clients", str(people), "--operator-key", "")
        begun = [self.cluster.gateway(*words, name=f"gateway-{k + 1}") for k in range(number)]
        for gateway in begun:
            gateway.wait_for("open")

    def begin_hosts(self, number: int, people: int) -> None:
        """Begin so many hosts, each for so many people, and wait until they may claim a zone."""
        words = ("--max-clients", str(people))
        begun = [self.cluster.host(*words, name=f"host-{k + 1}", actors=0) for k in range(number)]
        for host in begun:
            host.wait_for("ready to claim", COMPILING_PATIENCE_S)

    def begin_standby(self, number: int, people: int) -> None:
        """Begin a host for so many people, and wait until it may claim a zone."""
        words = ("--max-clients", str(people))
        host = self.cluster.host(*words, name=f"standby-{number}", actors=0)
        host.wait_for("ready to claim", COMPILING_PATIENCE_S)

    def owning(self, zone: str) -> Process:
        """The host that owns a zone."""
        return self.cluster.owning(zone)

    def read(self) -> Reading:
        """Read what the processes have taken so far."""
        told: Samples = {}
        for process in (*self.hosts, *self.gateways):
            page = _fetched(f"http://127.0.0.1:{process.health_port}/metrics").decode()
            for key, value in samples(page).items():
                name = key.partition("{")[0]
                told[name] = told.get(name, 0.0) + value
        traffic = json.loads(_fetched(f"http://127.0.0.1:{self.monitor}/varz"))
        commits = text("select xact_commit from pg_stat_database where datname = 'postgres'")
        return Reading(
            hosts=[Usage.of(each.pid) for each in self.hosts],
            gateways=[Usage.of(each.pid) for each in self.gateways],
            broker=Usage.of(self.broker.pid),
            told=told,
            traffic={
                name: traffic[name] for name in ("in_msgs", "out_msgs", "in_bytes", "out_bytes")
            },
            commits=self.cluster.ask(lambda to: int(to.execute(commits).scalar_one())),
        )


@contextmanager
def world(zones: int) -> Iterator[World]:
    """A cluster of so many zones, each of which is an open field, and no process yet."""
    (monitor,) = free_ports(1)
    with ExitStack() as stack:
        folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
        names = [f"field-{k + 1}" for k in range(zones)]
        (folder / "field.json").write_text(field_of(SIDE_M).model_dump_json())
        of_zones = [{"name": name, "scene": "field.json"} for name in names]
        (folder / "world.json").write_text(
            json.dumps({"name": "Fields", "start": names[0], "zones": of_zones})
        )
        broker = stack.enter_context(nats_server("-m", str(monitor)))
        database = stack.enter_context(postgresql_server())
        made = stack.enter_context(cluster(database.address, broker, resume_s=AWAY_S))
        made.init(folder / "world.json")
        yield World(made, broker, names, monitor)


def make_seats(cluster: Cluster, zone: str, number: int) -> list[Seat]:
    """Make seats for so many people in a zone, whom the shepherd has at first."""

    def make(connection: Connection) -> list[Seat]:
        made = []
        for k in range(number):
            name = f"{zone} {k + 1}"
            seat, token = take(
                connection, zone, name, SHEPHERD, encode_record(PersonRecord()), name
            )
            made.append(Seat(zone, seat.person, name, token))
        return made

    found: list[Seat] = cluster.ask(make)
    return found


def taken(before: Reading, after: Reading) -> tuple[list[float], list[float], float]:
    """Seconds of processor that each host, each gateway and the broker has taken in between."""
    hosts, gateways = (
        [late.processor_s - early.processor_s for early, late in zip(one, other, strict=True)]
        for one, other in ((before.hosts, after.hosts), (before.gateways, after.gateways))
    )
    return hosts, gateways, after.broker.processor_s - before.broker.processor_s


def grown(before: Reading, after: Reading, name: str) -> float:
    """By how much a metric of all processes together has grown in between."""
    return after.told.get(name, 0.0) - before.told.get(name, 0.0)


def ticked(before: Reading, after: Reading) -> float:
    """The ticks of all hosts together in between: on a busy machine fewer than 20 a second."""
    return grown(before, after, "esplanade_ticks_total")


def _fetched(url: str) -> bytes:
    with urllib.request.urlopen(url, timeout=60.0) as answer:  # noqa: S310 - of this machine
        found: Any = answer.read()
    return bytes(found)

"""A cluster of real processes for tests: a broker, a database, hosts and gateways of their own."""

import asyncio
import io
import itertools
import json
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any, Final, NamedTuple, TypeVar

from sqlalchemy import Connection, create_engine, text

from esplanade.cli import main
from esplanade.server.store.location import Location
from tests.patience import COMPILING_PATIENCE_S, PATIENCE_S
from tests.server.brokers import Brokers
from tests.server.client import PLACING_KEY
from tests.server.console.operators import Operator

ZONES: Final = ("yard", "hall")
HOSTS: Final = 3
"""An owner for each zone, and one that stands by."""
GATEWAYS: Final = 2

RESUME_S: Final = 120.0
"""For so long the avatars of people wait whose connection was lost: a slow machine begins other
processes meanwhile."""


class Said(NamedTuple):
    """The exit code of a command, and what it has printed."""

    code: int
    output: str
    errors: str


def said(words: Sequence[str]) -> Said:
    """Run a command of `esplanade` in this process."""
    output, errors = io.StringIO(), io.StringIO()
    with redirect_stdout(output), redirect_stderr(errors):
        try:
            code = main(words)
        except SystemExit as end:
            code = int(end.code or 0)
    return Said(code, output.getvalue(), errors.getvalue())


class Process:
    """A host or a gateway, and the lines of its log."""

    is_host = True

    def __init__(self, name: str, words: list[str], environment: dict[str, str]) -> None:
        self.name = name
        self._process = subprocess.Popen(
            [sys.executable, "-m", "esplanade", *words, "--name", name],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            env=environment,
        )
        self._lines: list[dict[str, Any]] = []
        self._changed = threading.Condition()
        self._reading = threading.Thread(target=self._read, daemon=True)
        self._reading.start()
        self.is_frozen = False

    @property
    def lines(self) -> list[dict[str, Any]]:
        """The lines of its log so far; a line that is no JSON is one of the event `told`."""
        with self._changed:
            return list(self._lines)

    @property
    def health_port(self) -> int:
        """The port at which it says how it is."""
        url: str = self.wait_for("health")["url"]
        return int(url.rsplit(":", 1)[1])

    @property
    def pid(self) -> int:
        return self._process.pid

    @property
    def is_running(self) -> bool:
        return self._process.poll() is None

    def wait_for(
        self, event: str, patience_s: float = PATIENCE_S, **facts: object
    ) -> dict[str, Any]:
        """Wait for a line of the log."""

        def found() -> dict[str, Any] | None:
            for line in self._lines:
                if line["event"] == event and facts.items() <= line.items():
                    return line
            return None

        end = time.monotonic() + patience_s
        with self._changed:
            while (line := found()) is None:
                assert self._reading.is_alive(), self._lines
                assert time.monotonic() < end, (event, self._lines)
                self._changed.wait(0.5)
            return line

    async def told(self, event: str, **facts: object) -> dict[str, Any]:
        """The same while clients go on."""
        return await asyncio.to_thread(self.wait_for, event, PATIENCE_S, **facts)

    def kill(self) -> None:
        """End it at once, if it runs yet, and read its log to the end."""
        self._process.kill()
        self._process.wait()
        self._reading.join()

    def freeze(self) -> None:
        self._process.send_signal(signal.SIGSTOP)
        self.is_frozen = True

    def thaw(self) -> None:
        self._process.send_signal(signal.SIGCONT)
        self.is_frozen = False

    def stop(self) -> int:
        """Tell it to end, and wait for that; its exit code."""
        self._process.send_signal(signal.SIGTERM)
        return self._process.wait(PATIENCE_S)

    def interrupt(self) -> int:
        """Press Ctrl-C, and wait for the end; its exit code."""
        self._process.send_signal(signal.SIGINT)
        return self._process.wait(PATIENCE_S)

    def end(self) -> int:
        """Wait until it ends by itself; its exit code."""
        return self._process.wait(PATIENCE_S)

    def _read(self) -> None:
        assert self._process.stderr is not None
        with self._process.stderr as log:
            for raw in log:
                try:
                    line = json.loads(raw)
                except ValueError:
                    line = {"event": "told", "text": raw.decode().rstrip()}
                with self._changed:
                    self._lines.append(line)
                    self._changed.notify_all()


class Gateway(Process):
    """A gateway, and the port at which people reach it."""

    is_host = False

    @property
    def is_open(self) -> bool:
        """Whether people reach it."""
        return any(line["event"] == "open" for line in self.lines)

    @property
    def port(self) -> int:
        url: str = self.wait_for("open")["url"]
        return int(url.rsplit(":", 1)[1].strip("/"))

    @property
    def private_port(self) -> int:
        """The port for operators."""
        url: str = self.wait_for("open")["private"]
        return int(url.rsplit(":", 1)[1])


Kind = TypeVar("Kind", bound=Process)


class Cluster:
    """Processes that share a database and a broker; all of them end with the test."""

    def __init__(self, database: str, broker: Brokers, resume_s: float) -> None:
        self.database = database
        self.broker = broker
        self.processes: list[Process] = []
        self.login: dict[str, dict[str, str]] = {}
        """More variables of hosts, by `zone`, and of gateways, by `gateway`."""
        self._numbers = itertools.count(1)
        self._waiting = ("--resume-seconds", f"{resume_s:g}")

    @property
    def environment(self) -> dict[str, str]:
        """The environment that says where database and broker are."""
        return {
            **os.environ,
            "ESPLANADE_STORE": self.database,
            "ESPLANADE_NATS": self.broker.address,
            "ESPLANADE_LOG_FORMAT": "json",
            "ESPLANADE_OPERATOR_KEY": PLACING_KEY,
        }

    def command(self, *words: str) -> "Said":
        """Run `esplanade cluster` in this process."""
        return said(["cluster", *words, "--store", self.database])

    def init(self, world: Path) -> None:
        """Put a world into the database."""
        done = self.command("init", str(world))
        assert done.code == 0, done.errors

    def host(self, *words: str, name: str, actors: int = 1, **environment: str) -> Process:
        """Begin a host, with further variables of its environment."""
        ours = {**self.environment, **self.login.get("zone", {}), **environment}
        return self._begun(
            Process(name, ["zone", *words, "--actors", str(actors), *self._waiting], ours)
        )

    def gateway(self, *words: str, name: str) -> Gateway:
        """Begin a gateway at a free port."""
        places = ("--host", "127.0.0.1", "--port", "0")
        return self._begun(
            Gateway(
                name,
                ["gateway", *places, *words, *self._waiting],
                {**self.environment, **self.login.get("gateway", {})},
            )
        )

    def operator(self, role: str, gateway: "Gateway | None" = None, zone: str = "") -> Operator:
        """A new operator of a role who asks by a token, at a gateway."""
        name = f"{role}-{next(self._numbers)}"
        words = ["op", "user", "add", name, "--role", role, "--token", "--store", self.database]
        with ThreadPoolExecutor(1) as thread:  # it has an event loop of its own
            done = thread.submit(said, words).result()
        assert done.code == 0, done.errors
        at = gateway or self.gateways[0]
        return Operator(at.private_port, done.output.strip(), zone)

    def ask(self, query: Callable[[Connection], Any]) -> Any:
        """Ask the database."""
        engine = create_engine(Location.of(None, self.database).url)
        try:
            with engine.begin() as connection:
                return query(connection)
        finally:
            engine.dispose()

    # --- who is there -------------------------------------------------------------------------

    def settle(self) -> None:
        """Have what is missing, and wait until nobody is there."""
        self.refill()
        end = time.monotonic() + PATIENCE_S
        while self.seats:
            assert time.monotonic() < end, f"people are left: {self.seats}"
            time.sleep(0.05)

    def refill(self) -> None:
        """Begin what is missing, and wait until every zone has an owner and a host stands by."""
        hosts = [each for each in self.processes if each.is_host and each.is_running]
        more = range(HOSTS - len(hosts))
        hosts += [self.host(name=f"host-{next(self._numbers)}") for _ in more]
        gateways = [each for each in self.processes if not each.is_host and each.is_running]
        more = range(GATEWAYS - len(gateways))
        gateways += [self.gateway(name=f"gateway-{next(self._numbers)}") for _ in more]
        for host in hosts:
            host.wait_for("ready to claim", COMPILING_PATIENCE_S)
        for gateway in gateways:
            gateway.wait_for("open")
        end = time.monotonic() + PATIENCE_S
        while not all(self.runs(zone) for zone in ZONES):
            assert time.monotonic() < end, "a zone has no owner"
            time.sleep(0.05)

    @property
    def seats(self) -> list[str]:
        """The names of all who have a seat."""
        return sorted(
            self.ask(lambda to: to.execute(text("select name from cluster_seats")).scalars().all())
        )

    def owner(self, zone: str) -> tuple[str | None, int]:
        """The host that the database names for a zone, and the epoch."""
        statement = text("select host, epoch from ownerships where zone = :zone")
        row = self.ask(lambda to: to.execute(statement, {"zone": zone}).one())
        return row.host, row.epoch

    def owning(self, zone: str) -> Process:
        """The host that owns a zone."""
        name = self.owner(zone)[0]
        return next(each for each in self.processes if each.name == name and each.is_running)

    def standing_by(self) -> Process:
        """A host that owns nothing."""
        owners = {self.owner(zone)[0] for zone in ZONES}
        return next(
            each
            for each in self.processes
            if each.is_host and each.is_running and each.name not in owners
        )

    @property
    def ports(self) -> list[int]:
        """The ports of the gateways that are open."""
        return [each.port for each in self.gateways if each.is_open]

    @property
    def gateways(self) -> list["Gateway"]:
        """The gateways that run."""
        return [each for each in self.processes if isinstance(each, Gateway) and each.is_running]

    async def taken_over(self, zone: str, epoch: int) -> Process:
        """Wait until a zone has another owner than that of an epoch, which runs it."""
        async with asyncio.timeout(PATIENCE_S):
            while self.owner(zone)[1] <= epoch or not self.runs(zone):  # noqa: ASYNC110
                await asyncio.sleep(0.05)
        return self.owning(zone)

    def runs(self, zone: str) -> bool:
        """Whether a host has a zone, and has begun to run it."""
        host, epoch = self.owner(zone)
        return any(
            line["event"] == "open" and line.get("epoch") == epoch
            for each in self.processes
            if each.name == host and each.is_running
            for line in each.lines
        )

    def _begun(self, process: Kind) -> Kind:
        self.processes.append(process)
        return process

    def thaw(self) -> None:
        """Let everything that stands still go on."""
        for process in self.processes:
            if process.is_frozen:
                process.thaw()

    def end(self) -> None:
        self.thaw()
        for process in self.processes:
            process.kill()


@contextmanager
def cluster(database: str, broker: Brokers, resume_s: float = RESUME_S) -> Iterator[Cluster]:
    """A cluster of processes that end with it; avatars of lost people wait for so long."""
    made = Cluster(database, broker, resume_s)
    try:
        yield made
    finally:
        made.end()

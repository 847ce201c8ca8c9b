"""A real NATS server for tests, on a free port of this machine."""

import os
import shutil
import signal
import socket
import subprocess
import time
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Final

import pytest

from tests.patience import PATIENCE_S
from tests.ports import free_ports

REQUIRE_VARIABLE: Final = "ESPLANADE_REQUIRE_NATS"
"""With 1, a test that finds no NATS server fails instead of skipping."""


class NatsServer:
    """A broker that a test kills, freezes and starts again at the same address."""

    def __init__(
        self,
        program: str,
        port: int | None = None,
        words: Sequence[str] = (),
        environment: Mapping[str, str] | None = None,
    ) -> None:
        """`words` are more of its options, `environment` more of its variables."""
        self._program = program
        self._words = words
        self._environment = {**os.environ, **(environment or {})}
        self._process: subprocess.Popen[bytes] | None = None
        (self._port,) = free_ports(1) if port is None else (port,)

    @property
    def address(self) -> str:
        return f"nats://127.0.0.1:{self._port}"

    @property
    def pid(self) -> int:
        """The number of its process, which runs."""
        assert self._process is not None
        return self._process.pid

    def start(self) -> None:
        """Begin, unless it runs, and wait until it listens."""
        if self._process is not None:
            return
        words = [self._program, *self._words, "-a", "127.0.0.1", "-p", str(self._port)]
        self._process = subprocess.Popen(
            words,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env=self._environment,
        )
        end = time.monotonic() + PATIENCE_S
        while time.monotonic() < end:
            assert self._process.poll() is None, "the NATS server ended at once"
            with socket.socket() as probe:
                if probe.connect_ex(("127.0.0.1", self._port)) == 0:
                    return
            time.sleep(0.02)
        raise AssertionError("the NATS server does not listen")

    def kill(self) -> None:
        if self._process is not None:
            self.signal(signal.SIGCONT)
            self._process.kill()
            self._process.wait()
            self._process = None

    def freeze(self) -> None:
        """Let it stand still."""
        self.signal(signal.SIGSTOP)

    def thaw(self) -> None:
        """Let it go on."""
        self.signal(signal.SIGCONT)

    def signal(self, number: signal.Signals) -> None:
        if self._process is not None and self._process.poll() is None:
            self._process.send_signal(number)


class NatsServers:
    """Brokers that are one: each passes on to the others what it is told."""

    def __init__(self, program: str, number: int) -> None:
        ports = free_ports(2 * number)
        routes = [f"nats://127.0.0.1:{port}" for port in ports[number:]]
        joined = ("--cluster_name", "esplanade", "--routes", ",".join(routes))
        self.servers = [
            NatsServer(program, port, ("--cluster", route, *joined))
            for port, route in zip(ports, routes, strict=False)
        ]

    @property
    def address(self) -> str:
        """The addresses of all, as `--nats` takes them."""
        return ",".join(each.address for each in self.servers)

    def start(self) -> None:
        """Begin those that do not run, and wait until all of them listen."""
        for each in self.servers:
            each.start()

    def kill(self) -> None:
        for each in self.servers:
            each.kill()

    def freeze(self) -> None:
        """Let all of them stand still."""
        for each in self.servers:
            each.freeze()

    def thaw(self) -> None:
        """Let all of them go on."""
        for each in self.servers:
            each.thaw()


Brokers = NatsServer | NatsServers


@contextmanager
def nats_server(*words: str, environment: Mapping[str, str] | None = None) -> Iterator[NatsServer]:
    """Run a broker of its own, with more options and variables."""
    server = NatsServer(_program(), None, words, environment)
    server.start()
    try:
        yield server
    finally:
        server.kill()


@contextmanager
def nats_servers(number: int) -> Iterator[NatsServers]:
    """Run so many brokers of its own that are one."""
    made = NatsServers(_program(), number)
    try:
        made.start()
        yield made
    finally:
        made.kill()


def _program() -> str:
    """The program of the system."""
    program = shutil.which("nats-server") or shutil.which("nats-server", path="/usr/sbin")
    if program is not None:
        return program
    why = "nats-server is not installed here: apt-get install nats-server"
    if os.environ.get(REQUIRE_VARIABLE) == "1":
        pytest.fail(f"{REQUIRE_VARIABLE}=1, but {why}")
    pytest.skip(why)

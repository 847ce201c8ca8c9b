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
        self, program: str, words: Sequence[str] = (), environment: Mapping[str, str] | None = None
    ) -> None:
        """`words` are more of its options, `environment` more of its variables."""
        self._program = program
        self._words = words
        self._environment = {**os.environ, **(environment or {})}
        self._process: subprocess.Popen[bytes] | None = None
        (self._port,) = free_ports(1)

    @property
    def address(self) -> str:
        return f"nats://127.0.0.1:{self._port}"

    def start(self) -> None:
        """Begin, and wait until somebody listens."""
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


@contextmanager
def nats_server(*words: str, environment: Mapping[str, str] | None = None) -> Iterator[NatsServer]:
    """Run a broker of its own, with more options and variables."""
    program = shutil.which("nats-server") or shutil.which("nats-server", path="/usr/sbin")
    if program is None:
        why = "nats-server is not installed here: apt-get install nats-server"
        if os.environ.get(REQUIRE_VARIABLE) == "1":
            pytest.fail(f"{REQUIRE_VARIABLE}=1, but {why}")
        pytest.skip(why)
    server = NatsServer(program, words, environment)
    server.start()
    try:
        yield server
    finally:
        server.kill()

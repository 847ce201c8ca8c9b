"""Canary and attackers as processes that end: by themselves, or by force of the harness."""

import multiprocessing
import os
import signal
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from typing import Final

from chaos import canary
from chaos.attack import Attacker, Outcome, Target
from chaos.canary import Sighting

READY_S: Final = 120.0
"""A process that has not begun by then has failed: a busy machine takes a few seconds."""

ENDS_S: Final = 5.0
"""An attacker has this long to end after its time."""

NICENESS: Final = 10
"""Attackers take what processor time is left: real ones sit at another machine."""

_SPAWNING: Final = multiprocessing.get_context("spawn")


class ProcessError(Exception):
    """A process of the harness itself has failed."""


class CanaryProcess:
    """The canary, seen from the harness."""

    def __init__(self, pipe: Connection) -> None:
        self._pipe = pipe

    def begin(self) -> None:
        """Begin a measurement."""
        self._pipe.send("begin")

    def tell(self) -> Sighting:
        """Return the canary's service since `begin`."""
        self._pipe.send("tell")
        sighting = _received(self._pipe, "the canary")
        if not isinstance(sighting, Sighting):
            raise ProcessError(f"the canary answered {sighting!r}")
        return sighting


@contextmanager
def canary_process(port: int, seed: int) -> Iterator[CanaryProcess]:
    """A canary that is in the world.

    Raises
    ------
    ProcessError
        It was not let in.
    """
    here, there = _SPAWNING.Pipe()
    process = _SPAWNING.Process(target=canary.run, args=(port, seed, there), daemon=True)
    process.start()
    there.close()
    try:
        _received(here, "the canary")
        yield CanaryProcess(here)
        here.send("end")
        process.join(ENDS_S)
    finally:
        if process.is_alive():
            process.kill()
        process.join()


class AttackerProcess:
    """An attacker, seen from the harness."""

    def __init__(self, process: BaseProcess, pipe: Connection) -> None:
        self._process = process
        self._pipe = pipe

    def wait_until_it_begins(self) -> None:
        _received(self._pipe, "the attacker")

    def outcome(self) -> Outcome | None:
        """Wait for the attacker's end; None if it had to be killed or failed."""
        with suppress(EOFError):
            if self._pipe.poll(ENDS_S):
                outcome = self._pipe.recv()
                if isinstance(outcome, Outcome):
                    return outcome
        return None


@contextmanager
def attacker_process(name: str, target: Target) -> Iterator[AttackerProcess]:
    """An attacker with all its children, which are all gone at the end."""
    here, there = _SPAWNING.Pipe()
    process = _SPAWNING.Process(target=_attack, args=(name, target, there))
    process.start()
    there.close()
    try:
        yield AttackerProcess(process, here)
    finally:
        _end(process)


def _end(process: BaseProcess) -> None:
    """End the attacker and the children that it left in its own group."""
    process.join(0.5)
    pid = process.pid
    # The group exists only once the attacker has made it: it is never that of the harness.
    with suppress(ProcessLookupError, PermissionError):
        if pid is not None and pid != os.getpgrp():
            os.killpg(pid, signal.SIGKILL)
    if process.is_alive():
        process.kill()
    process.join()


def _attack(name: str, target: Target, parent: Connection) -> None:
    from chaos.attacks.catalogue import ATTACKS  # noqa: PLC0415  # the catalogue needs no harness

    os.setsid()
    os.nice(NICENESS)
    raise_file_limit()
    attacker = Attacker(target, lambda: parent.send("begins"))
    ATTACKS[name].run(attacker)
    parent.send(Outcome(dict(attacker.counts), attacker.faults))


def raise_file_limit() -> None:
    """Allow as many open files as the system lets a process have."""
    import resource  # noqa: PLC0415  # there is none on Windows

    _, most = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))


def _received(pipe: Connection, of_whom: str) -> object:
    deadline = time.monotonic() + READY_S
    try:
        if pipe.poll(deadline - time.monotonic()):
            return pipe.recv()
    except EOFError:
        raise ProcessError(f"{of_whom} has failed") from None
    raise ProcessError(f"{of_whom} has not answered for {READY_S:g} s")

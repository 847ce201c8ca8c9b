"""Runs of a stretch on several processes; the results do not depend on their number."""

import multiprocessing
import signal
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from esplanade.server import logs
from esplanade.server.offline.settings import OfflineSettings
from esplanade.server.replay.replayed_zone import ReplayedZone
from esplanade.server.whatif.runs import Plan, Run, run, zone_of
from esplanade.server.whatif.stretch import Stretch


class _StoppedError(RuntimeError):
    """Ctrl-C came to the parent."""


@dataclass
class _Mine:
    """The zone and stretch that a process keeps from run to run."""

    stretch: Stretch
    stopping: Any
    replayed: ReplayedZone | None = None


_mine: list[_Mine] = []


def run_all(
    stretch: Stretch, plans: Sequence[Plan], processes: int, report: Callable[[], None]
) -> list[Run]:
    """All runs, in the order of their plans; `report` is called as each one ends.

    After an interrupt each process ends with the tick that it is in.

    Raises
    ------
    WhatIfError
        A change cannot be made.
    """
    spawn = multiprocessing.get_context("spawn")
    stopping = spawn.Event()
    found: dict[int, Run] = {}
    count = min(processes, len(plans))
    with ProcessPoolExecutor(count, spawn, _begin, (stretch, stopping)) as pool:
        try:
            with _interrupts_kept():
                waiting = {pool.submit(_run, plan): k for k, plan in enumerate(plans)}
            for future in as_completed(waiting):
                found[waiting[future]] = future.result()
                report()
        except BaseException:
            stopping.set()
            pool.shutdown(cancel_futures=True)
            raise
    return [found[k] for k in range(len(plans))]


@contextmanager
def _interrupts_kept() -> Iterator[None]:
    """Ctrl-C comes to the parent when this is over, and never to processes that begin in here."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _begin(stretch: Stretch, stopping: Any) -> None:
    """Begin a process."""
    _mine.append(_Mine(stretch, stopping))


def _run(plan: Plan) -> Run:
    (mine,) = _mine
    with logs.written(OfflineSettings(log_level="warning")):
        if mine.replayed is None:
            mine.replayed = ReplayedZone(mine.stretch.head)
        with zone_of(plan, mine.stretch, mine.replayed) as replayed:
            return run(replayed, mine.stretch, plan, lambda _: _go_on(mine.stopping))


def _go_on(stopping: Any) -> None:
    if stopping.is_set():
        raise _StoppedError

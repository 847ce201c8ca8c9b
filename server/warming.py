"""The first start on a machine: kernels are compiled in two processes, and it is told how far."""

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Final

import structlog
from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn

from esplanade.planning.compiled import beside, cache
from esplanade.planning.compiled.notice import heard

AHEAD: Final = "esplanade.planning.agents.ahead"
"""What the second process compiles: about half of all, and nothing that the first half needs."""
FUNCTIONS: Final = 430
"""About how many functions are compiled on the way to a world; only the bar goes by it."""
SERVED: Final = "served"
TOLD_EVERY_S: Final = 10.0

log = structlog.get_logger(__name__)


@contextmanager
def kernels_compiled() -> Iterator[Callable[[], None]]:
    """Within this a world is built and warmed up; yields what waits for the second process.

    Where an earlier start has left all kernels in the cache it does nothing.
    """
    if beside.is_complete(SERVED):
        yield lambda: None
        return
    with (
        _shown() as one_more,
        heard(one_more),
        beside.compiled_beside(AHEAD, one_more) as wait_for_it,
    ):
        yield wait_for_it
    beside.complete(SERVED)


@contextmanager
def _shown() -> Iterator[Callable[[], None]]:
    """Shows how far it is: as a bar on a terminal, else in lines of log."""
    log.info("compiling, once on this machine; it takes a minute or two", kept_in=cache.folder())
    console = Console(stderr=True)
    if console.is_terminal:
        columns = TextColumn("compiling"), BarColumn(), TaskProgressColumn(), TimeElapsedColumn()
        with Progress(*columns, console=console, transient=True) as progress:
            task = progress.add_task("compiling", total=FUNCTIONS)
            yield lambda: progress.advance(task)
        return
    yield _Lines().one_more


class _Lines:
    """A line of log now and then; what calls it may be two threads."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._count = 0
        self._told_s = time.monotonic()

    def one_more(self) -> None:
        """One more function is compiled."""
        with self._lock:
            self._count += 1
            if time.monotonic() - self._told_s >= TOLD_EVERY_S:
                self._told_s = time.monotonic()
                percent = min(99, 100 * self._count // FUNCTIONS)
                log.info("compiling", percent=percent)

"""The first start on a machine: kernels are compiled in two processes, and how far is told."""

import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Final

import structlog

from esplanade.commandline.progress import progress
from esplanade.planning.compiled import beside, cache
from esplanade.planning.compiled.notice import heard
from esplanade.server.patience import told_of

AHEAD: Final = "esplanade.planning.agents.ahead"
"""The second process compiles this: about half of all, and nothing that the first half needs."""
FUNCTIONS: Final = 600
"""The approximate number of functions that a world needs compiled; only the display uses it."""
SERVED: Final = "served"
TOLD_EVERY_S: Final = 10.0

log = structlog.get_logger(__name__)


@contextmanager
def kernels_compiled(meanwhile: Callable[[], None]) -> Iterator[Callable[[], None]]:
    """Yield while a world is built and warmed up; the value waits for the second process.

    Before it waits, it calls `meanwhile`, which compiles more of what this process needs. Where an
    earlier start has left all kernels in the cache, it does nothing.
    """
    if beside.is_complete(SERVED):
        with told_of("building the world"):
            yield lambda: None
        return
    with (
        _shown() as one_more,
        heard(one_more),
        beside.compiled_beside(AHEAD, one_more) as wait_for_it,
    ):

        def wait() -> None:
            meanwhile()
            wait_for_it()

        yield wait
    beside.complete(SERVED)


@contextmanager
def _shown() -> Iterator[Callable[[], None]]:
    """Shows how far it is: by a bar on a terminal, else in lines of log."""
    log.info(
        "compiling, once on this machine; it takes about a minute", kept_in=str(cache.folder())
    )
    bar = progress(share=True)
    if not bar.console.is_terminal:
        yield _Lines().one_more
        return
    with bar:
        bar.console.show_cursor(True)  # Ctrl-C ends the process at once, without tidying up
        task = bar.add_task("compiling", total=FUNCTIONS)
        yield lambda: bar.advance(task)


class _Lines:
    """A line of log now and then; two threads call it."""

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
                log.info("compiling", percent=min(99, 100 * self._count // FUNCTIONS))

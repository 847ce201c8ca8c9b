"""Tells those who have kernels compiled that it goes on, and how far it is."""

import logging
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from numba.core import event

from esplanade.planning.compiled import cache

log = logging.getLogger(__name__)

Listener = Callable[[], None]


class _Compiling(event.Listener):
    """Hears of every function that is compiled, be it called from Python or from another one."""

    def __init__(self) -> None:
        self.listeners: list[Listener] = []
        self._told = False

    def on_start(self, event: Any) -> None:  # noqa: ARG002
        """Tell in one line of log, unless somebody listens who shows it otherwise."""
        if not self.listeners and not self._told:
            self._told = True
            log.warning(
                "compiling kernels, which may take about a minute; %s",
                f"they are kept in {cache.folder()}" if cache.folder() else "they cannot be kept",
            )

    def on_end(self, event: Any) -> None:  # noqa: ARG002
        """Tell that one more is done."""
        for listener in self.listeners:
            listener()


_COMPILING = _Compiling()


def begin() -> None:
    """Hear of every function that is compiled from now on."""
    event.register("numba:compile", _COMPILING)  # type: ignore[no-untyped-call]


@contextmanager
def heard(listener: Listener) -> Iterator[None]:
    """Call `listener` for every function compiled meanwhile, in place of the line of log."""
    _COMPILING.listeners.append(listener)
    try:
        yield
    finally:
        _COMPILING.listeners.remove(listener)

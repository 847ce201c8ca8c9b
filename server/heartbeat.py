"""A process of a cluster says that it is there, and learns whether it is to end."""

import asyncio
from collections.abc import Callable
from functools import partial
from typing import Any, Final

import structlog

from esplanade.server.cluster import processes
from esplanade.server.store.store import Store, StoreError

BEAT_S: Final = 1.0

log = structlog.get_logger(__name__)


class Heartbeat:
    """Says once a second that a process is there; `run` ends when it is to be drained."""

    def __init__(
        self, store: Store, name: str, kind: str, address: str, people: Callable[[], int]
    ) -> None:
        self._store = store
        self._name = name
        self._kind = kind
        self._address = address
        self._people = people

    async def begin(self) -> None:
        """Make the process known.

        Raises
        ------
        StoreError
            The database does not answer.
        """
        await self._store.write(partial(_begin, self._name, self._kind, self._address))

    async def run(self) -> None:
        """Say that the process is there until it is to end."""
        drained = False
        while not drained:
            await asyncio.sleep(BEAT_S)
            try:
                drained = await self._store.write(partial(_beat, self._name, self._people()))
            except StoreError as error:
                log.debug("the database does not know that we are here", why=str(error))
        log.info("drained", name=self._name)

    async def end(self) -> None:
        """Note that the process ends."""
        try:
            await self._store.write(partial(_end, self._name))
        except StoreError as error:
            log.debug("the database does not know that we end", why=str(error))


def _begin(name: str, kind: str, address: str, connection: Any) -> None:
    processes.begin(connection, name, kind, address)


def _beat(name: str, people: int, connection: Any) -> bool:
    return processes.beat(connection, name, people)


def _end(name: str, connection: Any) -> None:
    processes.end(connection, name)

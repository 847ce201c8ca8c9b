"""Writes rows to the store later, in order, so that whoever makes them never waits."""

import asyncio
from collections import deque
from collections.abc import Callable
from typing import Final

import structlog
from sqlalchemy import Connection

from esplanade.server.store.store import Store, StoreError

TOGETHER: Final = 64
"""So many changes share a transaction."""
PAUSE_S: Final = 1.0
"""A store that cannot be written is tried again after this time."""

log = structlog.get_logger(__name__)
Change = Callable[[Connection], None]


class WrittenLater:
    """A bounded queue of changes to the store; `run` writes them until it is cancelled."""

    def __init__(self, store: Store, most: int) -> None:
        self._store = store
        self._most = most
        self._changes: deque[Change] = deque()
        self._wanted = asyncio.Event()
        self._idle = asyncio.Event()
        self._idle.set()
        self.refused = 0
        """Changes that were refused because too many waited."""

    @property
    def waiting(self) -> int:
        """Changes that are not committed yet."""
        return len(self._changes)

    def put(self, change: Change) -> bool:
        """Write this later; False if too much waits already."""
        if len(self._changes) >= self._most:
            self.refused += 1
            return False
        self._changes.append(change)
        self._idle.clear()
        self._wanted.set()
        return True

    async def written(self) -> None:
        """Wait until nothing waits."""
        await self._idle.wait()

    async def run(self) -> None:
        """Write what comes until cancelled."""
        while True:
            await self._wanted.wait()
            self._wanted.clear()
            while self._changes:
                await self._some()

    async def flush(self) -> None:
        """Write what is left, once, at the end."""
        while self._changes and await self._some(patient=False):
            pass

    async def _some(self, *, patient: bool = True) -> bool:
        some = [self._changes[k] for k in range(min(TOGETHER, len(self._changes)))]
        try:
            await self._store.write(lambda connection: [change(connection) for change in some])
        except StoreError as error:
            log.warning("what people sent is not kept yet", why=str(error), waiting=self.waiting)
            if patient:
                await asyncio.sleep(PAUSE_S)
            return False
        for _ in some:
            self._changes.popleft()
        if not self._changes:
            self._idle.set()
        return True

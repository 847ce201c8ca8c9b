"""Writes rows to the store later, in order, so that whoever makes them never waits."""

import asyncio
from collections import deque
from collections.abc import Callable
from typing import Final, NamedTuple

import structlog
from sqlalchemy import Connection
from sqlalchemy.exc import DataError, DBAPIError, IntegrityError

from esplanade.server.store.store import Store, StoreError

TOGETHER: Final = 64
"""So many changes share a transaction."""
PAUSE_S: Final = 1.0
"""A store that cannot be written is tried again after this time."""

log = structlog.get_logger(__name__)
Change = Callable[[Connection], None]


class _Waiting(NamedTuple):
    change: Change
    then: Callable[[], None] | None


class WrittenLater:
    """A bounded queue of changes to the store; `run` writes them until it is cancelled.

    While the store is away all of them wait. A change that the store does not take though it is
    there, for its number or its text, is counted and told in the log; it holds up no other.
    A change may be made twice, since the answer of the store may be lost.
    """

    def __init__(self, store: Store, most: int) -> None:
        self._store = store
        self._most = most
        self._changes: deque[_Waiting] = deque()
        self._wanted = asyncio.Event()
        self._idle = asyncio.Event()
        self._idle.set()
        self.refused = 0
        """Changes that were refused because too many waited."""
        self.failed = 0
        """Changes that the store did not take."""

    @property
    def waiting(self) -> int:
        """Changes that are not committed yet."""
        return len(self._changes)

    def put(self, change: Change, then: Callable[[], None] | None = None) -> bool:
        """Write this later, and call `then` when it is committed; False if too much waits."""
        if len(self._changes) >= self._most:
            self.refused += 1
            return False
        self._changes.append(_Waiting(change, then))
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
            faults = await self._store.write(
                lambda connection: [_fault_of(connection, waiting.change) for waiting in some]
            )
        except StoreError as error:
            log.warning("what people sent is not kept yet", why=str(error), waiting=self.waiting)
            if patient:
                await asyncio.sleep(PAUSE_S)
            return False
        for (_, then), fault in zip(some, faults, strict=True):
            self._changes.popleft()
            if fault is not None:
                self.failed += 1
                log.error("something that people sent is not kept", why=" ".join(fault.split()))
            elif then is not None:
                then()
        if not self._changes:
            self._idle.set()
        return True


def _fault_of(connection: Connection, change: Change) -> str | None:
    """Make a change, or leave no trace of it and tell why it cannot be made.

    Raises
    ------
    DBAPIError
        The store is away, or takes no change at all.
    """
    try:
        with connection.begin_nested():
            change(connection)
    except (IntegrityError, DataError) as error:
        return str(error.orig)
    except DBAPIError:
        raise
    except Exception as error:  # noqa: BLE001 (it is told in the log)
        return str(error)
    return None

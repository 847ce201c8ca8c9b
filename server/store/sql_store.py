"""The store as there is one: SQLite or PostgreSQL through SQLAlchemy, in threads of its own."""

import asyncio
import threading
from collections.abc import AsyncIterator, Callable
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import asynccontextmanager
from typing import Any, Final

from sqlalchemy import Connection, Engine
from sqlalchemy.exc import SQLAlchemyError

from esplanade.server.store.engines import reading_engine, writing_engine
from esplanade.server.store.location import Location
from esplanade.server.store.store import ZONE, Result, StoreBusyError, StoreError
from esplanade.server.store.upgrading import check_current, upgrade
from esplanade.server.store.writing import WritingThread, in_words

READERS: Final = 2
READS_WAITING: Final = 256
"""No more reads may wait or be under way."""


class SqlStore:
    """A `Store` in SQLite or PostgreSQL.

    One thread writes. Two others read; a store in memory has one connection, and reads in the
    thread that writes.
    """

    def __init__(
        self,
        location: Location,
        *,
        durable: bool = False,
        zone: str = ZONE,
        idle_ms: int | None = None,
    ) -> None:
        """Begin threads; nothing is connected yet. `open_store` also sees to the tables.

        Raises
        ------
        StoreError
            The folder cannot be made, or a driver is missing.
        """
        self.location = location
        self.zone = zone
        self.engine = writing_engine(location, durable=durable, zone=zone, idle_ms=idle_ms)
        self._reading: Engine | None = None if location.in_memory else reading_engine(location)
        self._writes = WritingThread(self.engine, location)
        self._reads = ThreadPoolExecutor(READERS, thread_name_prefix="store-reads")
        self._counting = threading.Lock()
        self._reads_waiting = 0
        self._reads_refused = 0
        self._closed = False

    @property
    def world(self) -> str:
        """As `zone`: this is the store of a whole world."""
        return self.zone

    @property
    def waiting(self) -> int:
        """Changes and reads that wait or are under way."""
        return self._writes.waiting + self._reads_waiting

    @property
    def refused(self) -> int:
        """Changes and reads that were refused because too many waited."""
        return self._writes.refused + self._reads_refused

    @property
    def commits(self) -> int:
        """Transactions that were committed."""
        return self._writes.commits

    async def read(self, query: Callable[[Connection], Result]) -> Result:
        """Return the result of a query; see `Store.read`."""
        if self._reading is None:
            return await self.write(query)
        with self._counting:
            if self._closed:
                raise StoreError(f"{self.location} is closed")
            if self._reads_waiting >= READS_WAITING:
                self._reads_refused += 1
                raise StoreBusyError(
                    f"{self.location}: {READS_WAITING} reads wait already; try again later"
                )
            self._reads_waiting += 1
            reading = self._reads.submit(self._read, self._reading, query)
        reading.add_done_callback(self._read_ended)
        return await asyncio.wrap_future(reading)

    async def write(self, change: Callable[[Connection], Result]) -> Result:
        """Return the result of a change once it is committed; see `Store.write`."""
        written: Result = await asyncio.wrap_future(self._writes.put(change))
        return written

    async def close(self) -> None:
        """Finish what was asked for, and disconnect."""
        with self._counting:
            self._closed = True
        await asyncio.to_thread(self._close)

    def _close(self) -> None:
        self._writes.close()
        self._reads.shutdown()
        self.engine.dispose()
        if self._reading is not None:
            self._reading.dispose()

    def _read(self, engine: Engine, query: Callable[[Connection], Any]) -> Any:
        try:
            with engine.begin() as connection:
                return query(connection)
        except SQLAlchemyError as error:
            raise in_words(error, self.location) from error

    def _read_ended(self, _: "Future[Any]") -> None:
        with self._counting:
            self._reads_waiting -= 1


@asynccontextmanager
async def open_store(
    location: Location,
    *,
    durable: bool = False,
    upgrading: bool | None = None,
    zone: str = ZONE,
    idle_ms: int | None = None,
) -> AsyncIterator[SqlStore]:
    """A store with the tables of this program; `idle_ms` is as in `writing_engine`.

    An SQLite file is upgraded here; a database, which several servers may use, only where
    `upgrading` says so.

    Raises
    ------
    StoreError
        The store cannot be reached, or its tables are older or newer than this program.
    """
    store = SqlStore(location, durable=durable, zone=zone, idle_ms=idle_ms)
    try:
        await asyncio.to_thread(
            _see_to_tables, store, location.is_sqlite if upgrading is None else upgrading
        )
        yield store
    finally:
        await store.close()


def _see_to_tables(store: SqlStore, upgrading: bool) -> None:
    try:
        if upgrading:
            upgrade(store.engine, store.location)
        else:
            with store.engine.begin() as connection:
                check_current(connection, store.location)
    except SQLAlchemyError as error:
        raise in_words(error, store.location) from error

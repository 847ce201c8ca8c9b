"""The audit as the server uses it: rows are recorded, and read page by page."""

import json
import time
from collections.abc import AsyncIterator, Callable
from dataclasses import dataclass
from typing import Any, Final

from sqlalchemy import Connection, Select, select, tuple_

from esplanade.server.audit.chain import append
from esplanade.server.audit.entries import Entry, Row
from esplanade.server.store.store import Store
from esplanade.server.store.tables import AUDIT

MOST_ROWS: Final = 1000
"""A page has no more rows."""

Cursor = tuple[int, int]
"""The end of a page: time and id of its last row."""


def now_us() -> int:
    """Microseconds since 1970, UTC."""
    return time.time_ns() // 1000


@dataclass(frozen=True, slots=True, kw_only=True)
class Filter:
    """A choice of rows; fields that are not given do not matter."""

    since_us: int | None = None
    until_us: int | None = None
    """The first moment that is not wanted."""
    account: str | None = None
    command: str | None = None
    target: str | None = None
    """The actor, scope or door that a command is about."""
    person: str | None = None
    """The person or account that a command is about."""


@dataclass(frozen=True, slots=True)
class Page:
    """Rows, the newest first, and where the next page begins; None at the end."""

    rows: tuple[Row, ...]
    next: Cursor | None


class AuditLog:
    """The audit of one zone, and the chain of one writer in it."""

    def __init__(self, store: Store, writer: str, clock_us: Callable[[], int] = now_us) -> None:
        self._store = store
        self._writer = writer
        self._clock_us = clock_us

    async def record(self, entry: Entry) -> int:
        """Write a row; it is committed when this returns. The result is its number in the chain.

        A command enters its tick only after that, so that whatever happens to a world is in the
        audit, even if the process dies in between.

        Raises
        ------
        StoreError
            It could not be written: the command must not be carried out.
        """
        return await self._store.write(lambda connection: self.add(connection, entry))

    def add(self, connection: Connection, entry: Entry) -> int:
        """Write a row together with what else a write of the store changes."""
        return append(connection, self._store.zone, self._writer, self._clock_us(), entry)

    async def page(self, wanted: Filter, *, after: Cursor | None = None, limit: int = 100) -> Page:
        """A page of rows, the newest first; `after` is the `next` of the page before.

        Raises
        ------
        ValueError
            `limit` is not from 1 to `MOST_ROWS`.
        StoreError
            The store cannot be read.
        """
        if not 1 <= limit <= MOST_ROWS:
            raise ValueError(f"limit: {limit} is not from 1 to {MOST_ROWS}")
        query = _query(self._store.zone, wanted, after).limit(limit + 1)
        found = await self._store.read(lambda connection: connection.execute(query).all())
        rows = tuple(_row(each) for each in found[:limit])
        more = len(found) > limit
        return Page(rows, (rows[-1].at_us, rows[-1].id) if more else None)

    async def own_rows(self, after: int, most: int) -> list[Row]:
        """The rows of this writer with numbers above `after`, in order; at most the last ones.

        Raises
        ------
        StoreError
            The store cannot be read.
        """
        query = (
            select(*(AUDIT.c[name] for name in _SHOWN))
            .where(
                AUDIT.c.zone == self._store.zone,
                AUDIT.c.writer == self._writer,
                AUDIT.c.seq > after,
            )
            .order_by(AUDIT.c.seq.desc())
            .limit(most)
        )

        def read(connection: Connection) -> list[Row]:
            return [_row(found) for found in connection.execute(query)]

        return (await self._store.read(read))[::-1]

    async def rows(self, wanted: Filter) -> AsyncIterator[Row]:
        """All rows that are wanted, the newest first, in reads that are short."""
        after: Cursor | None = None
        while True:
            page = await self.page(wanted, after=after, limit=MOST_ROWS)
            for row in page.rows:
                yield row
            if page.next is None:
                return
            after = page.next


def _query(zone: str, wanted: Filter, after: Cursor | None) -> Select[Any]:
    query = select(*(AUDIT.c[name] for name in _SHOWN)).where(AUDIT.c.zone == zone)
    for column in (AUDIT.c.account, AUDIT.c.command, AUDIT.c.target, AUDIT.c.person):
        value = getattr(wanted, column.name)
        if value is not None:
            query = query.where(column == value)
    if wanted.since_us is not None:
        query = query.where(AUDIT.c.at_us >= wanted.since_us)
    if wanted.until_us is not None:
        query = query.where(AUDIT.c.at_us < wanted.until_us)
    if after is not None:
        query = query.where(tuple_(AUDIT.c.at_us, AUDIT.c.id) < after)
    return query.order_by(AUDIT.c.at_us.desc(), AUDIT.c.id.desc())


def _row(found: Any) -> Row:
    values = dict(found._mapping)  # noqa: SLF001 (it is SQLAlchemy's public name)
    values["body"] = json.loads(values["body"])
    values["detail"] = None if values["detail"] is None else json.loads(values["detail"])
    return Row(**values)


_SHOWN: Final = (
    *("id", "writer", "seq", "at_us", "tick", "command", "account", "role", "address", "target"),
    *("outcome", "refers_to", "body", "person", "note", "detail", "hash"),
)

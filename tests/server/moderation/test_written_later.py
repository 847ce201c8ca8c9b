"""Changes that are written later hold nothing up, while the store is away or where it refuses."""

import asyncio
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from functools import partial
from typing import Any

import pytest
from sqlalchemy import Connection
from sqlalchemy.exc import OperationalError

from esplanade.server.moderation import rows, written_later
from esplanade.server.moderation.inbox import Report
from esplanade.server.moderation.written_later import WrittenLater
from esplanade.server.store.sql_store import SqlStore
from esplanade.server.store.store import StoreError

TEXTS = ("one", "two", "three", "four")


class Forgetful:
    """A store whose next answers are lost, though it has committed."""

    def __init__(self, store: SqlStore, lost: int) -> None:
        self.zone = store.zone
        self._store = store
        self._lost = lost

    async def write(self, change: Callable[[Connection], Any]) -> Any:
        result = await self._store.write(change)
        self._lost -= 1
        if self._lost >= 0:
            raise StoreError("the connection is lost")
        return result


def report(number: int, text: str) -> Report:
    return Report(number, 5, 1, "Ann", 2, "Eve", text, None)


def put(store: SqlStore, one: Report) -> Callable[[Connection], None]:
    return partial(rows.put_report, zone=store.zone, report=one)


async def texts(store: SqlStore) -> dict[int, str]:
    kept = await store.read(partial(rows.all_reports, zone=store.zone))
    return {each.id: each.text for each in kept}


async def test_what_the_store_never_takes_holds_up_nothing_behind_it(store: SqlStore) -> None:
    """One number is another's, and one has more than 64 bits."""
    await store.write(put(store, report(1, "earlier")))
    later, written = WrittenLater(store, 9), list[int]()
    for one in (
        report(1, "another"),
        report(2, "two"),
        report(2**70, "too far"),
        report(3, "three"),
    ):
        assert later.put(put(store, one), partial(written.append, one.id))
    running = asyncio.create_task(later.run())
    async with asyncio.timeout(60):
        await later.written()
    running.cancel()
    with suppress(asyncio.CancelledError):
        await running
    assert await texts(store) == {1: "earlier", 2: "two", 3: "three"}
    assert (written, later.failed, later.waiting) == ([2, 3], 2, 0)


async def test_a_change_whose_answer_was_lost_is_written_once(
    store: SqlStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(written_later, "PAUSE_S", 0.0)
    later = WrittenLater(Forgetful(store, 2), 9)  # type: ignore[arg-type]
    for k, text in enumerate(TEXTS):
        assert later.put(put(store, report(k, text)))
    running = asyncio.create_task(later.run())
    async with asyncio.timeout(60):
        await later.written()
    running.cancel()
    with suppress(asyncio.CancelledError):
        await running
    assert await texts(store) == dict(enumerate(TEXTS))
    assert later.failed == 0


async def test_while_the_store_is_away_all_waits_and_keeps_its_order(store: SqlStore) -> None:
    def away(connection: Connection) -> None:
        if gone:
            raise OperationalError("insert", None, Exception("the server closed the connection"))
        rows.put_report(connection, store.zone, report(1, "one"))

    gone, later = [True], WrittenLater(store, 9)
    later.put(away)
    later.put(put(store, replace(report(1, "one"), text="another")))
    await later.flush()
    assert (later.waiting, later.failed, await texts(store)) == (2, 0, {})
    gone.clear()
    await later.flush()
    assert (later.waiting, later.failed, await texts(store)) == (0, 1, {1: "one"})

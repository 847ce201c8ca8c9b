"""Transactions of a store, on both databases: all or nothing, in order, bounded, seen by others."""

import asyncio
import re
import stat
import threading
from pathlib import Path

import pytest
from sqlalchemy import Connection, func, insert, select, text

from esplanade.server.store import sql_store, writing
from esplanade.server.store.location import Location
from esplanade.server.store.sql_store import SqlStore, open_store
from esplanade.server.store.store import Store, StoreBusyError, StoreError
from esplanade.server.store.tables import ACCOUNTS
from tests.patience import PATIENCE_S


def add(connection: Connection, name: str) -> None:
    connection.execute(insert(ACCOUNTS).values(zone="main", name=name, role="viewer", created_us=1))


def names(connection: Connection) -> list[str]:
    return list(connection.scalars(select(ACCOUNTS.c.name).order_by(ACCOUNTS.c.name)))


async def test_what_was_written_is_read(store: SqlStore) -> None:
    as_asked: Store = store
    await as_asked.write(lambda connection: add(connection, "ann"))
    assert await as_asked.read(names) == ["ann"]


async def test_a_change_that_fails_leaves_no_trace_and_harms_no_other(store: SqlStore) -> None:
    entered, held = threading.Event(), threading.Event()

    def hold(connection: Connection) -> None:
        entered.set()
        held.wait(PATIENCE_S)

    def half(connection: Connection) -> None:
        add(connection, "half")
        raise ValueError("in the middle")

    holding = asyncio.create_task(store.write(hold))
    await asyncio.to_thread(entered.wait, PATIENCE_S)
    three = [  # they wait behind the one that holds, so that they share a commit
        asyncio.create_task(store.write(lambda connection: add(connection, "ann"))),
        asyncio.create_task(store.write(half)),
        asyncio.create_task(store.write(lambda connection: add(connection, "bob"))),
    ]
    await asyncio.sleep(0)
    before = store.commits
    held.set()
    outcomes = await asyncio.gather(holding, *three, return_exceptions=True)
    assert [type(outcome) for outcome in outcomes] == [type(None)] * 2 + [ValueError, type(None)]
    assert await store.read(names) == ["ann", "bob"]
    assert store.commits == before + 2  # in a file, reads are none of them


async def test_a_fault_of_the_database_is_told_in_words(store: SqlStore) -> None:
    await store.write(lambda connection: add(connection, "ann"))
    with pytest.raises(StoreError, match=f"^{re.escape(str(store.location))}: .*(UNIQUE|unique)"):
        await store.write(lambda connection: add(connection, "ann"))
    with pytest.raises(StoreError, match="no_such_table"):
        await store.read(lambda connection: connection.execute(text("SELECT 1 FROM no_such_table")))


async def test_reads_change_nothing(store: SqlStore) -> None:
    with pytest.raises(StoreError, match=r"readonly|read-only"):
        await store.read(lambda connection: add(connection, "ann"))


async def test_another_process_sees_a_change_at_once_and_writes_too(location: Location) -> None:
    async with open_store(location, upgrading=True) as one, open_store(location) as other:
        await one.write(lambda connection: add(connection, "ann"))
        assert await other.read(names) == ["ann"]

        def count_and_add(connection: Connection) -> int:
            count = connection.execute(select(func.count()).select_from(ACCOUNTS)).scalar() or 0
            add(connection, f"n{count:03}")
            return count

        writes = [store.write(count_and_add) for _ in range(20) for store in (one, other)]
        counts = await asyncio.gather(*writes)
    assert sorted(counts) == list(range(1, 41))  # nobody looked in the midst of another's change


async def test_what_waits_to_be_written_is_bounded(
    store: SqlStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    entered, held = threading.Event(), threading.Event()

    def hold(connection: Connection) -> None:
        entered.set()
        held.wait(PATIENCE_S)

    holding = asyncio.create_task(store.write(hold))
    await asyncio.to_thread(entered.wait, PATIENCE_S)
    waiting = [asyncio.create_task(store.write(names)) for _ in range(writing.WAITING)]
    await asyncio.sleep(0)
    assert store.waiting == writing.WAITING
    with pytest.raises(StoreBusyError, match="try again later"):
        await store.write(names)
    assert store.refused == 1
    held.set()
    await holding
    assert await asyncio.gather(*waiting) == [[]] * writing.WAITING
    assert store.waiting == 0


async def test_reads_are_bounded(store: SqlStore, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sql_store, "READS_WAITING", 3)
    held = threading.Event()

    def hold(connection: Connection) -> bool:
        return held.wait(PATIENCE_S)

    holding = [asyncio.create_task(store.read(hold)) for _ in range(3)]
    await asyncio.sleep(0)
    with pytest.raises(StoreBusyError, match="3 reads wait"):
        await store.read(names)
    assert (store.refused, store.waiting) == (1, 3)
    held.set()
    assert await asyncio.gather(*holding) == [True] * 3
    assert await store.read(names) == []


async def test_a_change_that_was_given_up_before_it_began_is_not_made(store: SqlStore) -> None:
    entered, held = threading.Event(), threading.Event()

    def hold(connection: Connection) -> None:
        entered.set()
        held.wait(PATIENCE_S)

    holding = asyncio.create_task(store.write(hold))
    await asyncio.to_thread(entered.wait, PATIENCE_S)
    given_up = asyncio.create_task(store.write(lambda connection: add(connection, "ann")))
    await asyncio.sleep(0)
    given_up.cancel()
    await asyncio.wait([given_up])
    await asyncio.sleep(0)  # the thread's future is told by a callback
    held.set()
    await holding
    assert await store.read(names) == []


async def test_a_closed_store_says_so_after_it_has_made_what_waited(location: Location) -> None:
    async with open_store(location, upgrading=True) as store:
        waiting = [
            asyncio.create_task(store.write(lambda connection, n=n: add(connection, f"n{n}")))  # type: ignore[misc]
            for n in range(9)
        ]
        await asyncio.sleep(0)
    await asyncio.gather(*waiting)
    for call in (store.read, store.write):
        with pytest.raises(StoreError, match="is closed"):
            await call(names)
    async with open_store(location) as again:
        assert len(await again.read(names)) == 9


async def test_a_database_that_comes_back_is_used_again(store: SqlStore) -> None:
    if store.location.is_sqlite:
        pytest.skip("a file has no connections to lose")
    await store.write(lambda connection: add(connection, "ann"))
    assert await store.read(names) == ["ann"]
    ending = text(
        "SELECT pg_terminate_backend(pid) FROM pg_stat_activity "
        "WHERE datname = current_database() AND pid <> pg_backend_pid()"
    )
    await store.write(lambda connection: connection.execute(ending).rowcount)
    assert await store.read(names) == ["ann"]
    async with open_store(store.location) as other:
        await other.write(lambda connection: connection.execute(ending).rowcount)
    await store.write(lambda connection: add(connection, "bob"))
    assert await store.read(names) == ["ann", "bob"]


async def test_event_loops_of_other_threads_may_ask(store: SqlStore) -> None:
    def elsewhere() -> list[str]:
        async def ask() -> list[str]:
            await store.write(lambda connection: add(connection, "ann"))
            return await store.read(names)

        return asyncio.run(ask())

    assert await asyncio.to_thread(elsewhere) == ["ann"]


async def test_a_store_in_memory_ends_with_the_process() -> None:
    for _ in range(2):
        async with open_store(Location.of(None)) as store:
            assert store.location.in_memory
            assert await store.read(names) == []
            await store.write(lambda connection: add(connection, "ann"))
            assert await store.read(names) == ["ann"]


async def test_a_file_is_for_its_user_only_and_has_a_journal(tmp_path: Path) -> None:
    folder = tmp_path / "far" / "data"
    async with open_store(Location.of(folder), durable=True) as store:
        (mode,) = await store.read(
            lambda connection: connection.execute(text("PRAGMA journal_mode")).one()
        )
        (sync,) = await store.write(
            lambda connection: connection.execute(text("PRAGMA synchronous")).one()
        )
        assert (mode, sync) == ("wal", 2)
        assert stat.S_IMODE(folder.stat().st_mode) == 0o700
        files = list(folder.iterdir())
        assert len(files) == 3
        assert {stat.S_IMODE(file.stat().st_mode) for file in files} == {0o600}


async def test_a_folder_that_cannot_be_made_is_named(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(StoreError, match=r"file/data/esplanade.sqlite: Not a directory"):
        SqlStore(Location.of(tmp_path / "file" / "data"))


async def test_a_file_that_is_no_store_is_named(tmp_path: Path) -> None:
    (tmp_path / "esplanade.sqlite").write_text("no database, but text " * 100)
    with pytest.raises(StoreError, match=r"esplanade.sqlite: file is not a database"):
        async with open_store(Location.of(tmp_path)):
            pass


async def test_a_database_that_cannot_be_reached_is_named_without_its_password() -> None:
    location = Location.of(None, "postgresql://ann:secret@127.0.0.1:1/world")
    with pytest.raises(StoreError, match=r"127.0.0.1:1/world: .*refused") as raised:
        async with open_store(location):
            pass
    assert "secret" not in str(raised.value)
    assert "ann:***@" in str(raised.value)


@pytest.mark.parametrize(
    "address", ["world", "mysql://ann:secret@host/world", "postgresql://ann:secret@host", "://"]
)
def test_an_address_that_is_none_is_refused_without_its_password(address: str) -> None:
    with pytest.raises(StoreError, match="is no address such as postgresql://") as raised:
        Location.of(None, address)
    assert "secret" not in str(raised.value)

"""The audit: rows in chains, one for each writer, read page by page and by what is wanted."""

import asyncio
from dataclasses import replace
from itertools import product
from typing import Any

import pytest
from sqlalchemy import Connection, text

from esplanade.server.audit.entries import Entry, Row
from esplanade.server.audit.log import MOST_ROWS, AuditLog, Filter
from esplanade.server.audit.verifying import verify
from esplanade.server.store.location import Location
from esplanade.server.store.sql_store import SqlStore, open_store
from esplanade.server.store.store import StoreError
from tests.server.stores import Clock

FULL = Entry(
    command="set_parameters",
    account="olga",
    role="tuner",
    address="192.0.2.7",
    target="actor-3",
    tick=12345,
    body={"values": {"risk_weight": 12.5}, "before": None, "ä": [1, True]},
    person="Ärger",
    note="queue at the café",
    detail={"text": "…"},
)


async def all_rows(log: AuditLog, wanted: Filter = Filter()) -> list[Row]:  # noqa: B008
    return [row async for row in log.rows(wanted)]


async def test_a_row_says_what_the_entry_said(store: SqlStore) -> None:
    clock = Clock()
    log = AuditLog(store, "server", clock)
    assert await log.record(FULL) == 1
    assert await log.record(Entry(command="set_parameters", outcome="applied", refers_to=1)) == 2
    outcome, row = await all_rows(log)
    assert (outcome.refers_to, outcome.outcome, outcome.account) == (1, "applied", None)
    assert (row.seq, row.writer, row.at_us) == (1, "server", clock.now_us)
    said = {name: getattr(row, name) for name in Entry.__dataclass_fields__}
    assert Entry(**said) == FULL


async def test_each_writer_has_a_chain_and_many_may_write_one(location: Location) -> None:
    async with open_store(location, upgrading=True) as store, open_store(location) as other:
        logs = [AuditLog(store, "server"), AuditLog(store, "command line")]
        logs.append(AuditLog(other, "command line"))
        numbers = await asyncio.gather(
            *(log.record(Entry(command="mark")) for _ in range(20) for log in logs)
        )
        chains = await verify(store)
    assert sorted(numbers[::3]) == list(range(1, 21))
    assert sorted(numbers[1::3] + numbers[2::3]) == list(range(1, 41))
    assert [(chain.writer, chain.rows, chain.fault) for chain in chains] == [
        ("command line", 40, None),
        ("server", 20, None),
    ]


async def test_time_never_falls_in_a_chain(store: SqlStore) -> None:
    clock = Clock()
    log = AuditLog(store, "server", clock)
    await log.record(Entry(command="mark"))
    clock.go_on(-3600)
    await log.record(Entry(command="mark"))
    later, earlier = await all_rows(log)
    assert later.at_us == earlier.at_us
    assert [chain.fault for chain in await verify(store)] == [None]


async def test_pages_follow_on_each_other(store: SqlStore) -> None:
    clock = Clock()
    logs = [AuditLog(store, writer, clock) for writer in ("server", "command line")]
    for count in range(23):
        clock.go_on(count % 2)  # several rows have one time
        await logs[count % 3 == 0].record(Entry(command="mark", body={"count": count}))
    seen: list[Row] = []
    after = None
    for size in (7, 7, 7, 2):
        page = await logs[0].page(Filter(), after=after, limit=7)
        assert len(page.rows) == size
        seen += page.rows
        after = page.next
    assert after is None
    assert [row.body["count"] for row in seen] == list(range(22, -1, -1))
    assert seen == await all_rows(logs[0])


@pytest.mark.parametrize("limit", [0, -1, MOST_ROWS + 1])
async def test_a_page_has_a_size(store: SqlStore, limit: int) -> None:
    with pytest.raises(ValueError, match=r"limit: .* is not from 1 to 1000"):
        await AuditLog(store, "server").page(Filter(), limit=limit)


ROWS = [
    Entry(command=command, account=account, target=target, person=person)
    for command in ("pace", "kick")
    for account in ("olga", "ann", None)
    for target in ("actor-1", "")
    for person in ("Eve", None)
]


async def test_a_filter_gives_the_rows_that_it_says(store: SqlStore) -> None:
    clock = Clock()
    log = AuditLog(store, "server", clock)
    begin = clock.now_us
    for entry in ROWS:
        clock.go_on(1)
        await log.record(entry)
    offers: tuple[list[Any], ...] = (
        [None, begin, begin + 8 * 10**6],
        [None, begin + 17 * 10**6],
        [None, "olga", "nobody"],
        [None, "pace", "kick"],
        [None, "actor-1", ""],
        [None, "Eve"],
    )
    for since_us, until_us, account, command, target, person in product(*offers):
        named = {"account": account, "command": command, "target": target, "person": person}
        kept = Filter(since_us=since_us, until_us=until_us, **named)
        expected = [
            number
            for number, entry in enumerate(ROWS, 1)
            if (kept.since_us is None or begin + number * 10**6 >= kept.since_us)
            and (kept.until_us is None or begin + number * 10**6 < kept.until_us)
            and all(
                getattr(kept, name) in {None, getattr(entry, name)}
                for name in ("account", "command", "target", "person")
            )
        ]
        found = await all_rows(log, kept)
        assert [row.seq for row in found] == expected[::-1], kept


async def test_rows_are_added_only_whoever_asks(store: SqlStore) -> None:
    log = AuditLog(store, "server")
    await log.record(FULL)
    (row,) = await all_rows(log)
    for statement in (
        "UPDATE audit SET command = 'pace'",
        "UPDATE audit SET hash = 'x', note = NULL",
        "UPDATE audit SET note = 'another'",
        "UPDATE audit SET account = 'ann'",
        "DELETE FROM audit",
        *([] if store.location.is_sqlite else ["TRUNCATE audit"]),
    ):

        def change(connection: Connection, statement: str = statement) -> None:
            connection.execute(text(statement))

        with pytest.raises(StoreError, match="rows of the audit are added only"):
            await store.write(change)
    assert await all_rows(log) == [row]


async def test_an_entry_that_is_no_json_is_not_written(store: SqlStore) -> None:
    log = AuditLog(store, "server")
    with pytest.raises(ValueError, match="not JSON compliant"):
        await log.record(replace(FULL, body={"risk_weight": float("nan")}))
    assert await all_rows(log) == []

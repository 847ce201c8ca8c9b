"""A person is forgotten in every table that says something of people, or in none."""

import pytest
from sqlalchemy import Connection

from esplanade.server.accounts.identity import MACHINE
from esplanade.server.audit.entries import Entry
from esplanade.server.audit.log import AuditLog, Filter
from esplanade.server.operating import forgetting
from esplanade.server.store.sql_store import SqlStore


@pytest.fixture
async def log(store: SqlStore) -> AuditLog:
    made = AuditLog(store, "server")
    await made.record(Entry(command="kick", account="olga", address="192.0.2.7", person="Eve"))
    await made.record(Entry(command="kick", account="olga", person="Bob", note="rude"))
    return made


async def test_a_table_of_another_part_is_asked_too(
    store: SqlStore, log: AuditLog, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[tuple[str, str]] = []

    def in_seats(connection: Connection, zone: str, person: str) -> int:
        asked.append((zone, person))
        return 3

    monkeypatch.setattr(forgetting, "FORGETTERS", {**forgetting.FORGETTERS, "seats": in_seats})
    counts = await forgetting.forget(store, log, MACHINE, "Eve")
    assert asked == [("main", "Eve")]
    assert {name: count for name, count in counts.items() if count} == {"seats": 3, "audit": 1}
    told, bob, eve = (await log.page(Filter())).rows
    assert told.body["counts"] == counts
    assert "Eve" not in str(told)
    assert (eve.person, eve.account, eve.address) == (None, "olga", "192.0.2.7")
    assert (bob.person, bob.note) == ("Bob", "rude")


async def test_where_one_table_fails_nothing_is_forgotten(
    store: SqlStore, log: AuditLog, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(connection: Connection, zone: str, person: str) -> int:
        raise RuntimeError("seats cannot be read")

    monkeypatch.setattr(forgetting, "FORGETTERS", {**forgetting.FORGETTERS, "seats": fail})
    before = await log.page(Filter())
    with pytest.raises(RuntimeError, match="seats cannot be read"):
        await forgetting.forget(store, log, MACHINE, "Eve")
    assert await log.page(Filter()) == before


async def test_nothing_known_is_no_row(store: SqlStore, log: AuditLog) -> None:
    before = await log.page(Filter())
    counts = await forgetting.forget(store, log, MACHINE, "nobody")
    assert {"accounts", "invitations", "bots", "audit"} <= counts.keys()
    assert not any(counts.values())
    assert await log.page(Filter()) == before

"""A person is forgotten in every table that says something of people, or in none."""

import json

import pytest
from sqlalchemy import Connection, insert, select

from esplanade.server.accounts.identity import MACHINE
from esplanade.server.audit.entries import Entry
from esplanade.server.audit.log import AuditLog, Filter
from esplanade.server.cluster import seats
from esplanade.server.operating import forgetting
from esplanade.server.operating.forgetting import forget
from esplanade.server.store.sql_store import SqlStore
from esplanade.server.store.tables import OPERATED


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


async def test_seats_in_any_zone_of_a_cluster_are_taken_away(
    store: SqlStore, log: AuditLog
) -> None:
    def seat_everyone(connection: Connection) -> None:
        for zone, name in [("hall", "Eve"), ("plaza", "Eve"), ("plaza", "Bob")]:
            seats.take(connection, zone, name, "east", name.encode())

    await store.write(seat_everyone)
    counts = await forget(store, log, MACHINE, "Eve")
    assert counts["cluster seats"] == 2
    assert await store.read(lambda to: seats.seats_in(to, "hall")) == []
    assert [seat.name for seat in await store.read(lambda to: seats.seats_in(to, "plaza"))] == [
        "Bob"
    ]


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
    assert not any(counts.values())
    assert await log.page(Filter()) == before


async def test_who_made_presets_and_schedules_is_forgotten(store: SqlStore, log: AuditLog) -> None:
    preset = {"head": 1, "versions": [{"name": "mine", "by": "olga", "note": "mine", "values": {}}]}
    schedule = {"id": "s1", "by": "olga", "note": None, "rights": "parameters"}
    other = {**schedule, "id": "s2", "by": "oleg"}
    rows = [("presets", "mine", preset), ("schedules", "s1", schedule), ("schedules", "s2", other)]

    def write(connection: Connection) -> None:
        for part, name, body in rows:
            values = {"zone": store.zone, "part": part, "name": name, "body": json.dumps(body)}
            connection.execute(insert(OPERATED).values(**values))

    await store.write(write)
    counts = await forget(store, log, MACHINE, "olga")
    assert counts["operated"] == 2
    query = select(OPERATED.c.body).order_by(OPERATED.c.name)
    bodies = await store.read(lambda connection: connection.execute(query).scalars().all())
    assert "olga" not in "".join(bodies)
    assert json.loads(bodies[1])["rights"] == ""
    assert json.loads(bodies[2]) == other

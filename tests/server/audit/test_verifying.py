"""Whatever is changed in the audit behind its back is found, and the first row is named."""

import re
from collections.abc import Awaitable, Callable

import pytest
from sqlalchemy import Connection, text

from esplanade.server.accounts.identity import MACHINE
from esplanade.server.audit.chain import row_hash
from esplanade.server.audit.entries import Entry
from esplanade.server.audit.erasing import erase
from esplanade.server.audit.log import AuditLog
from esplanade.server.audit.verifying import verify
from esplanade.server.operating.forgetting import forget
from esplanade.server.store.sql_store import SqlStore
from esplanade.server.store.tables import AUDIT

Tamper = Callable[..., Awaitable[None]]


@pytest.fixture
async def tamper(store: SqlStore) -> Tamper:
    """Changes the tables as somebody does who has the file: triggers stop nobody then."""
    log = AuditLog(store, "server")
    for count in range(5):
        entry = Entry(
            command="kick",
            account="olga",
            address="192.0.2.7",
            target=f"actor-{count}",
            body={"count": count},
            person="Eve" if count % 2 else "Bob",
            note="pushed others",
        )
        await log.record(entry)
    await AuditLog(store, "command line").record(Entry(command="user_add"))

    def without_triggers(connection: Connection) -> None:
        if store.location.is_sqlite:
            for name in ("audit_kept", "audit_forgets_only", "audit_not_deleted"):
                connection.execute(text(f"DROP TRIGGER {name}"))
        else:
            connection.execute(text("ALTER TABLE audit DISABLE TRIGGER ALL"))

    await store.write(without_triggers)

    async def change(*statements: str) -> None:
        def make(connection: Connection) -> None:
            for statement in statements:
                connection.execute(text(statement))

        await store.write(make)

    return change


async def faults(store: SqlStore) -> list[str]:
    return [str(chain.fault) for chain in await verify(store) if chain.fault is not None]


THIRD = "WHERE writer = 'server' AND seq = 3"


@pytest.mark.parametrize(
    ("statements", "fault"),
    [
        (
            ["UPDATE audit SET command = 'mute' " + THIRD],
            "row 3 of writer 'server': it was changed",
        ),
        (["UPDATE audit SET body = '{}' " + THIRD], "row 3 of writer 'server': it was changed"),
        (["UPDATE audit SET tick = 7 " + THIRD], "row 3 of writer 'server': it was changed"),
        (["UPDATE audit SET at_us = 1 " + THIRD], "row 3 .*: it is older than the row before"),
        (
            ["UPDATE audit SET account = 'ann' " + THIRD],
            "row 3 .*: what it says of the account was changed",
        ),
        (
            ["UPDATE audit SET note = 'x' " + THIRD],
            "row 3 .*: what it says of the person was changed",
        ),
        (
            ["UPDATE audit SET account_salt = NULL " + THIRD],
            "row 3 .*: what it says of the account has no seal",
        ),
        (
            ["UPDATE audit SET account_salt = NULL, account = NULL, address = NULL " + THIRD],
            "row 3 .*: what it said of the account was taken away, and no row tells of it",
        ),
        (["DELETE FROM audit " + THIRD], "row 3 of writer 'server': it is missing$"),
        (
            ["DELETE FROM audit WHERE writer = 'server' AND seq >= 4"],
            "row 4 .*: it is missing, and so are all up to row 5",
        ),
        (
            ["DELETE FROM audit WHERE writer = 'server'"],
            "row 1 .*: it is missing, and so are all up to row 5",
        ),
        (
            ["DELETE FROM audit_heads WHERE writer = 'server'"],
            "row 1 .*: the chain has rows, and the record of its last one is missing",
        ),
        (
            ["UPDATE audit_heads SET hash = 'x' WHERE writer = 'server'"],
            "row 5 .*: it is not the one that the record of the last row names",
        ),
    ],
)
async def test_what_was_changed_is_named(
    store: SqlStore, tamper: Tamper, statements: list[str], fault: str
) -> None:
    assert await faults(store) == []
    await tamper(*statements)
    (told,) = await faults(store)
    assert re.match(fault, told), told


async def test_a_row_with_a_hash_made_anew_breaks_the_next(store: SqlStore, tamper: Tamper) -> None:
    def forge(connection: Connection) -> None:
        chosen = (AUDIT.c.writer == "server") & (AUDIT.c.seq == 3)
        row = dict(connection.execute(AUDIT.select().where(chosen)).mappings().one())
        row["body"] = "{}"
        row["hash"] = row_hash(row)
        connection.execute(AUDIT.update().where(chosen).values(body="{}", hash=row["hash"]))

    await store.write(forge)
    assert await faults(store) == ["row 4 of writer 'server': it does not follow on the row before"]


async def test_the_fault_of_one_writer_is_none_of_another(store: SqlStore, tamper: Tamper) -> None:
    await tamper("UPDATE audit SET command = 'mute' " + THIRD)
    chains = {chain.writer: chain for chain in await verify(store)}
    assert chains["command line"].fault is None
    assert (chains["server"].rows, chains["command line"].rows) == (2, 1)


async def test_what_is_forgotten_in_good_order_is_no_fault(store: SqlStore, tamper: Tamper) -> None:
    heads = {chain.writer: chain.head for chain in await verify(store)}
    counts = await forget(store, AuditLog(store, "command line"), MACHINE, "Eve")
    assert {name: count for name, count in counts.items() if count} == {"audit": 2}
    chains = {chain.writer: chain for chain in await verify(store)}
    assert await faults(store) == []
    assert (chains["server"].forgotten, chains["server"].head) == (2, heads["server"])
    assert chains["command line"].head != heads["command line"]


async def test_what_was_erased_and_not_told_is_a_fault(store: SqlStore, tamper: Tamper) -> None:
    await store.write(lambda connection: erase(connection, store.zone, "Eve"))
    (told,) = await faults(store)
    assert told.endswith(": what it said of the person was taken away, and no row tells of it")

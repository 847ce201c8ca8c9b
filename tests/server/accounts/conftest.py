"""Accounts for tests, with hashes that are quick to make."""

from collections.abc import AsyncIterator
from dataclasses import dataclass

import pytest
from argon2 import PasswordHasher

from esplanade.server.accounts.directory import Directory
from esplanade.server.accounts.lockout import Lockout
from esplanade.server.accounts.one_time import OneTime
from esplanade.server.accounts.passwords import Passwords
from esplanade.server.accounts.sessions import Sessions
from esplanade.server.accounts.tokens import Tokens
from esplanade.server.audit.log import AuditLog, Filter
from esplanade.server.store.sql_store import SqlStore
from tests.server.stores import Clock

QUICK = PasswordHasher(time_cost=1, memory_cost=8, parallelism=1)


@dataclass
class Desk:
    """All that there is about accounts, on one store and one clock."""

    store: SqlStore
    clock: Clock
    audit: AuditLog
    passwords: Passwords
    lockout: Lockout
    directory: Directory
    sessions: Sessions
    tokens: Tokens
    one_time: OneTime

    async def audited(self) -> list[tuple[str, str | None, str | None, str]]:
        """Command, account, person and outcome of all rows of the audit, the oldest first."""
        rows = [row async for row in self.audit.rows(Filter())]
        return [(row.command, row.account, row.person, row.outcome) for row in reversed(rows)]


@pytest.fixture
async def desk(store: SqlStore) -> AsyncIterator[Desk]:
    clock, passwords, lockout = Clock(), Passwords(QUICK), Lockout()
    audit = AuditLog(store, "server", clock)
    yield Desk(
        store,
        clock,
        audit,
        passwords,
        lockout,
        Directory(store, audit, passwords, clock),
        Sessions(store, audit, passwords, lockout, clock),
        Tokens(store, audit, clock),
        OneTime(store, audit, passwords, clock),
    )
    passwords.close()

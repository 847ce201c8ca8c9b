"""Opens the store of a running server, with the audit and the accounts that stand on it."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import replace
from typing import Final

import structlog

from esplanade.server.accounts.bots import Bots
from esplanade.server.accounts.directory import Directory
from esplanade.server.accounts.invitations import Invitations
from esplanade.server.accounts.lockout import Lockout
from esplanade.server.accounts.one_time import OneTime
from esplanade.server.accounts.passwords import Passwords
from esplanade.server.accounts.sessions import Sessions
from esplanade.server.accounts.tokens import Tokens
from esplanade.server.audit.entries import Entry
from esplanade.server.audit.log import AuditLog
from esplanade.server.kept import Kept
from esplanade.server.metrics import Metrics
from esplanade.server.moderating import moderating
from esplanade.server.settings import ServerSettings
from esplanade.server.store.location import Location
from esplanade.server.store.sql_store import SqlStore, open_store

WRITER: Final = "server"
"""The writer of the audit's rows that the server writes."""

log = structlog.get_logger(__name__)


@asynccontextmanager
async def keeping(settings: ServerSettings, metrics: Metrics) -> AsyncIterator[Kept]:
    """Open the store that the settings name; without one, nothing outlives the process.

    Raises
    ------
    StoreError
        The store cannot be used.
    """
    location = Location.of(settings.data, settings.store.get_secret_value())
    async with open_store(location, durable=settings.durable) as store:
        audit = AuditLog(store, WRITER)
        if location.in_memory:
            log.info("nothing is kept when this ends; --data keeps the world and its operators")
        else:
            log.info("kept", store=str(location))
        body = {"fresh": True} if settings.fresh else {}
        started = await audit.record(Entry(command="server_start", body=body))
        try:
            async with kept_in(store, settings, metrics) as kept:
                yield replace(kept, started=started)
        finally:
            await audit.record(Entry(command="server_stop"))


@asynccontextmanager
async def kept_in(
    store: SqlStore, settings: ServerSettings, metrics: Metrics
) -> AsyncIterator[Kept]:
    """All that stands on a store that is open.

    Raises
    ------
    StoreError
        The store cannot be used.
    """
    audit, passwords, lockout = AuditLog(store, WRITER), Passwords(), Lockout()
    _watch(store, lockout, metrics)
    try:
        async with moderating(settings, store, metrics) as moderation:
            yield Kept(
                store,
                audit,
                passwords,
                lockout,
                Directory(store, audit, passwords),
                Sessions(store, audit, passwords, lockout),
                Tokens(store, audit),
                OneTime(store, audit, passwords),
                Invitations(store, audit),
                Bots(store, audit),
                moderation,
                started=0,
            )
    finally:
        passwords.close()


def _watch(store: SqlStore, lockout: Lockout, metrics: Metrics) -> None:
    metrics.gauge("store_waiting", "Changes and reads that wait", lambda: store.waiting)
    metrics.total(
        "store_refused",
        "Changes and reads that were refused because too many waited",
        lambda: store.refused,
    )
    metrics.total("store_commits", "Transactions that were committed", lambda: store.commits)
    metrics.total("passwords_wrong", "Wrong passwords of operators", lambda: lockout.wrong)
    metrics.total(
        "passwords_unread",
        "Passwords of operators that were not looked at, since too many were wrong",
        lambda: lockout.unread,
    )
    metrics.total("password_locks", "Addresses and names locked for a time", lambda: lockout.locks)

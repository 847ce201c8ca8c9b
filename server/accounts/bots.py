"""Tokens by which bots come in, each with a rate of its own."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

from sqlalchemy import Connection, Select, delete, func, insert, select

from esplanade.server.accounts.identity import (
    AccountError,
    Identity,
    checked_name,
    digest_of,
    new_secret,
)
from esplanade.server.audit.log import AuditLog, now_us
from esplanade.server.store.store import Store
from esplanade.server.store.tables import BOTS

PREFIX: Final = "esplanade_bot_"
"""Tokens begin with this, so that one that has slipped into a text is found."""
MOST: Final = 1000
"""No more bots are kept; those whose tokens are over for a month are forgotten first."""
LONGEST_US: Final = 366 * 24 * 3600 * 10**6
_KEPT_US: Final = 30 * 24 * 3600 * 10**6


@dataclass(frozen=True, slots=True)
class Bot:
    """The facts that are kept of a bot's token; the token itself is not."""

    name: str
    account: str | None
    """The operator who has made it."""
    message_rate: int
    """Messages a second that each of its connections may send for long."""
    connections: int
    """Connections that it may have open at once."""
    created_us: int
    expires_us: int


class Bots:
    """Makes tokens of bots, and finds out whose one is."""

    def __init__(self, store: Store, audit: AuditLog, clock_us: Callable[[], int] = now_us) -> None:
        self._store = store
        self._audit = audit
        self._clock_us = clock_us

    async def add(
        self, by: Identity, name: str, *, message_rate: int, connections: int, lasts_us: int
    ) -> str:
        """Make a token; it is returned this once. One of that name that is over makes way.

        Raises
        ------
        AccountError
            The name cannot be had, it would last too long, or there are too many.
        StoreError
            The store cannot be written.
        """
        checked_name(name)
        if not 0 < lasts_us <= LONGEST_US:
            raise AccountError("a bot's token lasts up to 366 days")
        zone, now, token = self._store.zone, self._clock_us(), new_secret(PREFIX)

        def change(connection: Connection) -> None:
            over = (BOTS.c.name == name) & (BOTS.c.expires_us <= now)
            long_over = BOTS.c.expires_us <= now - _KEPT_US
            connection.execute(delete(BOTS).where(BOTS.c.zone == zone, over | long_over))
            query = select(func.count()).where(BOTS.c.zone == zone)
            if connection.execute(query.where(BOTS.c.name == name)).scalar():
                raise AccountError(f"there is a bot {name!r} already", "taken")
            if (connection.execute(query).scalar() or 0) >= MOST:
                raise AccountError(f"there are {MOST} bots already")
            connection.execute(
                insert(BOTS).values(
                    zone=zone,
                    name=name,
                    digest=digest_of(token),
                    account=by.account,
                    message_rate=message_rate,
                    connections=connections,
                    created_us=now,
                    expires_us=now + lasts_us,
                )
            )
            entry = by.entry("bot_add", bot=name, rate=message_rate, until_us=now + lasts_us)
            self._audit.add(connection, entry)

        await self._store.write(change)
        return token

    async def remove(self, by: Identity, name: str) -> None:
        """Remove a bot: its token opens nothing from now on. Who has come in by it stays.

        Raises
        ------
        AccountError
            There is none of that name.
        StoreError
            The store cannot be written.
        """
        zone = self._store.zone

        def change(connection: Connection) -> None:
            chosen = delete(BOTS).where(BOTS.c.zone == zone, BOTS.c.name == name)
            if not connection.execute(chosen).rowcount:
                raise AccountError(f"there is no bot {name!r}", "unknown")
            self._audit.add(connection, by.entry("bot_remove", bot=name))

        await self._store.write(change)

    async def list(self) -> list[Bot]:
        """All bots, by name.

        Raises
        ------
        StoreError
            The store cannot be read.
        """
        query = _facts().where(BOTS.c.zone == self._store.zone).order_by(BOTS.c.name)
        found = await self._store.read(lambda connection: connection.execute(query).all())
        return [Bot(*row) for row in found]

    async def of(self, token: str) -> Bot | None:
        """Return the bot whose token this is; None for one that opens nothing.

        Raises
        ------
        StoreError
            The store cannot be read.
        """
        query = _facts().where(
            BOTS.c.zone == self._store.zone,
            BOTS.c.digest == digest_of(token),
            BOTS.c.expires_us > self._clock_us(),
        )
        found = await self._store.read(lambda connection: connection.execute(query).first())
        return None if found is None else Bot(*found)


def _facts() -> Select[Any]:
    return select(*(BOTS.c[name] for name in Bot.__dataclass_fields__))

"""Invitations to a closed world: links with an end date and a number of uses."""

import secrets
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from sqlalchemy import Connection, delete, func, insert, select, update

from esplanade.server.accounts.identity import AccountError, Identity, digest_of, new_secret
from esplanade.server.audit.log import AuditLog, now_us
from esplanade.server.store.store import Store
from esplanade.server.store.tables import INVITATIONS

MOST: Final = 1000
"""No more invitations are kept; those that are over for a month are forgotten first."""
MOST_USES: Final = 10_000
LONGEST_US: Final = 366 * 24 * 3600 * 10**6
_KEPT_US: Final = 30 * 24 * 3600 * 10**6


@dataclass(frozen=True, slots=True)
class Invitation:
    """The facts that are kept of an invitation; its secret is not."""

    id: str
    label: str | None
    account: str | None
    """The operator who has made it."""
    uses: int
    """The number of people whom it lets in."""
    used: int
    created_us: int
    expires_us: int
    revoked_us: int | None


class Invitations:
    """Makes invitations, and lets people in by them."""

    def __init__(self, store: Store, audit: AuditLog, clock_us: Callable[[], int] = now_us) -> None:
        self._store = store
        self._audit = audit
        self._clock_us = clock_us

    async def add(
        self, by: Identity, *, label: str | None, uses: int, lasts_us: int
    ) -> tuple[str, str]:
        """Make an invitation; returns its id, and its secret this once.

        Raises
        ------
        AccountError
            It would last too long or be for too many, or there are too many of them.
        StoreError
            The store cannot be written.
        """
        if not (0 < lasts_us <= LONGEST_US and 0 < uses <= MOST_USES):
            raise AccountError(f"an invitation is for up to {MOST_USES} people and 366 days")
        zone, now, secret, id_ = self._store.zone, self._clock_us(), new_secret(), _new_id()

        def change(connection: Connection) -> None:
            connection.execute(
                delete(INVITATIONS).where(
                    INVITATIONS.c.zone == zone, INVITATIONS.c.expires_us < now - _KEPT_US
                )
            )
            count = select(func.count()).where(INVITATIONS.c.zone == zone)
            if (connection.execute(count).scalar() or 0) >= MOST:
                raise AccountError(f"there are {MOST} invitations already")
            values = {"id": id_, "digest": digest_of(secret), "label": label, "uses": uses}
            connection.execute(
                insert(INVITATIONS).values(
                    zone=zone,
                    account=by.account,
                    used=0,
                    created_us=now,
                    expires_us=now + lasts_us,
                    **values,
                )
            )
            entry = by.entry("invitation_add", id=id_, uses=uses, until_us=now + lasts_us)
            self._audit.add(connection, entry)

        await self._store.write(change)
        return id_, secret

    async def revoke(self, by: Identity, id_: str) -> None:
        """Let nobody else in by an invitation; who has come in stays.

        Raises
        ------
        AccountError
            There is none with this id, or it is revoked already.
        StoreError
            The store cannot be written.
        """
        zone = self._store.zone

        def change(connection: Connection) -> None:
            revoked = connection.execute(
                update(INVITATIONS)
                .where(
                    INVITATIONS.c.zone == zone,
                    INVITATIONS.c.id == id_,
                    INVITATIONS.c.revoked_us.is_(None),
                )
                .values(revoked_us=self._clock_us())
            )
            if not revoked.rowcount:
                raise AccountError(f"there is no invitation {id_!r} to revoke", "unknown")
            self._audit.add(connection, by.entry("invitation_revoke", id=id_))

        await self._store.write(change)

    async def list(self) -> list[Invitation]:
        """All invitations, the newest first.

        Raises
        ------
        StoreError
            The store cannot be read.
        """
        query = (
            select(*(INVITATIONS.c[name] for name in Invitation.__dataclass_fields__))
            .where(INVITATIONS.c.zone == self._store.zone)
            .order_by(INVITATIONS.c.created_us.desc(), INVITATIONS.c.id)
        )
        found = await self._store.read(lambda connection: connection.execute(query).all())
        return [Invitation(*row) for row in found]

    async def use(self, secret: str) -> str | None:
        """Let one more person in; the id of the invitation, or None if it is not good.

        Raises
        ------
        StoreError
            The store cannot be written.
        """
        zone, digest, now = self._store.zone, digest_of(secret), self._clock_us()
        chosen = (INVITATIONS.c.zone == zone, INVITATIONS.c.digest == digest)
        good = (
            INVITATIONS.c.revoked_us.is_(None),
            INVITATIONS.c.expires_us > now,
            INVITATIONS.c.used < INVITATIONS.c.uses,
        )

        def find(connection: Connection) -> str | None:
            found = connection.execute(select(INVITATIONS.c.id).where(*chosen, *good)).scalar()
            return None if found is None else str(found)

        def change(connection: Connection) -> str | None:
            used = update(INVITATIONS).where(*chosen, *good).values(used=INVITATIONS.c.used + 1)
            found = find(connection)
            return found if connection.execute(used).rowcount else None

        if await self._store.read(find) is None:  # a stranger who guesses costs no write
            return None
        return await self._store.write(change)

    async def give_back(self, id_: str) -> None:
        """Take a use back: the person did not come in after all.

        Raises
        ------
        StoreError
            The store cannot be written.
        """
        taken = (
            update(INVITATIONS)
            .where(
                INVITATIONS.c.zone == self._store.zone,
                INVITATIONS.c.id == id_,
                INVITATIONS.c.used > 0,
            )
            .values(used=INVITATIONS.c.used - 1)
        )
        await self._store.write(lambda connection: connection.execute(taken).rowcount)


def _new_id() -> str:
    return secrets.token_hex(6)

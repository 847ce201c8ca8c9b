"""Tokens of scripts: each has a name, some of its account's rights, and a last day."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

from sqlalchemy import Connection, func, insert, select, update

from esplanade.server.accounts.directory import role_of
from esplanade.server.accounts.identity import (
    AccountError,
    Identity,
    check_reach,
    checked_name,
    digest_of,
    new_secret,
)
from esplanade.server.accounts.rights import ROLES, Rights, as_text, of_text
from esplanade.server.audit.log import AuditLog, now_us
from esplanade.server.store.store import Store
from esplanade.server.store.tables import ACCOUNTS, TOKENS

PREFIX: Final = "esplanade_"
"""Tokens begin with this, so that one that has slipped into a text is found."""
DAY_US: Final = 24 * 3600 * 10**6
LONGEST_US: Final = 366 * DAY_US
"""No token lasts longer."""
NOTED_US: Final = 60 * 10**6
"""That a token is used is written down once a minute at most."""
MOST: Final = 100
"""An account may have had so many tokens."""


@dataclass(frozen=True, slots=True)
class Token:
    """The facts that are kept of a token; the token itself is not."""

    account: str
    name: str
    rights: Rights
    """The rights of the token, as far as its account has them."""
    created_us: int
    expires_us: int
    used_us: int | None
    revoked_us: int | None

    def is_usable(self, now_us: int) -> bool:
        """Whether it opens anything at this moment."""
        return self.revoked_us is None and self.expires_us > now_us


class Tokens:
    """The tokens of all accounts. `by` is always the one who asks for a change."""

    def __init__(self, store: Store, audit: AuditLog, clock_us: Callable[[], int] = now_us) -> None:
        self._store = store
        self._audit = audit
        self._clock_us = clock_us

    async def add(
        self,
        by: Identity,
        account: str,
        name: str,
        *,
        rights: Rights | None = None,
        lasts_us: int = 90 * DAY_US,
    ) -> str:
        """Make a token; it is returned this once. Without `rights` it has all of its account's.

        Raises
        ------
        AccountError
            The name cannot be had, a right is not the account's, it would last too long, or there
            is no such account.
        StoreError
            The store cannot be written.
        """
        return await self._store.write(
            lambda connection: self.add_within(
                connection, by, account, name, rights=rights, lasts_us=lasts_us
            )
        )

    def add_within(
        self,
        connection: Connection,
        by: Identity,
        account: str,
        name: str,
        *,
        rights: Rights | None = None,
        lasts_us: int = 90 * DAY_US,
    ) -> str:
        """Make a token together with what else a write of the store changes; see `add`."""
        zone, now = self._store.zone, self._clock_us()
        checked_name(name)
        if not 0 < lasts_us <= LONGEST_US:
            raise AccountError(f"a token lasts up to {LONGEST_US // DAY_US} days")
        role = role_of(connection, zone, account)
        of_role = ROLES.get(role, frozenset())
        surplus = (rights or frozenset()) - of_role
        if surplus:
            raise AccountError(f"the role {role} does not have the right {as_text(surplus)}")
        granted = of_role if rights is None else rights
        check_reach(by, granted)
        if not granted:
            raise AccountError("a token needs a right at least")
        _check_free(connection, zone, account, name)
        token = new_secret(PREFIX)
        connection.execute(
            insert(TOKENS).values(
                zone=zone,
                digest=digest_of(token),
                account=account,
                name=name,
                rights=as_text(granted),
                created_us=now,
                expires_us=now + lasts_us,
            )
        )
        entry = by.entry(
            "token_add",
            person=account,
            token=name,
            rights=as_text(granted),
            until_us=now + lasts_us,
        )
        self._audit.add(connection, entry)
        return token

    async def revoke(self, by: Identity, account: str, name: str) -> None:
        """Make a token useless from now on.

        Raises
        ------
        AccountError
            There is none of that name, or it is revoked already.
        StoreError
            The store cannot be written.
        """
        zone = self._store.zone
        chosen = (TOKENS.c.zone == zone, TOKENS.c.account == account, TOKENS.c.name == name)

        def change(connection: Connection) -> None:
            check_reach(by, ROLES.get(role_of(connection, zone, account), frozenset()))
            revoked = connection.execute(
                update(TOKENS)
                .where(*chosen, TOKENS.c.revoked_us.is_(None))
                .values(revoked_us=self._clock_us())
            )
            if not revoked.rowcount:
                found = connection.execute(select(TOKENS.c.name).where(*chosen)).first()
                why = "has no token" if found is None else "has revoked already its token"
                raise AccountError(f"the account {account!r} {why} {name!r}", "unknown_token")
            self._audit.add(connection, by.entry("token_revoke", person=account, token=name))

        await self._store.write(change)

    async def list(self, account: str | None = None) -> list[Token]:
        """All tokens, or those of one account, by account and name; revoked ones too.

        Raises
        ------
        AccountError
            There is no such account.
        StoreError
            The store cannot be read.
        """
        zone = self._store.zone
        query = select(*(TOKENS.c[name] for name in Token.__dataclass_fields__)).where(
            TOKENS.c.zone == zone
        )
        if account is not None:
            query = query.where(TOKENS.c.account == account)

        def find(connection: Connection) -> list[Token]:
            if account is not None:
                role_of(connection, zone, account)
            found = connection.execute(query.order_by(TOKENS.c.account, TOKENS.c.name)).mappings()
            return [Token(**{**row, "rights": of_text(row["rights"])}) for row in found]

        return await self._store.read(find)

    async def identity(self, token: str, address: str | None = None) -> Identity | None:
        """Return the identity that a token stands for; None for one that opens nothing.

        Its rights are those that were granted to it, as far as its account still has them.

        Raises
        ------
        StoreError
            The store cannot be used.
        """
        zone, digest, now = self._store.zone, digest_of(token), self._clock_us()
        query = (
            select(TOKENS, ACCOUNTS.c.role)
            .join(ACCOUNTS, (ACCOUNTS.c.zone == zone) & (ACCOUNTS.c.name == TOKENS.c.account))
            .where(
                TOKENS.c.zone == zone,
                TOKENS.c.digest == digest,
                TOKENS.c.revoked_us.is_(None),
                TOKENS.c.expires_us > now,
            )
        )
        found = await self._store.read(lambda connection: connection.execute(query).first())
        if found is None:
            return None
        if found.used_us is None or now - found.used_us >= NOTED_US:
            await self._store.write(
                lambda connection: _note_use(connection, zone, digest, found.account, now)
            )
        return Identity(
            account=found.account,
            role=found.role,
            rights=of_text(found.rights) & ROLES.get(found.role, frozenset()),
            via=f"token {found.name}",
            address=address,
        )


def _check_free(connection: Connection, zone: str, account: str, name: str) -> None:
    query = select(func.count()).where(TOKENS.c.zone == zone, TOKENS.c.account == account)
    if connection.execute(query.where(TOKENS.c.name == name)).scalar():
        text = f"the account {account!r} has had a token {name!r} already"
        raise AccountError(text, "taken")
    if (connection.execute(query).scalar() or 0) >= MOST:
        raise AccountError(f"the account {account!r} has had {MOST} tokens already")


def _note_use(connection: Connection, zone: str, digest: str, account: str, now: int) -> None:
    connection.execute(
        update(TOKENS).where(TOKENS.c.zone == zone, TOKENS.c.digest == digest).values(used_us=now)
    )
    connection.execute(
        update(ACCOUNTS)
        .where(ACCOUNTS.c.zone == zone, ACCOUNTS.c.name == account)
        .values(seen_us=now)
    )

"""The accounts: added, changed, removed and listed, each change with its row in the audit."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final

from sqlalchemy import Connection, delete, func, insert, select, update

from esplanade.server.accounts.identity import (
    MACHINE,
    AccountError,
    Identity,
    check_reach,
    checked_name,
    checked_role,
)
from esplanade.server.accounts.passwords import Passwords
from esplanade.server.accounts.rights import ROLES, Right
from esplanade.server.audit.log import AuditLog, now_us
from esplanade.server.store.store import Result, Store
from esplanade.server.store.tables import ACCOUNTS, SESSIONS, TOKENS

MOST: Final = 1000
"""A zone has no more accounts."""


@dataclass(frozen=True, slots=True)
class Account:
    """One account."""

    name: str
    role: str
    has_password: bool
    tokens: int
    """Tokens of scripts that are not revoked and not out of date."""
    created_us: int
    seen_us: int | None
    """When it last logged in or a token of it was used; None if never."""


class Directory:
    """The accounts of a store. `by` is always the one who asks for a change."""

    def __init__(
        self,
        store: Store,
        audit: AuditLog,
        passwords: Passwords,
        clock_us: Callable[[], int] = now_us,
    ) -> None:
        self._store = store
        self._audit = audit
        self._passwords = passwords
        self._clock_us = clock_us

    async def add(self, by: Identity, name: str, role: str, password: str | None) -> None:
        """Add an account; without a password it comes in by tokens only.

        Raises
        ------
        AccountError
            Name, role or password cannot be had, or there is an account of that name.
        StoreError
            The store cannot be written.
        """
        await self.add_with(lambda _: None, by, name, role, password)

    async def add_with(
        self,
        also: Callable[[Connection], Result],
        by: Identity,
        name: str,
        role: str,
        password: str | None = None,
    ) -> Result:
        """Add an account, and do something else in the same write of the store; see `add`.

        It returns what that returns. If that raises, there is no account either.
        """
        checked_name(name)
        checked_role(role)
        check_reach(by, ROLES[role])
        kept = None if password is None else await self._passwords.hash(password)
        entry = by.entry("user_add", person=name, role=role, password=kept is not None)

        def change(connection: Connection) -> Result:
            insert_account(connection, self._store.zone, name, role, kept, self._clock_us())
            self._audit.add(connection, entry)
            return also(connection)

        return await self._store.write(change)

    async def remove(self, by: Identity, name: str) -> None:
        """Remove an account with its sessions and tokens.

        Raises
        ------
        AccountError
            There is none of that name.
        StoreError
            The store cannot be written.
        """
        zone = self._store.zone

        def change(connection: Connection) -> None:
            check_changeable(connection, zone, by, name, stays_admin=False)
            remove_account(connection, zone, name)
            self._audit.add(connection, by.entry("user_remove", person=name))

        await self._store.write(change)

    async def set_role(self, by: Identity, name: str, role: str) -> str:
        """Give an account another role, at once for its sessions and tokens too; returns the one
        that it had.

        Raises
        ------
        AccountError
            There is no such role, or no account of that name.
        StoreError
            The store cannot be written.
        """
        checked_role(role)

        check_reach(by, ROLES[role])

        def change(connection: Connection) -> str:
            stays_admin = Right.ACCOUNTS in ROLES[role]
            before = check_changeable(
                connection, self._store.zone, by, name, stays_admin=stays_admin
            )
            _set(connection, self._store.zone, name, role=role)
            entry = by.entry("user_role", person=name, before=before, after=role)
            self._audit.add(connection, entry)
            return before

        return await self._store.write(change)

    async def set_password(self, by: Identity, name: str, password: str) -> None:
        """Give an account another password; all its sessions end, its tokens stay.

        Raises
        ------
        AccountError
            The password cannot be had, or there is no account of that name.
        StoreError
            The store cannot be written.
        """
        kept = await self._passwords.hash(password)

        def change(connection: Connection) -> None:
            zone = self._store.zone
            check_reach(by, ROLES.get(role_of(connection, zone, name), frozenset()))
            _set(connection, zone, name, password_hash=kept)
            connection.execute(
                delete(SESSIONS).where(SESSIONS.c.zone == zone, SESSIONS.c.account == name)
            )
            self._audit.add(connection, by.entry("user_password", person=name))

        await self._store.write(change)

    async def again(self, before: Identity) -> Identity | None:
        """Return an identity with the role and rights that its account has now; None if there is
        no such account any more.

        Raises
        ------
        StoreError
            The store cannot be read.
        """
        zone, name = self._store.zone, before.account
        query = select(ACCOUNTS.c.role).where(ACCOUNTS.c.zone == zone, ACCOUNTS.c.name == name)
        role = await self._store.read(lambda connection: connection.execute(query).scalar())
        if role is None:
            return None
        return replace(before, role=role, rights=ROLES.get(role, frozenset()))

    async def list(self) -> list[Account]:
        """All accounts, by name.

        Raises
        ------
        StoreError
            The store cannot be read.
        """
        zone, now = self._store.zone, self._clock_us()
        usable = (
            select(func.count())
            .where(
                TOKENS.c.zone == zone,
                TOKENS.c.account == ACCOUNTS.c.name,
                TOKENS.c.revoked_us.is_(None),
                TOKENS.c.expires_us > now,
            )
            .scalar_subquery()
        )
        query = (
            select(
                ACCOUNTS.c.name,
                ACCOUNTS.c.role,
                ACCOUNTS.c.password_hash.is_not(None),
                usable,
                ACCOUNTS.c.created_us,
                ACCOUNTS.c.seen_us,
            )
            .where(ACCOUNTS.c.zone == zone)
            .order_by(ACCOUNTS.c.name)
        )
        found = await self._store.read(lambda connection: connection.execute(query).all())
        return [
            Account(name, role, bool(has_password), tokens, created_us, seen_us)
            for name, role, has_password, tokens, created_us, seen_us in found
        ]


def role_of(connection: Connection, zone: str, name: str) -> str:
    """The role of an account.

    Raises
    ------
    AccountError
        There is none of that name.
    """
    query = select(ACCOUNTS.c.role).where(ACCOUNTS.c.zone == zone, ACCOUNTS.c.name == name)
    found = connection.execute(query).scalar()
    if found is None:
        raise AccountError(f"there is no account {name!r}", "unknown_account")
    return str(found)


def check_changeable(
    connection: Connection, zone: str, by: Identity, name: str, *, stays_admin: bool
) -> str:
    """The role of an account that may be removed, or get another role.

    Raises
    ------
    AccountError
        It has rights beyond those of the one who asks; or it is the last that may see to accounts,
        and would no longer be. Whoever is on the machine itself may do that: they can make another.
    """
    role = role_of(connection, zone, name)
    check_reach(by, ROLES.get(role, frozenset()))
    admins = [known for known, rights in ROLES.items() if Right.ACCOUNTS in rights]
    if role in admins and not stays_admin and by != MACHINE:
        query = select(func.count()).where(
            ACCOUNTS.c.zone == zone, ACCOUNTS.c.role.in_(admins), ACCOUNTS.c.name != name
        )
        if not connection.execute(query).scalar():
            text = f"{name!r} is the last who may see to accounts; let another one first"
            raise AccountError(text, "last_admin")
    return role


def insert_account(
    connection: Connection, zone: str, name: str, role: str, kept: str | None, at_us: int
) -> None:
    """Add an account, within a write of the store.

    Raises
    ------
    AccountError
        There is one of that name, or there are too many.
    """
    query = select(func.count()).where(ACCOUNTS.c.zone == zone)
    if connection.execute(query.where(ACCOUNTS.c.name == name)).scalar():
        raise AccountError(f"there is an account {name!r} already", "taken")
    if (connection.execute(query).scalar() or 0) >= MOST:
        raise AccountError(f"there are {MOST} accounts already; remove one first")
    values = {"zone": zone, "name": name, "role": role, "password_hash": kept}
    connection.execute(insert(ACCOUNTS).values(created_us=at_us, **values))


def remove_account(connection: Connection, zone: str, name: str) -> None:
    """Remove an account with its sessions and tokens, within a write of the store.

    Raises
    ------
    AccountError
        There is none of that name.
    """
    role_of(connection, zone, name)
    connection.execute(delete(ACCOUNTS).where(ACCOUNTS.c.zone == zone, ACCOUNTS.c.name == name))


def _set(connection: Connection, zone: str, name: str, **values: object) -> None:
    connection.execute(
        update(ACCOUNTS).where(ACCOUNTS.c.zone == zone, ACCOUNTS.c.name == name).values(values)
    )

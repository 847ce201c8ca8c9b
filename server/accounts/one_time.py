"""Tokens that are used once: the link of the first start, and passes to a seat."""

from collections.abc import Callable
from typing import Final

from sqlalchemy import Connection, delete, func, insert, select

from esplanade.server.accounts.directory import insert_account, role_of
from esplanade.server.accounts.identity import (
    AccountError,
    Identity,
    checked_name,
    digest_of,
    new_secret,
)
from esplanade.server.accounts.passwords import Passwords
from esplanade.server.accounts.rights import ROLES
from esplanade.server.audit.entries import Entry
from esplanade.server.audit.log import AuditLog, now_us
from esplanade.server.store.store import Store
from esplanade.server.store.tables import ACCOUNTS, ONE_TIME

LINK_US: Final = 600 * 10**6
"""The link of the first start is good for 10 minutes."""
PASS_US: Final = 60 * 10**6
"""A pass to a seat is good for 60 seconds."""
MOST: Final = 1000
"""No more tokens may wait for their use."""
_LINK: Final = "link"
_PASS: Final = "pass"  # noqa: S105 (it is the name of the purpose)


class OneTime:
    """Makes tokens that are used once, and takes them."""

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

    async def first_link(self) -> str | None:
        """A token for the first account, in place of any that was made before; None where there
        are accounts already. There is no default password.

        Raises
        ------
        StoreError
            The store cannot be written.
        """
        zone, token = self._store.zone, new_secret()

        def change(connection: Connection) -> str | None:
            if _accounts(connection, zone):
                return None
            connection.execute(
                delete(ONE_TIME).where(ONE_TIME.c.zone == zone, ONE_TIME.c.purpose == _LINK)
            )
            self._put(connection, token, _LINK, None, LINK_US)
            self._audit.add(connection, Entry(command="first_link"))
            return token

        return await self._store.write(change)

    async def is_first(self) -> bool:
        """Whether there is no account yet.

        Raises
        ------
        StoreError
            The store cannot be read.
        """
        return not await self._store.read(
            lambda connection: _accounts(connection, self._store.zone)
        )

    async def add_first(self, token: str, name: str, password: str, address: str) -> None:
        """Make the first account, an admin, with the token of the link.

        Raises
        ------
        AccountError
            The token is not good, or there is an account already, or name or password cannot be
            had; a token that was good still is.
        StoreError
            The store cannot be written.
        """
        zone = self._store.zone
        checked_name(name)

        def is_good(connection: Connection) -> bool:
            return _find(connection, zone, token, _LINK, self._clock_us()) is not None

        if not await self._store.read(is_good):  # before anything dear is done for a stranger
            raise AccountError(_NO_LINK, "link")
        kept = await self._passwords.hash(password)

        def change(connection: Connection) -> None:
            if _accounts(connection, zone):
                raise AccountError("there is an account already: log in", "link")
            if not self._take(connection, token, _LINK)[0]:
                raise AccountError(_NO_LINK, "link")
            insert_account(connection, zone, name, "admin", kept, self._clock_us())
            entry = Entry(
                command="user_add",
                address=address,
                person=name,
                body={"via": "first link", "role": "admin", "password": True},
            )
            self._audit.add(connection, entry)

        await self._store.write(change)

    async def seat_pass(self, by: Identity) -> str:
        """A pass that gives the seat of a person the rights of an account that walks in itself.

        Raises
        ------
        AccountError
            `by` has not come in by a session, or too many passes wait.
        StoreError
            The store cannot be written.
        """
        account, token = by.account, new_secret()
        if account is None or by.via != "session":  # a token may have fewer rights than its account
            raise AccountError("only who is logged in has a pass to a seat")

        def change(connection: Connection) -> None:
            role_of(connection, self._store.zone, account)
            self._put(connection, token, _PASS, account, PASS_US)
            self._audit.add(connection, by.entry("seat_pass"))

        await self._store.write(change)
        return token

    async def take_pass(self, token: str, address: str | None = None) -> Identity | None:
        """Use a pass up, and say who it stands for; None if it is not good, or no longer.

        Raises
        ------
        StoreError
            The store cannot be written.
        """
        zone = self._store.zone

        def change(connection: Connection) -> Identity | None:
            good, account = self._take(connection, token, _PASS)
            if not good or account is None:
                return None
            role = role_of(connection, zone, account)
            rights = ROLES.get(role, frozenset())
            found = Identity(account=account, role=role, rights=rights, via="pass", address=address)
            self._audit.add(connection, found.entry("take_pass"))
            return found

        return await self._store.write(change)

    def _put(
        self, connection: Connection, token: str, purpose: str, account: str | None, lasts_us: int
    ) -> None:
        zone, now = self._store.zone, self._clock_us()
        connection.execute(
            delete(ONE_TIME).where(ONE_TIME.c.zone == zone, ONE_TIME.c.expires_us <= now)
        )
        count = select(func.count()).where(ONE_TIME.c.zone == zone)
        if (connection.execute(count).scalar() or 0) >= MOST:
            raise AccountError(f"{MOST} passes wait to be used; try again in a minute")
        connection.execute(
            insert(ONE_TIME).values(
                zone=zone,
                digest=digest_of(token),
                purpose=purpose,
                account=account,
                expires_us=now + lasts_us,
            )
        )

    def _take(self, connection: Connection, token: str, purpose: str) -> tuple[bool, str | None]:
        zone, now = self._store.zone, self._clock_us()
        found = _find(connection, zone, token, purpose, now)
        if found is None:
            return False, None
        connection.execute(
            delete(ONE_TIME).where(ONE_TIME.c.zone == zone, ONE_TIME.c.digest == digest_of(token))
        )
        return True, found[0]


_NO_LINK: Final = (
    "this link is not good, or no longer: the server makes another one when it starts, and "
    "`esplanade op user add` needs none"
)


def _find(
    connection: Connection, zone: str, token: str, purpose: str, now_us: int
) -> tuple[str | None] | None:
    """The account of a token that is good, in a tuple; None if it is not."""
    query = select(ONE_TIME.c.account).where(
        ONE_TIME.c.zone == zone,
        ONE_TIME.c.digest == digest_of(token),
        ONE_TIME.c.purpose == purpose,
        ONE_TIME.c.expires_us > now_us,
    )
    found = connection.execute(query).first()
    return None if found is None else (found[0],)


def _accounts(connection: Connection, zone: str) -> int:
    query = select(func.count()).select_from(ACCOUNTS).where(ACCOUNTS.c.zone == zone)
    return connection.execute(query).scalar() or 0

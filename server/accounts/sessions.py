"""Sessions of operators: logging in with a password, and the token that stands for it after."""

from collections.abc import Callable
from typing import Final

from sqlalchemy import ColumnElement, Connection, delete, insert, select, update

from esplanade.server.accounts.identity import (
    AccountError,
    Identity,
    digest_of,
    is_name,
    new_secret,
)
from esplanade.server.accounts.lockout import Lockout
from esplanade.server.accounts.passwords import Passwords
from esplanade.server.accounts.rights import ROLES
from esplanade.server.audit.entries import Entry
from esplanade.server.audit.log import AuditLog, now_us
from esplanade.server.store.store import Store
from esplanade.server.store.tables import ACCOUNTS, SESSIONS

LASTS_US: Final = 12 * 3600 * 10**6
"""A session ends after 12 hours."""
IDLE_US: Final = 30 * 60 * 10**6
"""It ends earlier when nothing was asked in it for 30 minutes."""
NOTED_US: Final = 60 * 10**6
"""That a session is used is written down once a minute at most."""
MOST: Final = 20
"""An account has so many sessions at most: the one that was not used for longest ends."""


class WrongPasswordError(AccountError):
    """Name and password do not belong together."""

    code = "wrong_password"


class Sessions:
    """Logs operators in and out. `log_in` is to be called on one event loop only."""

    def __init__(
        self,
        store: Store,
        audit: AuditLog,
        passwords: Passwords,
        lockout: Lockout,
        clock_us: Callable[[], int] = now_us,
    ) -> None:
        self._store = store
        self._audit = audit
        self._passwords = passwords
        self._lockout = lockout
        self._clock_us = clock_us

    async def log_in(self, name: str, password: str, address: str) -> str:
        """Compare the password and begin a session; returns its token, which is kept nowhere.

        Raises
        ------
        LockedOutError
            The password was not looked at, because too many from this address or for this name
            were wrong.
        WrongPasswordError
            It is wrong, or there is no such account; the audit has it.
        AccountError
            Too many passwords are being compared.
        StoreError
            The store cannot be used.
        """
        role, kept = await self._compare(name, password, address)
        better = await self._passwords.hash(password) if self._is_outdated(kept) else None
        return await self._begin(name, role, kept, better, address)

    async def confirm(self, name: str, password: str, address: str) -> None:
        """Compare the password of somebody who is logged in already, before it becomes another.

        Raises
        ------
        LockedOutError, WrongPasswordError, AccountError, StoreError
            As with `log_in`.
        """
        await self._compare(name, password, address)

    async def _compare(self, name: str, password: str, address: str) -> tuple[str, str | None]:
        """The role and the hash of an account whose password this is."""
        zone, counted = self._store.zone, name if is_name(name) else ""
        self._lockout.take(counted, address, self._clock_us() / 1e6)
        query = select(ACCOUNTS.c.role, ACCOUNTS.c.password_hash).where(
            ACCOUNTS.c.zone == zone, ACCOUNTS.c.name == name
        )
        account = await self._store.read(lambda connection: connection.execute(query).first())
        kept = None if account is None else account.password_hash
        if account is None or not await self._passwords.fits(password, kept):
            if account is None:
                await self._passwords.fits(password, None)
            await self._audit.record(_refusal(name if account is not None else None, address))
            raise WrongPasswordError("name and password do not belong together")
        self._lockout.forgive(counted, address, self._clock_us() / 1e6)
        return account.role, kept

    async def identity(
        self, token: str, address: str | None = None, *, used: bool = True
    ) -> Identity | None:
        """Return the identity that the token of a session stands for; None once it has ended.

        Role and rights are those that the account has now. Without `used` the session is only
        looked at, and ends as if nothing had been asked.

        Raises
        ------
        StoreError
            The store cannot be used.
        """
        zone, digest, now = self._store.zone, digest_of(token), self._clock_us()
        query = (
            select(ACCOUNTS.c.name, ACCOUNTS.c.role, SESSIONS.c.used_us)
            .join(ACCOUNTS, (ACCOUNTS.c.zone == zone) & (ACCOUNTS.c.name == SESSIONS.c.account))
            .where(SESSIONS.c.zone == zone, SESSIONS.c.digest == digest, *_alive(now))
        )
        found = await self._store.read(lambda connection: connection.execute(query).first())
        if found is None:
            return None
        if used and now - found.used_us >= NOTED_US:
            noted = (
                update(SESSIONS)
                .where(SESSIONS.c.zone == zone, SESSIONS.c.digest == digest)
                .values(used_us=now)
            )
            await self._store.write(lambda connection: connection.execute(noted).rowcount)
        return Identity(
            account=found.name,
            role=found.role,
            rights=ROLES.get(found.role, frozenset()),
            via="session",
            address=address,
        )

    async def log_out(self, by: Identity, token: str) -> None:
        """End a session; one that has ended already stays so.

        Raises
        ------
        StoreError
            The store cannot be written.
        """
        zone, digest = self._store.zone, digest_of(token)

        def change(connection: Connection) -> None:
            ended = connection.execute(
                delete(SESSIONS).where(SESSIONS.c.zone == zone, SESSIONS.c.digest == digest)
            )
            if ended.rowcount:
                self._audit.add(connection, by.entry("log_out"))

        await self._store.write(change)

    def _is_outdated(self, kept: str | None) -> bool:
        return kept is not None and self._passwords.is_outdated(kept)

    async def _begin(
        self, name: str, role: str, compared: str | None, better: str | None, address: str
    ) -> str:
        token, zone, now = new_secret(), self._store.zone, self._clock_us()

        def change(connection: Connection) -> None:
            values: dict[str, object] = {"seen_us": now}
            if better is not None:
                values["password_hash"] = better
            same = connection.execute(
                update(ACCOUNTS)
                .where(
                    ACCOUNTS.c.zone == zone,
                    ACCOUNTS.c.name == name,
                    ACCOUNTS.c.password_hash == compared,
                )
                .values(values)
            )
            if not same.rowcount:  # it was removed, or has another password, since it was compared
                raise WrongPasswordError("name and password do not belong together")
            make_room(connection, zone, name, now)
            connection.execute(
                insert(SESSIONS).values(
                    zone=zone,
                    digest=digest_of(token),
                    account=name,
                    address=address,
                    created_us=now,
                    used_us=now,
                )
            )
            entry = Entry(command="log_in", account=name, role=role, address=address)
            self._audit.add(connection, entry)

        await self._store.write(change)
        return token


def make_room(connection: Connection, zone: str, name: str, now_us: int) -> None:
    """Drop sessions that have ended, and of this account those beyond the most there may be."""
    connection.execute(
        delete(SESSIONS).where(
            SESSIONS.c.zone == zone,
            (SESSIONS.c.created_us <= now_us - LASTS_US) | (SESSIONS.c.used_us <= now_us - IDLE_US),
        )
    )
    surplus = (
        select(SESSIONS.c.digest)
        .where(SESSIONS.c.zone == zone, SESSIONS.c.account == name)
        .order_by(SESSIONS.c.used_us.desc(), SESSIONS.c.created_us.desc())
        .offset(MOST - 1)
    )
    dropped = list(connection.scalars(surplus))
    connection.execute(
        delete(SESSIONS).where(SESSIONS.c.zone == zone, SESSIONS.c.digest.in_(dropped))
    )


def _alive(now_us: int) -> tuple[ColumnElement[bool], ...]:
    return SESSIONS.c.created_us > now_us - LASTS_US, SESSIONS.c.used_us > now_us - IDLE_US


def _refusal(name: str | None, address: str) -> Entry:
    """A wrong password in the audit; a name that nobody has may be a password, and is left out."""
    return Entry(command="log_in", account=name, address=address, outcome="refused")

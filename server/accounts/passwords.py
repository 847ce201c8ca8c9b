"""Passwords: argon2id, in a thread of its own, one after the other."""

import asyncio
import threading
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Final, TypeVar

from argon2 import PasswordHasher
from argon2.exceptions import InvalidHashError, VerificationError

from esplanade.server.accounts.identity import AccountError

Result = TypeVar("Result")

SHORTEST: Final = 12
LONGEST: Final = 256
WAITING: Final = 16
"""No more passwords may wait to be compared; each takes 64 MiB and some 50 ms."""


class PasswordsBusyError(AccountError):
    """Too many passwords wait to be compared."""

    code = "busy"


class Passwords:
    """Hashes passwords and compares them, with the parameters of RFC 9106 for little memory.

    Who gives the name of an account that is not there waits as long as with a wrong password.
    """

    def __init__(self, hasher: PasswordHasher | None = None) -> None:
        self._hasher = hasher or PasswordHasher()
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="passwords")
        self._waiting = threading.BoundedSemaphore(WAITING)
        self._nobodys: str | None = None

    async def hash(self, password: str) -> str:
        """The hash to be kept of a password.

        Raises
        ------
        AccountError
            It is too short or too long.
        PasswordsBusyError
            Too many wait.
        """
        return await self.hash_any(checked_password(password))

    async def hash_any(self, password: str) -> str:
        """The hash of a password of any length, for one that is no account's.

        Raises
        ------
        PasswordsBusyError
            Too many wait.
        """
        return await asyncio.wrap_future(self._submit(lambda: self._hash(password)))

    async def fits(self, password: str, kept: str | None) -> bool:
        """Whether a password is that of a hash; without a hash, none is.

        Raises
        ------
        PasswordsBusyError
            Too many wait.
        """
        return await asyncio.wrap_future(self._submit(lambda: self._compare(password, kept)))

    def is_outdated(self, kept: str) -> bool:
        """Whether a hash was made with other parameters than those of today."""
        return self._hasher.check_needs_rehash(kept)

    def close(self) -> None:
        """End the thread."""
        self._thread.shutdown(cancel_futures=True)

    def _submit(self, work: Callable[[], Result]) -> "Future[Result]":
        if not self._waiting.acquire(blocking=False):
            raise PasswordsBusyError("too many passwords are being compared; try again later")
        done = self._thread.submit(work)
        done.add_done_callback(lambda _: self._waiting.release())
        return done

    def _hash(self, password: str) -> str:
        return self._hasher.hash(_bytes(password))

    def _compare(self, password: str, kept: str | None) -> bool:
        if kept is None:
            self._nobodys = self._nobodys or self._hasher.hash(b"nobody's password")
        try:
            self._hasher.verify(kept or self._nobodys or "", _bytes(password[: LONGEST + 1]))
        except (VerificationError, InvalidHashError):
            return False
        return kept is not None


def checked_password(password: str) -> str:
    """The password, if it may be one.

    Raises
    ------
    AccountError
        It is too short or too long.
    """
    if len(password) < SHORTEST:
        text = f"the password has fewer than {SHORTEST} characters"
        raise AccountError(text, "password_length", shortest=SHORTEST, longest=LONGEST)
    if len(password) > LONGEST:
        text = f"the password has more than {LONGEST} characters"
        raise AccountError(text, "password_length", shortest=SHORTEST, longest=LONGEST)
    return password


def _bytes(password: str) -> bytes:
    return password.encode("utf-8", "surrogatepass")

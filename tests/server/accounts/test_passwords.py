"""Passwords are kept as argon2id, compared one after the other, and a bounded number waits."""

import asyncio
import threading

import pytest
from argon2 import PasswordHasher

from esplanade.server.accounts import passwords
from esplanade.server.accounts.identity import AccountError
from esplanade.server.accounts.passwords import Passwords, PasswordsBusyError
from tests.patience import PATIENCE_S
from tests.server.accounts.conftest import QUICK

PASSWORD = "correct horse battery"


async def test_a_hash_is_argon2id_of_rfc_9106_and_salted() -> None:
    kept = Passwords()
    one, other = await kept.hash(PASSWORD), await kept.hash(PASSWORD)
    kept.close()
    assert one != other
    assert one.startswith("$argon2id$v=19$m=65536,t=3,p=4$")
    assert PASSWORD not in one


async def test_only_the_password_fits() -> None:
    kept = Passwords(QUICK)
    hashed = await kept.hash(PASSWORD)
    assert await kept.fits(PASSWORD, hashed)
    assert not await kept.fits(PASSWORD + "x", hashed)
    assert not await kept.fits("", hashed)
    assert not await kept.fits(PASSWORD, "no hash")
    kept.close()


async def test_without_a_hash_nothing_fits_and_as_much_is_computed() -> None:
    computed = []

    class Counting(PasswordHasher):
        def verify(self, hash: str | bytes, password: str | bytes) -> bool:  # noqa: A002
            computed.append(hash)
            return super().verify(hash, password)

    kept = Passwords(Counting(time_cost=1, memory_cost=8, parallelism=1))
    assert not await kept.fits("nobody's password", None)
    assert len(computed) == 1
    kept.close()


@pytest.mark.parametrize(
    ("password", "why"), [("short", "fewer than 12"), ("x" * 257, "more than 256")]
)
async def test_a_password_has_a_length(password: str, why: str) -> None:
    kept = Passwords(QUICK)
    with pytest.raises(AccountError, match=why):
        await kept.hash(password)
    kept.close()


async def test_what_waits_to_be_compared_is_bounded() -> None:
    held = threading.Event()

    class Held(PasswordHasher):
        def verify(self, hash: str | bytes, password: str | bytes) -> bool:  # noqa: A002
            held.wait(PATIENCE_S)
            return super().verify(hash, password)

    kept = Passwords(Held(time_cost=1, memory_cost=8, parallelism=1))
    hashed = await kept.hash(PASSWORD)
    waiting = [asyncio.create_task(kept.fits(PASSWORD, hashed)) for _ in range(passwords.WAITING)]
    await asyncio.sleep(0)
    with pytest.raises(PasswordsBusyError, match="try again later"):
        await kept.fits(PASSWORD, hashed)
    held.set()
    assert await asyncio.gather(*waiting) == [True] * passwords.WAITING
    assert await kept.fits(PASSWORD, hashed)
    kept.close()

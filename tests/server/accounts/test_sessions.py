"""Sessions: by a password, for a time, with the rights that the account has at each moment."""

import asyncio

import pytest

from esplanade.server.accounts import sessions
from esplanade.server.accounts.identity import MACHINE
from esplanade.server.accounts.lockout import LockedOutError
from esplanade.server.accounts.passwords import Passwords
from esplanade.server.accounts.rights import ROLES
from esplanade.server.accounts.sessions import Sessions, WrongPasswordError
from tests.server.accounts.conftest import Desk

PASSWORD = "correct horse battery"
OTHER = "another horse battery"


@pytest.fixture(autouse=True)
async def _olga(desk: Desk) -> None:
    await desk.directory.add(MACHINE, "olga", "tuner", PASSWORD)


async def test_a_session_stands_for_its_account(desk: Desk) -> None:
    token = await desk.sessions.log_in("olga", PASSWORD, "192.0.2.7")
    found = await desk.sessions.identity(token, "192.0.2.7")
    assert found is not None
    assert (found.account, found.role, found.via) == ("olga", "tuner", "session")
    assert found.rights == ROLES["tuner"]
    assert len(token) == 43  # 256 bits
    assert await desk.sessions.identity(token + "x") is None
    assert await desk.sessions.identity("") is None
    assert (await desk.audited())[1:] == [("log_in", "olga", None, "")]
    (olga,) = await desk.directory.list()
    assert olga.seen_us == desk.clock.now_us


async def test_the_store_has_no_token(desk: Desk) -> None:
    token = await desk.sessions.log_in("olga", PASSWORD, "here")
    if desk.store.location.file is not None:
        for file in desk.store.location.file.parent.iterdir():
            assert token.encode() not in file.read_bytes()


@pytest.mark.parametrize(
    ("name", "password", "kept"),
    [("olga", OTHER, "olga"), ("ann", PASSWORD, None), (PASSWORD, "olga", None), ("", "", None)],
)
async def test_a_wrong_password_is_told_and_audited(
    desk: Desk, name: str, password: str, kept: str | None
) -> None:
    with pytest.raises(WrongPasswordError, match=r"^name and password do not belong together$"):
        await desk.sessions.log_in(name, password, "192.0.2.7")
    assert (await desk.audited())[1:] == [("log_in", kept, None, "refused")]
    assert desk.lockout.wrong == 1


async def test_an_account_without_a_password_cannot_log_in(desk: Desk) -> None:
    await desk.directory.add(MACHINE, "ann", "admin", None)
    for password in ("", "nobody's password"):
        with pytest.raises(WrongPasswordError):
            await desk.sessions.log_in("ann", password, "here")


async def test_guessing_is_slowed_down_for_the_right_password_too(desk: Desk) -> None:
    tries = (desk.sessions.log_in("olga", OTHER, f"a{count}") for count in range(9))
    outcomes = await asyncio.gather(*tries, return_exceptions=True)
    kinds = [type(outcome) for outcome in outcomes]
    assert kinds.count(WrongPasswordError) == 5
    assert kinds.count(LockedOutError) == 4
    with pytest.raises(LockedOutError, match="try again in 60 s"):
        await desk.sessions.log_in("olga", PASSWORD, "here")
    assert [outcome for *_, outcome in await desk.audited()].count("refused") == 5
    desk.clock.go_on(60)
    await desk.sessions.log_in("olga", PASSWORD, "here")


async def test_a_session_ends_when_nothing_is_asked_in_it(desk: Desk) -> None:
    token = await desk.sessions.log_in("olga", PASSWORD, "here")
    for _ in range(4):
        desk.clock.go_on(29 * 60)
        assert await desk.sessions.identity(token) is not None
    desk.clock.go_on(30 * 60)
    assert await desk.sessions.identity(token) is None


async def test_a_session_ends_after_twelve_hours_however_it_is_used(desk: Desk) -> None:
    token = await desk.sessions.log_in("olga", PASSWORD, "here")
    for _ in range(47):
        desk.clock.go_on(15 * 60)
        assert await desk.sessions.identity(token) is not None
    desk.clock.go_on(15 * 60)
    assert await desk.sessions.identity(token) is None


async def test_that_it_is_used_is_written_once_a_minute(desk: Desk) -> None:
    token = await desk.sessions.log_in("olga", PASSWORD, "here")
    before = desk.store.commits
    for _ in range(59):
        desk.clock.go_on(1)
        await desk.sessions.identity(token)
    assert desk.store.commits == before
    desk.clock.go_on(1)
    await desk.sessions.identity(token)
    assert desk.store.commits == before + 1


async def test_another_role_holds_at_once(desk: Desk) -> None:
    token = await desk.sessions.log_in("olga", PASSWORD, "here")
    assert await desk.directory.set_role(MACHINE, "olga", "viewer") == "tuner"
    found = await desk.sessions.identity(token)
    assert found is not None
    assert found.rights == ROLES["viewer"]


async def test_another_password_ends_all_sessions(desk: Desk) -> None:
    token = await desk.sessions.log_in("olga", PASSWORD, "here")
    await desk.directory.set_password(MACHINE, "olga", OTHER)
    assert await desk.sessions.identity(token) is None
    with pytest.raises(WrongPasswordError):
        await desk.sessions.log_in("olga", PASSWORD, "here")
    await desk.sessions.log_in("olga", OTHER, "here")


async def test_a_password_that_changes_while_it_is_compared_opens_nothing(desk: Desk) -> None:
    class Slow(Passwords):
        async def fits(self, password: str, kept: str | None) -> bool:
            fits = await super().fits(password, kept)
            await desk.directory.set_password(MACHINE, "olga", OTHER)
            return fits

    slow = Sessions(desk.store, desk.audit, Slow(), desk.lockout, desk.clock)
    with pytest.raises(WrongPasswordError):
        await slow.log_in("olga", PASSWORD, "here")


async def test_logging_out_ends_one_session(desk: Desk) -> None:
    one = await desk.sessions.log_in("olga", PASSWORD, "here")
    other = await desk.sessions.log_in("olga", PASSWORD, "there")
    by = await desk.sessions.identity(one)
    assert by is not None
    await desk.sessions.log_out(by, one)
    await desk.sessions.log_out(by, one)
    assert await desk.sessions.identity(one) is None
    assert await desk.sessions.identity(other) is not None
    assert [row for row in await desk.audited() if row[0] == "log_out"] == [
        ("log_out", "olga", None, "")
    ]


async def test_an_account_has_a_number_of_sessions(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sessions, "MOST", 3)
    tokens = []
    for _ in range(5):
        desk.clock.go_on(1)
        tokens.append(await desk.sessions.log_in("olga", PASSWORD, "here"))
    alive = [await desk.sessions.identity(token) is not None for token in tokens]
    assert alive == [False, False, True, True, True]


async def test_an_outdated_hash_is_made_anew_at_the_next_log_in(desk: Desk) -> None:
    modern = Passwords()
    newer = Sessions(desk.store, desk.audit, modern, desk.lockout, desk.clock)
    await newer.log_in("olga", PASSWORD, "here")
    hashed: list[bool] = []

    class Noting(Passwords):
        def is_outdated(self, kept: str) -> bool:
            hashed.append(super().is_outdated(kept))
            return hashed[-1]

    again = Sessions(desk.store, desk.audit, Noting(), desk.lockout, desk.clock)
    await again.log_in("olga", PASSWORD, "here")
    assert hashed == [False]
    modern.close()

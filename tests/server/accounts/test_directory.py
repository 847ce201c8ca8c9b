"""Accounts are added, changed and removed; what cannot be changes nothing."""

from collections.abc import Awaitable, Callable

import pytest
from sqlalchemy import Connection

from esplanade.server.accounts import directory as module
from esplanade.server.accounts.identity import MACHINE, AccountError
from tests.server.accounts.conftest import Desk

PASSWORD = "correct horse battery"


async def test_an_account_is_added_and_listed(desk: Desk) -> None:
    await desk.directory.add(MACHINE, "olga", "tuner", PASSWORD)
    await desk.directory.add(MACHINE, "ann", "admin", None)
    ann, olga = await desk.directory.list()
    assert (ann.name, ann.role, ann.has_password, ann.seen_us) == ("ann", "admin", False, None)
    assert (olga.name, olga.role, olga.has_password) == ("olga", "tuner", True)
    assert await desk.audited() == [
        ("user_add", None, "olga", ""),
        ("user_add", None, "ann", ""),
    ]


async def test_the_store_has_no_password(desk: Desk) -> None:
    await desk.directory.add(MACHINE, "olga", "tuner", PASSWORD)
    if desk.store.location.file is not None:
        for file in desk.store.location.file.parent.iterdir():
            assert PASSWORD.encode() not in file.read_bytes()


@pytest.mark.parametrize(
    ("wish", "why"),
    [
        (lambda d: d.add(MACHINE, "olga", "viewer", None), "is an account 'olga' already"),
        (lambda d: d.add(MACHINE, "Olga", "viewer", None), "'Olga' is no name of 1 to 32 small"),
        (lambda d: d.add(MACHINE, "", "viewer", None), "'' is no name"),
        (lambda d: d.add(MACHINE, "ann\n", "viewer", None), "is no name"),
        (lambda d: d.add(MACHINE, "а", "viewer", None), "is no name"),
        (lambda d: d.add(MACHINE, "ann", "king", None), "'king' is no role; there are viewer, mod"),
        (lambda d: d.add(MACHINE, "ann", "viewer", "short"), "fewer than 12"),
        (lambda d: d.remove(MACHINE, "ann"), "there is no account 'ann'"),
        (lambda d: d.set_role(MACHINE, "ann", "admin"), "there is no account 'ann'"),
        (lambda d: d.set_role(MACHINE, "olga", "king"), "is no role"),
        (lambda d: d.set_password(MACHINE, "ann", PASSWORD), "there is no account 'ann'"),
        (lambda d: d.set_password(MACHINE, "olga", "short"), "fewer than 12"),
    ],
)
async def test_what_cannot_be_changes_nothing(
    desk: Desk, wish: Callable[[module.Directory], Awaitable[object]], why: str
) -> None:
    await desk.directory.add(MACHINE, "olga", "tuner", PASSWORD)
    before = await desk.directory.list()
    with pytest.raises(AccountError, match=why):
        await wish(desk.directory)
    assert await desk.directory.list() == before
    assert len(await desk.audited()) == 1


async def test_an_account_is_added_with_something_else_or_not_at_all(desk: Desk) -> None:
    def fail(_: Connection) -> None:
        raise AccountError("no token for you")

    with pytest.raises(AccountError, match="no token"):
        await desk.directory.add_with(fail, MACHINE, "olga", "tuner")
    assert await desk.directory.list() == []
    assert await desk.audited() == []


async def test_the_number_of_accounts_is_bounded(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, "MOST", 2)
    for name in ("a", "b"):
        await desk.directory.add(MACHINE, name, "viewer", None)
    with pytest.raises(AccountError, match="there are 2 accounts already"):
        await desk.directory.add(MACHINE, "c", "viewer", None)


async def test_removing_takes_sessions_and_tokens_along(desk: Desk) -> None:
    await desk.directory.add(MACHINE, "olga", "tuner", PASSWORD)
    session = await desk.sessions.log_in("olga", PASSWORD, "here")
    token = await desk.tokens.add(MACHINE, "olga", "nightly")
    await desk.directory.remove(MACHINE, "olga")
    assert await desk.sessions.identity(session) is None
    assert await desk.tokens.identity(token) is None
    await desk.directory.add(MACHINE, "olga", "tuner", PASSWORD)
    assert await desk.sessions.identity(session) is None
    assert await desk.tokens.identity(token) is None

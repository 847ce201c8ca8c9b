"""The link of the first start, and passes to a seat: each works once, and for a time."""

import asyncio

import pytest

from esplanade.server.accounts import one_time
from esplanade.server.accounts.identity import MACHINE, AccountError, Identity
from esplanade.server.accounts.rights import ROLES
from tests.server.accounts.conftest import Desk

PASSWORD = "correct horse battery"


async def logged_in(desk: Desk, role: str = "director") -> Identity:
    await desk.directory.add(MACHINE, "olga", role, PASSWORD)
    found = await desk.sessions.identity(await desk.sessions.log_in("olga", PASSWORD, "here"))
    assert found is not None
    return found


async def test_the_link_makes_the_first_admin_once(desk: Desk) -> None:
    token = await desk.one_time.first_link()
    assert token is not None
    with pytest.raises(AccountError, match="fewer than 12"):
        await desk.one_time.add_first(token, "olga", "short", "here")
    await desk.one_time.add_first(token, "olga", PASSWORD, "here")
    (olga,) = await desk.directory.list()
    assert (olga.name, olga.role, olga.has_password) == ("olga", "admin", True)
    for name in ("olga", "ann"):
        with pytest.raises(AccountError, match="this link is not good, or no longer"):
            await desk.one_time.add_first(token, name, PASSWORD, "here")
    assert await desk.one_time.first_link() is None
    assert [row[0] for row in await desk.audited()] == ["first_link", "user_add"]


async def test_two_at_once_make_one_account(desk: Desk) -> None:
    token = await desk.one_time.first_link()
    assert token is not None
    outcomes = await asyncio.gather(
        *(desk.one_time.add_first(token, name, PASSWORD, "here") for name in ("olga", "ann")),
        return_exceptions=True,
    )
    assert sorted(isinstance(outcome, AccountError) for outcome in outcomes) == [False, True]
    assert len(await desk.directory.list()) == 1


async def test_the_link_is_good_for_ten_minutes(desk: Desk) -> None:
    token = await desk.one_time.first_link()
    assert token is not None
    desk.clock.go_on(600)
    with pytest.raises(AccountError, match="this link is not good"):
        await desk.one_time.add_first(token, "olga", PASSWORD, "here")


async def test_a_new_link_takes_the_place_of_the_one_before(desk: Desk) -> None:
    old, new = await desk.one_time.first_link(), await desk.one_time.first_link()
    assert old is not None
    assert new is not None
    with pytest.raises(AccountError, match="this link is not good"):
        await desk.one_time.add_first(old, "olga", PASSWORD, "here")
    await desk.one_time.add_first(new, "olga", PASSWORD, "here")


async def test_where_there_are_accounts_a_link_makes_no_other(desk: Desk) -> None:
    token = await desk.one_time.first_link()
    assert token is not None
    await desk.directory.add(MACHINE, "olga", "viewer", PASSWORD)
    with pytest.raises(AccountError, match="there is an account already"):
        await desk.one_time.add_first(token, "ann", PASSWORD, "here")
    assert [account.name for account in await desk.directory.list()] == ["olga"]


async def test_a_pass_gives_the_rights_of_its_account_once(desk: Desk) -> None:
    token = await desk.one_time.seat_pass(await logged_in(desk))
    found = await desk.one_time.take_pass(token, "192.0.2.7")
    assert found is not None
    assert (found.account, found.via, found.address) == ("olga", "pass", "192.0.2.7")
    assert found.rights == ROLES["director"]
    assert await desk.one_time.take_pass(token) is None
    assert [row[:2] for row in (await desk.audited())[2:]] == [
        ("seat_pass", "olga"),
        ("take_pass", "olga"),
    ]


async def test_a_pass_taken_by_many_at_once_is_taken_once(desk: Desk) -> None:
    token = await desk.one_time.seat_pass(await logged_in(desk))
    found = await asyncio.gather(*(desk.one_time.take_pass(token) for _ in range(20)))
    assert sum(each is not None for each in found) == 1


async def test_a_pass_is_good_for_a_minute(desk: Desk) -> None:
    by = await logged_in(desk)
    early, late = await desk.one_time.seat_pass(by), await desk.one_time.seat_pass(by)
    desk.clock.go_on(59.9)
    assert await desk.one_time.take_pass(early) is not None
    desk.clock.go_on(0.1)
    assert await desk.one_time.take_pass(late) is None


async def test_a_pass_has_the_rights_that_the_account_has_when_it_is_taken(desk: Desk) -> None:
    by = await logged_in(desk)
    token, other = await desk.one_time.seat_pass(by), await desk.one_time.seat_pass(by)
    await desk.directory.set_role(MACHINE, "olga", "viewer")
    found = await desk.one_time.take_pass(token)
    assert found is not None
    assert found.rights == ROLES["viewer"]
    await desk.directory.remove(MACHINE, "olga")
    assert await desk.one_time.take_pass(other) is None


async def test_only_who_is_logged_in_gets_a_pass(desk: Desk) -> None:
    await desk.directory.add(MACHINE, "ann", "director", None)
    by = await desk.tokens.identity(await desk.tokens.add(MACHINE, "ann", "nightly"))
    assert by is not None
    for each in (by, MACHINE):
        with pytest.raises(AccountError, match="only who is logged in has a pass"):
            await desk.one_time.seat_pass(each)


async def test_a_pass_is_no_link_and_a_link_no_pass(desk: Desk) -> None:
    link = await desk.one_time.first_link()
    assert link is not None
    assert await desk.one_time.take_pass(link) is None


async def test_what_waits_for_its_use_is_bounded(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(one_time, "MOST", 2)
    by = await logged_in(desk)
    for _ in range(2):
        await desk.one_time.seat_pass(by)
    with pytest.raises(AccountError, match="2 passes wait to be used"):
        await desk.one_time.seat_pass(by)
    desk.clock.go_on(60)
    await desk.one_time.seat_pass(by)

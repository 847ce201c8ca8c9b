"""Tokens of scripts: some rights of an account, until a day or until they are revoked."""

import pytest

from esplanade.server.accounts import tokens
from esplanade.server.accounts.identity import MACHINE, AccountError
from esplanade.server.accounts.rights import ROLES, Right
from esplanade.server.accounts.tokens import DAY_US, PREFIX
from tests.server.accounts.conftest import Desk


@pytest.fixture(autouse=True)
async def _olga(desk: Desk) -> None:
    await desk.directory.add(MACHINE, "olga", "tuner", None)


async def test_a_token_has_the_rights_that_were_granted(desk: Desk) -> None:
    rights = frozenset({Right.WATCH, Right.PARAMETERS})
    token = await desk.tokens.add(MACHINE, "olga", "nightly", rights=rights)
    whole = await desk.tokens.add(MACHINE, "olga", "whole")
    found, other = await desk.tokens.identity(token), await desk.tokens.identity(whole)
    assert found is not None
    assert other is not None
    assert (found.account, found.via, found.rights) == ("olga", "token nightly", rights)
    assert other.rights == ROLES["tuner"]
    assert token.startswith(PREFIX)
    assert await desk.tokens.identity(token[:-1]) is None


async def test_a_token_is_kept_as_a_digest_and_shown_never_again(desk: Desk) -> None:
    token = await desk.tokens.add(MACHINE, "olga", "nightly")
    assert token not in repr(await desk.tokens.list())
    if desk.store.location.file is not None:
        for file in desk.store.location.file.parent.iterdir():
            assert token.removeprefix(PREFIX).encode() not in file.read_bytes()


async def test_a_token_ends_on_its_day(desk: Desk) -> None:
    token = await desk.tokens.add(MACHINE, "olga", "nightly", lasts_us=DAY_US)
    desk.clock.go_on(24 * 3600 - 1)
    assert await desk.tokens.identity(token) is not None
    desk.clock.go_on(1)
    assert await desk.tokens.identity(token) is None
    (known,) = await desk.tokens.list("olga")
    assert not known.is_usable(desk.clock.now_us)


async def test_a_revoked_token_opens_nothing(desk: Desk) -> None:
    token = await desk.tokens.add(MACHINE, "olga", "nightly")
    await desk.tokens.revoke(MACHINE, "olga", "nightly")
    assert await desk.tokens.identity(token) is None
    with pytest.raises(AccountError, match="has revoked already its token 'nightly'"):
        await desk.tokens.revoke(MACHINE, "olga", "nightly")
    assert [row[0] for row in await desk.audited()] == ["user_add", "token_add", "token_revoke"]


async def test_a_token_never_has_more_than_its_account(desk: Desk) -> None:
    token = await desk.tokens.add(
        MACHINE, "olga", "nightly", rights=frozenset({Right.WATCH, Right.PARAMETERS})
    )
    await desk.directory.set_role(MACHINE, "olga", "viewer")
    found = await desk.tokens.identity(token)
    assert found is not None
    assert found.rights == {Right.WATCH}


async def test_its_last_use_is_kept(desk: Desk) -> None:
    token = await desk.tokens.add(MACHINE, "olga", "nightly")
    assert [known.used_us for known in await desk.tokens.list()] == [None]
    first = desk.clock.now_us
    for _ in range(59):
        await desk.tokens.identity(token)
        desk.clock.go_on(1)
    assert [known.used_us for known in await desk.tokens.list()] == [first]
    desk.clock.go_on(1)
    await desk.tokens.identity(token)
    assert [known.used_us for known in await desk.tokens.list()] == [desk.clock.now_us]
    (olga,) = await desk.directory.list()
    assert (olga.seen_us, olga.tokens) == (desk.clock.now_us, 1)


@pytest.mark.parametrize(
    ("account", "name", "more", "why"),
    [
        ("ann", "nightly", {}, "there is no account 'ann'"),
        ("olga", "taken", {}, "has had a token 'taken' already"),
        ("olga", "Nightly job", {}, "'Nightly job' is no name"),
        (
            "olga",
            "nightly",
            {"rights": frozenset({Right.DOORS, Right.WATCH})},
            "role tuner does not have the right doors",
        ),
        ("olga", "nightly", {"rights": frozenset()}, "a token needs a right at least"),
        ("olga", "nightly", {"lasts_us": 0}, "a token lasts up to 366 days"),
        ("olga", "nightly", {"lasts_us": 367 * DAY_US}, "a token lasts up to 366 days"),
    ],
)
async def test_what_cannot_be_changes_nothing(
    desk: Desk, account: str, name: str, more: dict[str, object], why: str
) -> None:
    await desk.tokens.add(MACHINE, "olga", "taken")
    before = await desk.tokens.list(), await desk.audited()
    with pytest.raises(AccountError, match=why):
        await desk.tokens.add(MACHINE, account, name, **more)  # type: ignore[arg-type]
    assert (await desk.tokens.list(), await desk.audited()) == before


async def test_tokens_of_an_account_are_bounded(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tokens, "MOST", 1)
    await desk.tokens.add(MACHINE, "olga", "nightly")
    with pytest.raises(AccountError, match="has had 1 tokens already"):
        await desk.tokens.add(MACHINE, "olga", "daily")


@pytest.mark.parametrize("account", ["ann", None])
async def test_lists_are_of_one_account_or_all(desk: Desk, account: str | None) -> None:
    if account is None:
        assert await desk.tokens.list() == []
        return
    with pytest.raises(AccountError, match="there is no account 'ann'"):
        await desk.tokens.list(account)

"""Tokens of bots: what becomes of those that are over."""

import pytest

from esplanade.server.accounts import bots
from esplanade.server.accounts.bots import Bots
from esplanade.server.accounts.identity import MACHINE, AccountError
from tests.server.accounts.conftest import Desk

DAY_US = 24 * 3600 * 10**6


async def _added(made: Bots, name: str, days: int) -> str:
    return await made.add(MACHINE, name, message_rate=60, connections=1, lasts_us=days * DAY_US)


async def test_a_token_that_is_over_frees_its_name_and_is_forgotten_after_a_month(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(bots, "MOST", 3)
    made = Bots(desk.store, desk.audit, desk.clock)
    first = await _added(made, "echo", 1)
    await _added(made, "short", 1)
    await _added(made, "long", 300)
    with pytest.raises(AccountError, match="there is a bot 'echo' already"):
        await _added(made, "echo", 1)
    desk.clock.go_on(24 * 3600 + 1)
    assert await made.of(first) is None
    again = await _added(made, "echo", 300)
    found = await made.of(again)
    assert found is not None
    assert found.name == "echo"
    # That of a day ago is still listed, and counts.
    assert [bot.name for bot in await made.list()] == ["echo", "long", "short"]
    with pytest.raises(AccountError, match="there are 3 bots already"):
        await _added(made, "new", 1)
    desk.clock.go_on(30 * 24 * 3600)
    await _added(made, "new", 1)
    assert [bot.name for bot in await made.list()] == ["echo", "long", "new"]

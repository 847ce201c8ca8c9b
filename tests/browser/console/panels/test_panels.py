"""Every panel of the operators' page, with what it shows of a real world; axe on all of them."""

import re
from typing import Any, Final

import pytest
from playwright.async_api import Browser, expect

from esplanade.server.app import Running
from tests.browser.console.visit import arrived
from tests.patience import PATIENCE_S

pytestmark = pytest.mark.asyncio(loop_scope="package")
expect.set_options(timeout=1e3 * PATIENCE_S)

PANELS: Final = {
    "Parameters": "parameters",
    "Presets": "presets",
    "Differences": "difference",
    "Groups": "groups",
    "Schedules": "schedules",
    "Actors": "actors",
    "World": "world",
    "Series": "series",
    "Events": "events",
    "Changes": "changes",
    "Audit": "audit",
    "People": "people",
    "Chat": "chat",
    "Inbox": "reports",
    "Bans": "bans",
    "Accounts": "accounts",
    "Invitations": "invitations",
    "My account": "account",
}
"""Titles and tags of the panels beside the map."""


@pytest.mark.parametrize(("scheme", "width"), [("light", 1280), ("dark", 360)])
async def test_axe_finds_nothing_in_any_panel(
    server: Running, browser: Browser, scheme: Any, width: int
) -> None:
    olga = await arrived(browser, server, "olga", width=width, height=800, scheme=scheme)
    findings: list[str] = []
    for title, tag in PANELS.items():
        await olga.show(title)
        await expect(olga.panel(tag)).to_be_visible()
        findings += [f"{tag}: {each}" for each in await olga.findings()]
        assert await olga.overflow_px() <= 0, f"{title} is wider than the page"
    assert not findings, "\n".join(findings)
    assert olga.complaints == []


async def test_presets_actors_and_changes_work_together(server: Running, browser: Browser) -> None:
    olga = await arrived(browser, server, "olga")
    await olga.show("Presets")
    presets = olga.panel("presets")
    await presets.get_by_role("button", name="Apply courteous to world").click()
    await olga.show("Changes")
    newest = olga.panel("changes").get_by_role("listitem").first
    await expect(newest).to_contain_text("apply preset")
    await expect(newest).to_contain_text("olga")
    await newest.get_by_role("button", name=re.compile("Undo change")).click()
    await expect(olga.panel("changes").locator("li.reverted")).to_have_count(1)

    await olga.show("Actors")
    actors = olga.panel("actors")
    rows = actors.locator("tbody tr")
    await expect(rows).not_to_have_count(0)
    before = await rows.count()
    await actors.get_by_label("Name", exact=True).fill("Newcomer")
    await actors.get_by_role("button", name="Add 1 actors").click()
    await expect(rows).to_have_count(before + 1)
    await actors.get_by_role("button", name="Newcomer", exact=True).click()
    await actors.get_by_role("button", name="Hold", exact=True).click()
    await expect(rows.filter(has_text="Newcomer")).to_contain_text("held")
    await actors.get_by_role("button", name="Remove", exact=True).click()
    await expect(rows).to_have_count(before)
    assert olga.complaints == []


async def test_a_viewer_is_told_why_buttons_do_nothing(server: Running, browser: Browser) -> None:
    vera = await arrived(browser, server, "vera")
    await vera.show("Parameters")
    apply = vera.panel("parameters").get_by_role("button", name="Apply")
    await expect(apply).to_be_disabled()
    await expect(apply).to_have_attribute("title", "The role viewer may not change parameters.")
    await expect(vera.slider("risk_weight")).to_be_disabled()
    assert await vera.page.get_by_role("tab", name="Accounts").count() == 0
    assert vera.complaints == []


async def test_a_token_is_shown_once(server: Running, browser: Browser) -> None:
    olga = await arrived(browser, server, "olga")
    await olga.show("Accounts")
    accounts = olga.panel("accounts")
    vera = accounts.get_by_role("listitem").filter(has_text="vera").first
    await vera.locator("summary").click()
    await vera.get_by_label("Token's name").fill("report")
    await vera.get_by_role("button", name="Make").click()
    secret = accounts.locator(".secret code")
    await expect(secret).to_contain_text("esplanade_")
    await accounts.get_by_role("button", name="I have it").click()
    await expect(secret).to_have_count(0)
    await expect(vera).to_contain_text("report")
    assert olga.complaints == []


async def test_nothing_typed_is_left_after_logging_out(server: Running, browser: Browser) -> None:
    olga = await arrived(browser, server, "olga")
    await olga.show("Parameters")
    await olga.box("hurry_weight").fill("7")
    await expect(olga.page).to_have_url(re.compile("draft"))
    await olga.log_out()
    await expect(olga.page).not_to_have_url(re.compile("draft"))
    olga.account = "otto"
    await olga.log_in()
    await olga.show("Parameters")
    await olga.box("catch_up").fill("0.5")
    state = olga.panel("parameters").locator(".state")
    await expect(state).to_contain_text("takes effect at once")
    await expect(state).to_contain_text("1 edit")
    await expect(olga.box("hurry_weight")).to_have_value("0.2")
    assert olga.complaints == []

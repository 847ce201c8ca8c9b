"""Logging in and out of the operators' page, and sessions that end meanwhile."""

import pytest

from tests.browser.console.stage import Stage
from tests.browser.console.stage_answers import PASSWORD
from tests.browser.console.visit import Visit

pytestmark = pytest.mark.asyncio(loop_scope="module")


async def test_an_operator_comes_in_and_leaves(visit: Visit) -> None:
    page = visit.page
    await visit.open()
    await visit.log_in("some other password")
    await page.wait_for_selector("text=no account has this name and password")
    assert await page.locator("esp-map").count() == 0
    await visit.come_in()
    await visit.log_out()
    assert await page.locator("esp-map").count() == 0
    await page.reload()
    await page.wait_for_selector("#password")


async def test_the_first_account_is_made_by_a_link_that_leaves_the_address(
    visit: Visit, server: Stage
) -> None:
    page = visit.page
    server.first_token = "once"
    await visit.open("#first=once")
    await page.wait_for_selector("text=The first account")
    assert "once" not in page.url
    await page.fill("#name", "olga")
    await page.fill("#password", PASSWORD)
    await page.fill("#again", "something else")
    await page.click("button[type=submit]")
    await page.wait_for_selector("text=the two passwords differ")
    await page.fill("#again", PASSWORD)
    await page.click("button[type=submit]")
    await page.wait_for_selector("canvas.map[data-ms]")
    assert server.first_token is None


async def test_a_world_without_accounts_says_how_to_make_one(visit: Visit, server: Stage) -> None:
    server.first_token = "once"
    await visit.open()
    await visit.page.wait_for_selector("text=esplanade op user add")


async def test_a_session_that_ends_asks_again_and_nothing_is_lost(
    visit: Visit, server: Stage
) -> None:
    page = visit.page
    await visit.come_in()
    await page.fill("input[type=search]", "Actor 1")
    await page.click("[role=option] >> nth=0")
    server.end_sessions()
    await page.wait_for_selector("text=Your session has ended")
    assert await page.input_value("#name") == "olga"
    await page.fill("#password", PASSWORD)
    await page.press("#password", "Enter")
    await page.wait_for_selector("esp-login", state="detached")
    await page.wait_for_selector("text=live")
    assert await page.input_value("input[type=search]") == "Actor 1"
    await page.wait_for_selector("esp-inspector h2:has-text('Actor 1')")


async def test_a_line_that_is_cut_comes_back_with_everybody(visit: Visit, server: Stage) -> None:
    page = visit.page
    await visit.come_in()
    await server.cut()
    await page.wait_for_selector("text=connecting…")
    server.people += 1
    await page.wait_for_selector("text=live")
    await page.wait_for_selector("text=20 actors, 9 people")

"""Operators go from one zone of a world to another, each with a page of its own."""

from pathlib import Path

import pytest
from playwright.async_api import Browser

from tests.browser.console.stage_answers import ACCOUNT
from tests.browser.console.visit import arrived
from tests.browser.console.worlds import operated
from tests.server.zones import write_town

pytestmark = pytest.mark.asyncio(loop_scope="module")


async def test_a_menu_leads_to_the_other_zone(browser: Browser, tmp_path: Path) -> None:
    town = write_town(tmp_path)
    async with operated({ACCOUNT: "tuner"}, world=town, actors=3, seed=1) as server:
        visit = await arrived(browser, server, ACCOUNT)
        page = visit.page
        await page.wait_for_selector("text=3 actors, 0 people")
        menu = page.locator("esp-topbar summary", has_text="The yard")
        await menu.click()
        here = page.locator("esp-topbar a[aria-current=page]")
        assert "The yard" in await here.inner_text()
        assert await visit.findings() == []
        await page.locator("esp-topbar a", has_text="The hall").click()
        # The session is good for all zones: nobody logs in again.
        await page.wait_for_url("**/zones/hall/console/")
        await page.wait_for_selector("canvas.map[data-ms]")
        await page.locator("esp-topbar summary", has_text="The hall").wait_for()
        await page.wait_for_selector("text=3 actors, 0 people")
        names = {spec.name for spec in server.zones["hall"].world.actors.values()}
        first = await page.locator("[role=option]").first.inner_text()
        assert first.splitlines()[0] in names
        assert visit.complaints == []

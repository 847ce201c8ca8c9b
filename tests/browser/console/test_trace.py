"""The inspector on a real server: costs of an actor's path, its search and the risk on the map."""

from collections.abc import AsyncIterator
from typing import Final

import pytest
import pytest_asyncio
from playwright.async_api import BrowserContext

from esplanade.server.accounts.identity import MACHINE
from esplanade.server.app import Running, running
from esplanade.server.settings import ServerSettings
from tests.browser.console.conftest import Visit
from tests.browser.console.stage_answers import ACCOUNT, PASSWORD

pytestmark = pytest.mark.asyncio(loop_scope="module")

ACTORS: Final = 12


@pytest_asyncio.fixture(loop_scope="module")
async def world() -> AsyncIterator[Running]:
    """The gallery with actors, and an account."""
    settings = ServerSettings(
        host="127.0.0.1",
        port=0,
        private_host="127.0.0.1",
        private_port=0,
        actors=ACTORS,
        seed=7,
        log_level="warning",
    )
    async with running(settings) as server:
        await server.kept.directory.add(MACHINE, ACCOUNT, "viewer", PASSWORD)
        yield server


async def test_an_operator_sees_how_an_actor_decides(
    world: Running, profile: BrowserContext
) -> None:
    visit = Visit(await profile.new_page(), f"http://127.0.0.1:{world.private_port}/console/")
    page = visit.page
    await visit.come_in()
    await page.wait_for_selector(f"text={ACTORS} actors, 0 people")
    await page.click("[role=option] >> nth=0")
    await page.wait_for_selector("esp-inspector #cost")
    await page.wait_for_selector("esp-inspector .costs .bar.time", state="attached")
    await page.click("esp-inspector button:has-text('Show the search')")
    await page.wait_for_selector("esp-inspector section:has(#search):has-text('expansions')")
    await page.wait_for_selector("esp-inspector #compared")
    await page.click("esp-inspector button:has-text('Colour by time ahead')")
    await page.locator("esp-inspector .slice input").fill("6")
    await page.wait_for_selector("esp-inspector .slice:has-text('Risk in 2.4 s')")
    await page.click("esp-inspector button:has-text('Hide')")
    await page.wait_for_selector("esp-inspector .slice", state="detached")
    assert visit.complaints == []

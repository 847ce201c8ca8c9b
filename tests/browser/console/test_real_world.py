"""The operators' page on a real server: its actors on the map, and a change that the page shows."""

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

ACTORS: Final = 6


@pytest_asyncio.fixture(loop_scope="module")
async def world() -> AsyncIterator[Running]:
    """The gallery with some actors, and an account."""
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
        await server.kept.directory.add(MACHINE, ACCOUNT, "tuner", PASSWORD)
        yield server


async def test_an_operator_sees_the_actors_and_a_change_of_one(
    world: Running, profile: BrowserContext
) -> None:
    visit = Visit(await profile.new_page(), f"http://127.0.0.1:{world.private_port}/console/")
    page = visit.page
    await visit.come_in()
    await page.wait_for_selector(f"text={ACTORS} actors, 0 people")
    await page.click("[role=option] >> nth=0")
    await page.wait_for_selector("esp-inspector dd:has-text('main/actor-')")
    await page.wait_for_selector("esp-inspector .band span", state="attached")
    await page.wait_for_selector("esp-inspector th.name:has-text('risk weight')")
    await page.click("summary:has-text('Layers')")
    for name in ("planned ways", "goals", "predictions"):
        await page.get_by_label(name).check()
    for heat in ("density", "speed", "waiting", "contacts"):
        await page.get_by_label("Heat map").select_option(heat)
        await page.wait_for_selector(f"esp-map .legend:has-text('{heat} 0')")
    status = await page.evaluate(
        """async () => (await fetch("../api/v1/commands", {
          method: "POST",
          headers: {"Content-Type": "application/json", "X-Esplanade": "1"},
          body: JSON.stringify(
            {op: "set_parameters", scope: "world", values: {risk_weight: 12.5}}),
        })).status"""
    )
    assert status == 200
    await page.wait_for_selector("esp-inspector tr:has-text('risk weight'):has-text('12.5')")
    await page.click(f"summary:has-text('{ACCOUNT}')")
    await page.click("text=Log out")
    await page.wait_for_selector("#password")
    assert visit.complaints == []

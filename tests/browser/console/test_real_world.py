"""The operators' page on a real server: actors on the map, a change of one, how one decides."""

from collections.abc import AsyncIterator
from typing import Final

import pytest
import pytest_asyncio
from playwright.async_api import Browser

from esplanade.server.app import Running
from tests.browser.console.stage_answers import ACCOUNT
from tests.browser.console.visit import Visit, arrived
from tests.browser.console.worlds import operated

pytestmark = pytest.mark.asyncio(loop_scope="module")

ACTORS: Final = 12
VIEWER: Final = "vera"


@pytest_asyncio.fixture(scope="module", loop_scope="module")
async def world() -> AsyncIterator[Running]:
    """The gallery with actors, and two accounts."""
    async with operated({ACCOUNT: "tuner", VIEWER: "viewer"}, actors=ACTORS, seed=7) as server:
        yield server


async def _choose_first(visit: Visit) -> None:
    await visit.page.wait_for_selector(f"text={ACTORS} actors, 0 people")
    await visit.page.click("[role=option] >> nth=0")


async def test_an_operator_sees_the_actors_and_a_change_of_one(
    world: Running, browser: Browser
) -> None:
    visit = await arrived(browser, world, ACCOUNT)
    page = visit.page
    await _choose_first(visit)
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
    await visit.log_out()
    assert visit.complaints == []


async def test_an_operator_sees_how_an_actor_decides(world: Running, browser: Browser) -> None:
    visit = await arrived(browser, world, VIEWER)
    page = visit.page
    await _choose_first(visit)
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

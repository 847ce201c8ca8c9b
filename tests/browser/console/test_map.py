"""The live map of the operators' page: choosing, following, asking for places, and its cost."""

import asyncio
import math

import pytest
from playwright.async_api import Browser

from tests.browser.console.stage import staged
from tests.browser.console.visit import Visit, visit_of
from tests.patience import PATIENCE_S

pytestmark = pytest.mark.asyncio(loop_scope="module")

FRAME_MS = 16.0
SLOWER = 3.0
"""A machine that does other things at the same time draws this much slower."""


async def test_a_box_chooses_many_and_a_click_on_the_ground_nobody(visit: Visit) -> None:
    page = visit.page
    await visit.come_in()
    canvas = page.locator("canvas.map")
    box = await canvas.bounding_box()
    assert box is not None
    await page.get_by_role("button", name="Box", exact=True).click()
    await page.mouse.move(box["x"] + 3, box["y"] + 3)
    await page.mouse.down()
    await page.mouse.move(box["x"] + box["width"] - 3, box["y"] + box["height"] - 40, steps=5)
    await page.mouse.up()
    await page.wait_for_selector("text=28 in the world, 28 chosen")
    await page.get_by_role("button", name="Move", exact=True).click()
    await page.mouse.click(box["x"] + 4, box["y"] + 4)
    await page.wait_for_selector("text=Choose somebody on the map")


async def test_layers_are_asked_for_while_they_are_shown(visit: Visit) -> None:
    page = visit.page
    await visit.come_in()
    await page.click("summary:has-text('Layers')")
    for name in ("planned ways", "goals", "predictions"):
        await page.get_by_label(name).check()
    await page.get_by_label("Trails").select_option("10 s")
    await page.get_by_label("Heat map").select_option("density")
    await page.wait_for_selector("canvas.scale")
    await page.reload()
    await page.wait_for_selector("canvas.scale")


async def test_the_search_of_an_actor_is_drawn(visit: Visit) -> None:
    page = visit.page
    await visit.come_in()
    await page.click("[role=option]:has-text('Actor 2')")
    await page.wait_for_selector("esp-inspector .stops li:has-text('Anna 1, 0.7 m away')")
    await page.wait_for_selector("text=keeping right")
    await page.click("text=Show the search and the risk")
    await page.wait_for_selector("text=120 of 400 expansions")
    await page.get_by_label("Risk in").fill("5")
    await page.wait_for_selector("text=Risk in 2.0 s")


async def test_two_actors_are_compared(visit: Visit) -> None:
    page = visit.page
    await visit.come_in()
    await page.click("[role=option]:has-text('Actor 2')")
    await page.click("[role=option]:has-text('Actor 3')", modifiers=["Control"])
    await page.wait_for_selector("text=Parameters that differ")


async def test_five_hundred_avatars_are_drawn_in_time(browser: Browser) -> None:
    async with staged(actors=400, people=100) as (url, _):
        visit = await visit_of(browser, url, 1280, 800, "light")
        await visit.come_in()
        page = visit.page
        await page.wait_for_selector("text=400 actors, 100 people")
        await page.click("summary:has-text('Layers')")
        await page.get_by_label("Trails").select_option("10 s")
        await page.get_by_label("Heat map").select_option("density")
        await page.wait_for_selector("canvas.scale")
        canvas = page.locator("canvas.map")
        took_ms = math.inf
        async with asyncio.timeout(PATIENCE_S):
            while took_ms > SLOWER * FRAME_MS:
                await asyncio.sleep(0.5)
                took_ms = float(await canvas.get_attribute("data-ms") or math.inf)
        assert visit.complaints == []

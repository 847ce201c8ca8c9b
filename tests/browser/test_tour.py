"""The tour of a guide: its stops, joining it, and what the guide says to those whom it leads."""

import json
from collections.abc import AsyncIterator

import pytest
import pytest_asyncio
from playwright.async_api import Browser, BrowserContext, expect

from esplanade.planning import Place, Scene
from tests.browser.visitor import Visitor
from tests.browser.worlds import built, entered_at, world
from tests.patience import PATIENCE_S

pytestmark = [pytest.mark.browser, pytest.mark.asyncio(loop_scope="module")]

expect.set_options(timeout=1e3 * PATIENCE_S)

PLACES = (Place(name="Fountain", position=(10.0, 20.0)), Place(name="Gate", position=(16.0, 20.0)))
GUIDE = {
    "id": "main/sage",
    "name": "Sage",
    "place": (10.0, 20.0, 0.0),
    "behaviour": {"kind": "guide", "tour": ["Fountain", "Gate"], "pause_s": 4.0},
}


@pytest_asyncio.fixture(scope="module", loop_scope="module")
async def tour_url(tmp_path_factory: pytest.TempPathFactory) -> AsyncIterator[str]:
    """Address of a square on which somebody guides."""
    built("index.html")
    folder = tmp_path_factory.mktemp("tour")
    square = Scene.open_space((0.0, 0.0, 30.0, 30.0), name="square")
    square = square.model_copy(update={"places": PLACES})
    roster = folder / "roster.json"
    roster.write_text(json.dumps({"actors": [GUIDE]}))
    scene = entered_at(square, (10.0, 14.0, 0.0), folder)
    async with world(scene=scene, roster=roster) as address:
        yield address


async def test_a_tour_is_joined_and_told(tour_url: str, profile: BrowserContext) -> None:
    ann = await Visitor.arrive(profile, tour_url)
    await ann.join("Ann")
    await ann.page.click("#people-open")
    await ann.page.get_by_role("button", name="Sage").click()
    stops = ann.page.locator("#plan-stops li")
    await expect(stops).to_have_text(["Fountain", "Gate"])
    await expect(ann.page.locator("#plan-followers")).to_have_text("Nobody is on this tour yet.")
    await ann.page.get_by_role("button", name="Join the tour").click()
    await expect(ann.page.locator("#following-whom")).to_have_text("You follow Sage.")
    await expect(ann.page.locator("#plan-followers")).to_have_text("You are on this tour.")
    said = ann.page.locator("#chat-lines")
    await expect(said).to_contain_text("Welcome to the tour of 2 stops.")
    await expect(said).to_contain_text("We go on to Gate.")
    await expect(said).to_contain_text("This is Gate, stop 2 of 2.")
    await ann.page.get_by_role("button", name="Leave the tour").click()
    await expect(ann.page.locator("#following")).to_be_hidden()
    await expect(ann.page.get_by_role("button", name="Join the tour")).to_be_visible()
    assert await ann.complaints() == []


async def test_whoever_is_not_led_hears_nothing_of_it(tour_url: str, browser: Browser) -> None:
    contexts = [await browser.new_context() for _ in range(2)]
    ann, ben = [await Visitor.arrive(context, tour_url) for context in contexts]
    await ben.join("Ben")
    await ann.join("Ann")
    await ann.page.click("#people-open")
    await ann.page.get_by_role("button", name="Sage").click()
    await ann.page.get_by_role("button", name="Join the tour").click()
    await expect(ann.page.locator("#chat-lines")).to_contain_text("We go on to")
    await expect(ben.page.locator("#chat-lines")).not_to_contain_text("tour")
    await expect(ben.page.locator("#chat-lines")).not_to_contain_text("We go on")
    for context in contexts:
        await context.close()

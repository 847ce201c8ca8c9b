"""The behaviour of a page when its server goes away and comes back."""

from urllib.parse import urlsplit

import pytest
from playwright.async_api import BrowserContext

from tests.browser.visitor import Visitor
from tests.browser.worlds import world

pytestmark = [pytest.mark.browser, pytest.mark.asyncio(loop_scope="module")]


async def test_the_page_says_that_the_server_is_gone_and_comes_back_by_itself(
    profile: BrowserContext,
) -> None:
    async with world(actors=1) as url:
        ann = await Visitor.arrive(profile, url)
        await ann.join("Ann")
    await ann.until(lambda view: view["phase"] == "reconnecting")
    assert await ann.page.locator("#banner").is_visible()
    async with world(actors=1, port=urlsplit(url).port):
        await ann.until(lambda view: view["phase"] == "live" and len(view["avatars"]) > 0)
        assert not await ann.page.locator("#banner").is_visible()
        assert await ann.page.locator("#join").is_hidden()
        await ann.page.close()


async def test_a_full_world_is_said_at_the_door(profile: BrowserContext) -> None:
    async with world(max_clients=1) as url:
        ann = await Visitor.arrive(profile, url)
        await ann.join("Ann")
        ben = await Visitor.arrive(profile, url)
        await ben.page.fill("#join-name", "Ben")
        await ben.page.click("#join-button")
        await ben.until(lambda view: view["phase"] == "refused")
        assert "full" in await ben.page.locator("#join-reason").inner_text()
        assert await ben.page.locator("#join-button").is_enabled()

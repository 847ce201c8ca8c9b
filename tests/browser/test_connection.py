"""What a page does when its server goes away and comes back."""

import pytest
from playwright.async_api import BrowserContext

from esplanade.server.app import running
from esplanade.server.settings import ServerSettings
from tests.browser.visitor import Visitor

pytestmark = [pytest.mark.browser, pytest.mark.asyncio(loop_scope="module")]


def _settings(port: int) -> ServerSettings:
    return ServerSettings(
        host="127.0.0.1", port=port, private_port=0, actors=1, log_level="warning"
    )


async def test_the_page_says_that_the_server_is_gone_and_comes_back_by_itself(
    profile: BrowserContext,
) -> None:
    async with running(_settings(0)) as server:
        port = server.port
        ann = await Visitor.arrive(profile, f"http://127.0.0.1:{port}/")
        await ann.join("Ann")
    await ann.until(lambda view: view["phase"] == "reconnecting")
    assert await ann.page.locator("#banner").is_visible()
    async with running(_settings(port)):
        await ann.until(lambda view: view["phase"] == "live" and len(view["avatars"]) > 0)
        assert not await ann.page.locator("#banner").is_visible()
        assert await ann.page.locator("#join").is_hidden()
        await ann.page.close()


async def test_a_full_world_is_said_at_the_door(profile: BrowserContext) -> None:
    settings = _settings(0).model_copy(update={"max_clients": 1})
    async with running(settings) as server:
        url = f"http://127.0.0.1:{server.port}/"
        ann = await Visitor.arrive(profile, url)
        await ann.join("Ann")
        ben = await Visitor.arrive(profile, url)
        await ben.page.fill("#join-name", "Ben")
        await ben.page.click("#join-button")
        await ben.until(lambda view: view["phase"] == "refused")
        assert "full" in await ben.page.locator("#join-reason").inner_text()
        assert await ben.page.locator("#join-button").is_enabled()

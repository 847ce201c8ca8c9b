"""The page before somebody is in the world: the seat that it takes, the wishes in its address."""

import pytest
from playwright.async_api import BrowserContext, WebSocket

from tests.browser.visitor import Visitor
from tests.browser.worlds import world

pytestmark = [pytest.mark.browser, pytest.mark.asyncio(loop_scope="module")]


@pytest.mark.parametrize("host", ["127.0.0.1", "world.test"])
async def test_a_duplicated_tab_asks_for_a_name(
    url: str, profile: BrowserContext, host: str
) -> None:
    """At `world.test`, over plain HTTP, the browser has no locks."""
    first = await Visitor.arrive(profile, url.replace("127.0.0.1", host))
    await first.join("Ann")
    assert await first.page.evaluate("() => 'locks' in navigator") == (host == "127.0.0.1")
    if host == "127.0.0.1":  # the browser tells of locks once those that were asked for are there
        locks = await first.page.evaluate("async () => (await navigator.locks.query()).held.length")
        assert locks == 1
    async with profile.expect_page() as opened:
        # A window that is opened in this way begins with a copy of the session's storage.
        await first.page.evaluate("() => { window.open(location.href) }")
    second = Visitor(await opened.value)
    await second.page.wait_for_selector("#join", state="visible")
    await second.join("Ann")
    ids = {(await first.look())["id"], (await second.look())["id"]}
    assert len(ids) == 2
    assert (await first.look())["phase"] == "live"


async def test_a_reload_goes_back_in_where_the_browser_has_no_locks(
    url: str, profile: BrowserContext
) -> None:
    ann = await Visitor.arrive(profile, url.replace("127.0.0.1", "world.test"))
    await ann.join("Ann")
    ann_id = (await ann.look())["id"]
    await ann.page.reload()
    await ann.until(lambda view: view["phase"] == "live" and view["id"] == ann_id)


async def test_the_operator_key_is_taken_out_of_the_address(profile: BrowserContext) -> None:
    async with world(operator_key="sesame") as address:
        olga = await Visitor.arrive(profile, f"{address}#operator=sesame&at=20,1.5")
        assert olga.page.url == f"{address}#at=20,1.5"
        sent: list[str | bytes] = []

        def keep(payload: str | bytes) -> None:
            sent.append(payload)

        def opened(socket: WebSocket) -> None:
            socket.on("framesent", keep)

        olga.page.on("websocket", opened)
        await olga.join("Olga")
        assert b"sesame" in sent[0]
        await olga.page.close()


async def test_a_link_to_a_place_asks_whether_to_walk_there(
    url: str, profile: BrowserContext
) -> None:
    ann = await Visitor.arrive(profile, f"{url}#at=17,-4")
    await ann.join("Ann")
    await ann.page.click("#invitation-go")
    await ann.until(lambda view: any(a["own"] and a["pose"]["y"] < -3.0 for a in view["avatars"]))
    assert await ann.page.locator("#invitation").is_hidden()

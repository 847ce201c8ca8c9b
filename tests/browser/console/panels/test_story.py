"""One visit of an operator from the first page to the last, with a second one at the same time."""

import re
from typing import Any, Final

import pytest
from playwright.async_api import Browser, Locator, Page, expect

from esplanade.server.app import Running
from tests.browser.console.stage_answers import PASSWORD
from tests.browser.console.visit import Visit, arrived, visit_of
from tests.browser.console.worlds import script_of
from tests.patience import PATIENCE_S
from tests.server.console.operators import Operator

pytestmark = pytest.mark.asyncio(loop_scope="package")
expect.set_options(timeout=1e3 * PATIENCE_S)

SPEED: Final = "speed_mps"
WEIGHT: Final = "risk_weight"
FAST: Final = re.compile(r"^(0\.[6-9]|[1-9]\.)\d+ m/s")
SLOW: Final = re.compile(r"^0\.[0-3]\d m/s")
MOST_TABS: Final = 200


async def test_an_operator_comes_in_tunes_shares_and_leaves(
    server: Running, browser: Browser
) -> None:
    script = await script_of(server, "vera", "story")
    usual = await _value(script, SPEED)
    url = f"http://127.0.0.1:{server.private_port}/console/"
    olga = await visit_of(browser, url, 1280, 720)
    await olga.page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    await _come_in_by_keys(olga)
    await _drag_a_draft(olga)
    assert await _value(script, SPEED) == usual, "a draft is not sent"

    speed = olga.panel("inspector").locator("dt:text-is('Speed') + dd")
    state = olga.panel("parameters").locator(".state")
    await expect(speed).to_have_text(FAST)
    await olga.panel("parameters").get_by_role("button", name="Apply").click()
    await expect(state).to_contain_text("No draft")
    await expect(speed).to_have_text(SLOW)
    slow = await _value(script, SPEED)
    assert slow < 0.3
    await expect(olga.row(SPEED).locator(".chip").first).to_have_class(re.compile("set"))
    await olga.panel("parameters").get_by_role("button", name="Undo my latest change").click()
    await expect(olga.box(SPEED)).to_have_value(f"{usual:g}")
    await expect(speed).to_have_text(FAST)
    assert await _value(script, SPEED) == usual

    # Somebody else has the link, and sees the same, as a draft of their own.
    await olga.panel("parameters").locator("[name=scope]").select_option("world")
    await olga.box(WEIGHT).click()
    await olga.page.keyboard.press("ControlOrMeta+a")
    await olga.page.keyboard.type("17")
    await expect(olga.page).to_have_url(re.compile("draft"))
    await olga.page.get_by_role("button", name="Copy link").click()
    await expect(olga.page.get_by_text("The link is copied.")).to_be_visible()
    link = await olga.page.evaluate("navigator.clipboard.readText()")
    otto = await arrived(browser, server, "otto", fragment=link.removeprefix(url))
    chosen = await olga.panel("inspector").locator("h2").inner_text()
    await expect(otto.panel("inspector").locator("h2")).to_have_text(chosen)
    await expect(otto.box(WEIGHT)).to_have_value("17")

    # The draft outlives loading the page anew, and the other's change of the same value.
    await olga.page.reload()
    await olga.page.wait_for_selector("text=live")
    await expect(olga.box(WEIGHT)).to_have_value("17")
    await olga.box(WEIGHT).click()
    await olga.page.keyboard.press("End")
    await otto.box(WEIGHT).fill("21")
    await otto.box(WEIGHT).press("ControlOrMeta+Enter")
    await expect(otto.panel("parameters").locator(".state")).to_contain_text("No draft")
    await expect(olga.row(WEIGHT).locator(".beside")).to_contain_text("otto has set 21 meanwhile")
    await olga.page.keyboard.type(".5")
    await expect(olga.box(WEIGHT)).to_have_value("17.5")
    await olga.page.keyboard.press("ControlOrMeta+Enter")
    await expect(olga.row(WEIGHT).locator(".fault")).to_be_visible()
    assert await _value(script, WEIGHT) == 21, "nobody has looked at the other value yet"
    await _press(olga.page, olga.row(WEIGHT).get_by_role("button", name="Keep mine"))
    await olga.box(WEIGHT).press("ControlOrMeta+Enter")
    await expect(otto.box(WEIGHT)).to_have_value("17.5")
    await olga.box(WEIGHT).press("ControlOrMeta+z")
    await expect(otto.box(WEIGHT)).to_have_value("21")

    await _leave_by_keys(olga)
    assert olga.complaints == []
    assert otto.complaints == []


async def _come_in_by_keys(olga: Visit) -> None:
    keys = olga.page.keyboard
    await olga.open()
    await olga.page.wait_for_selector("#name:focus")
    await keys.type("olga")
    await keys.press("Tab")
    await keys.type(PASSWORD)
    await keys.press("Enter")
    await olga.page.wait_for_selector("[role=option]")
    await keys.press("]")
    await olga.page.wait_for_selector("esp-inspector h2")


async def _drag_a_draft(olga: Visit) -> None:
    """Drag the slider of an actor's speed to its lower end, and see what it comes to."""
    await olga.show("Parameters")
    await olga.panel("parameters").get_by_role("button", name="Tune actor-1").click()
    await olga.slider(SPEED).scroll_into_view_if_needed()
    box = await olga.slider(SPEED).bounding_box()
    assert box is not None
    y = box["y"] + box["height"] / 2
    await olga.page.mouse.move(box["x"] + box["width"] / 2, y)
    await olga.page.mouse.down()
    await olga.page.mouse.move(box["x"] + 10, y, steps=8)
    await olga.page.mouse.up()
    state = olga.panel("parameters").locator(".state")
    await expect(state).to_contain_text("1 edit")
    await expect(state).to_contain_text("takes effect at once")


async def _leave_by_keys(olga: Visit) -> None:
    page = olga.page
    await _press(page, page.locator("esp-topbar summary", has_text="olga"), "Shift+Tab")
    await _press(page, page.get_by_role("button", name="Log out"))
    await page.wait_for_selector("#name:focus")
    assert "draft" not in page.url
    assert await page.locator("esp-map").count() == 0
    asked = await page.evaluate("fetch('../api/v1/me').then(({ status }) => status)")
    assert asked == 401


async def _press(page: Page, button: Locator, step: str = "Tab") -> None:
    """Go from control to control up to a button, and press it."""
    for _ in range(MOST_TABS):
        if await button.evaluate("(node) => node.matches(':focus')"):
            await page.keyboard.press("Enter")
            return
        await page.keyboard.press(step)
    pytest.fail(f"no key leads to {button}")


async def _value(script: Operator, name: str) -> Any:
    return (await script.values("actor-1"))[name]

"""The areas of the operators' page, their panels, links to what is shown, and the keyboard."""

import pytest
from playwright.async_api import Browser

from tests.browser.console.stage import Stage
from tests.browser.console.stage_answers import ACCOUNT, PASSWORD
from tests.browser.console.visit import Visit, visit_of

pytestmark = pytest.mark.asyncio(loop_scope="module")


async def test_a_layout_is_kept_for_the_account(visit: Visit) -> None:
    page = visit.page
    await visit.come_in()
    bar = page.get_by_role("separator", name="Width of the left area")
    before = int(await bar.get_attribute("aria-valuenow") or 0)
    await bar.focus()
    await page.keyboard.press("ArrowRight")
    await page.keyboard.press("ArrowRight")
    assert await bar.get_attribute("aria-valuenow") == str(before + 40)
    await page.click("esp-area.right summary")
    await page.click("esp-area.right button:has-text('Move to: left')")
    await page.wait_for_selector("esp-area.left esp-inspector")
    assert await page.locator("esp-area.right").count() == 0
    await page.reload()
    await page.wait_for_selector("esp-area.left esp-inspector")
    assert await bar.get_attribute("aria-valuenow") == str(before + 40)


async def test_a_panel_is_closed_and_opened_again(visit: Visit) -> None:
    page = visit.page
    await visit.come_in()
    await page.get_by_role("tab", name="Inspector").focus()
    await page.keyboard.press("Delete")
    await page.wait_for_selector("esp-inspector", state="detached")
    await page.click("summary:has-text('Panels')")
    await page.click("esp-topbar button:has-text('Inspector')")
    await page.wait_for_selector("esp-inspector")


async def test_a_link_shows_the_same_to_another_operator(
    visit: Visit, browser: Browser, server: Stage
) -> None:
    page = visit.page
    await visit.come_in()
    await page.click("[role=option]:has-text('Actor 7')")
    await page.wait_for_url("**#sel=main/actor-7*")
    other = await visit_of(browser, page.url, 1280, 720, "dark")
    await other.come_in()
    await other.page.wait_for_selector("esp-inspector h2:has-text('Actor 7')")
    assert PASSWORD not in other.page.url
    assert other.complaints == []


async def test_everything_goes_by_keyboard(visit: Visit) -> None:
    page = visit.page
    await visit.open()
    await page.wait_for_selector("#name:focus")
    await page.keyboard.type(ACCOUNT)
    await page.keyboard.press("Tab")
    await page.keyboard.type(PASSWORD)
    await page.keyboard.press("Enter")
    await page.wait_for_selector("[role=option]")
    await page.keyboard.press("/")
    await page.keyboard.type("wanderers")
    await page.keyboard.press("ArrowDown")
    await page.keyboard.press("ArrowDown")
    await page.keyboard.press("Enter")
    await page.wait_for_selector("esp-inspector h2:has-text('Actor 4')")
    await page.keyboard.press("]")
    await page.wait_for_selector("esp-inspector h2:has-text('Actor 5')")
    await page.keyboard.press("f")
    await page.wait_for_selector("esp-inspector button[aria-pressed=true]")
    await page.keyboard.press("F6")
    await page.keyboard.press("?")
    await page.wait_for_selector("dialog[open]")
    await page.keyboard.press("Escape")
    await page.wait_for_selector("dialog[open]", state="detached")
    await page.keyboard.press("Escape")
    await page.wait_for_selector("text=Choose somebody on the map")


async def test_a_narrow_page_has_tabs_instead_of_columns(
    browser: Browser, stage: tuple[str, Stage]
) -> None:
    visit = await visit_of(browser, stage[0], 360, 740, "light")
    await visit.come_in()
    page = visit.page
    assert await page.locator("esp-area").count() == 1
    await page.get_by_role("tab", name="Everybody").click()
    await page.click("[role=option]:has-text('Actor 3')")
    await page.get_by_role("tab", name="Inspector").click()
    await page.wait_for_selector("esp-inspector h2:has-text('Actor 3')")
    wider = "document.documentElement.scrollWidth > innerWidth"
    assert not await page.evaluate(wider)
    assert visit.complaints == []

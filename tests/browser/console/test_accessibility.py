"""Axe finds nothing in the operators' page, in both colour schemes and at three sizes."""

import pytest
from playwright.async_api import Browser

from tests.browser.console.stage import Stage
from tests.browser.console.visit import AXE, visit_of

pytestmark = pytest.mark.asyncio(loop_scope="module")


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("size", [(360, 740), (1280, 720), (2560, 1440)])
async def test_axe_finds_nothing(
    browser: Browser, stage: tuple[str, Stage], scheme: str, size: tuple[int, int]
) -> None:
    if not AXE.is_file():
        pytest.skip("axe-core is not installed; run: make client")
    visit = await visit_of(browser, stage[0], *size, scheme)
    page = visit.page
    await visit.open()
    await page.wait_for_selector("#name")
    assert await visit.findings() == []
    await visit.log_in()
    await page.wait_for_selector("canvas.map[data-ms]")
    assert await visit.findings() == []
    await page.click("summary:has-text('Layers')")
    await page.keyboard.press("]")
    if size[0] < 900:
        await page.get_by_role("tab", name="Inspector").click()
    await page.wait_for_selector("text=keeping right")
    assert await visit.findings() == []
    if size[0] < 900:
        await page.get_by_role("tab", name="Everybody").click()
        assert await visit.findings() == []
    await page.keyboard.press("?")
    assert await visit.findings() == []

"""A building of two storeys: the map shows one at a time."""

from collections.abc import AsyncIterator
from pathlib import Path
from typing import Final

import pytest
import pytest_asyncio
from playwright.async_api import Browser

from tests.browser.test_layout import CONTROLS, PANELS, boxes_of, overlapping, visit
from tests.browser.worlds import world

pytestmark = [pytest.mark.browser, pytest.mark.asyncio(loop_scope="module")]

SCENE: Final = Path(__file__).parent / "two_storeys.json"
SIZES = pytest.mark.parametrize(("width", "height"), [(1280, 720), (390, 844), (360, 640)])


@pytest_asyncio.fixture(scope="module", loop_scope="module")
async def house() -> AsyncIterator[str]:
    """Address of a running world with a storey above the ground."""
    async with world(scene=SCENE) as address:
        yield address


@SIZES
async def test_the_switch_lies_apart_from_everything(
    browser: Browser, house: str, width: int, height: int
) -> None:
    visitor = await visit(browser, house, width, height)
    assert len(await boxes_of(visitor, "#storeys button")) == 2
    for opener in ("#people-open", "#plan-open"):
        await visitor.page.click(opener)
        boxes = await boxes_of(visitor, f"{CONTROLS}, {PANELS}")
        assert list(overlapping(boxes)) == [], opener
    assert await visitor.complaints() == []
    await visitor.page.context.close()


async def test_another_storey_is_shown_on_demand(browser: Browser, house: str) -> None:
    visitor = await visit(browser, house, 1280, 720)
    ground, above = (
        visitor.page.get_by_role("button", name=name) for name in ("Ground floor", "Floor 1")
    )
    for button, other in ((above, ground), (ground, above)):
        await button.click()
        assert await button.get_attribute("aria-pressed") == "true"
        assert await other.get_attribute("aria-pressed") == "false"
    await visitor.page.context.close()


async def test_doors_are_known(browser: Browser, house: str) -> None:
    visitor = await visit(browser, house, 1280, 720)
    doors = (await visitor.look())["doors"]
    assert doors == {"Gate": False}
    await visitor.page.context.close()

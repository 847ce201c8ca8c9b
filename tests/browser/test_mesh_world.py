"""A building that comes as a mesh: fetched, drawn, mapped floor by floor, walked on by clicks."""

from collections.abc import AsyncIterator
from functools import partial
from pathlib import Path
from typing import Final

import pytest
import pytest_asyncio
from playwright.async_api import Browser, BrowserContext

from esplanade.planning.scene.scene_file import read_scene
from tests.browser.test_layout import CONTROLS, boxes_of, overlapping, shares_of_colours, visit
from tests.browser.visitor import Visitor, moved_m, own
from tests.browser.worlds import entered_at, world

pytestmark = [pytest.mark.browser, pytest.mark.asyncio(loop_scope="module")]

SCENE: Final = Path(__file__).parents[2] / "scenes" / "pavilion.json"
MEADOW: Final = (0.0, -14.0, 0.0)
BALCONY: Final = (0.0, -6.0)
UPPER_M: Final = 3.8
WALKED_M: Final = 1.0


@pytest_asyncio.fixture(scope="module", loop_scope="module")
async def meadow(tmp_path_factory: pytest.TempPathFactory) -> AsyncIterator[str]:
    """Address of the pavilion's world, where people come in beside it."""
    scene = entered_at(read_scene(SCENE), MEADOW, tmp_path_factory.mktemp("meadow"))
    async with world(scene=scene, actors=2) as address:
        yield address


@pytest_asyncio.fixture(loop_scope="module")
async def balcony(tmp_path: Path) -> AsyncIterator[str]:
    """The same, where people come in on its upper floor."""
    scene = entered_at(read_scene(SCENE), (*BALCONY, UPPER_M), tmp_path)
    async with world(scene=scene, actors=2) as address:
        yield address


@pytest.mark.parametrize(("width", "height"), [(1280, 720), (390, 844)], ids=["desk", "phone"])
async def test_it_is_drawn_and_its_floors_can_be_chosen(
    browser: Browser, meadow: str, width: int, height: int
) -> None:
    visitor = await visit(browser, meadow, width, height)
    frames = (await visitor.look())["frames"]
    await visitor.until(lambda view: view["frames"] > frames + 5)
    assert max(await shares_of_colours(visitor)) < 0.5
    boxes = await boxes_of(visitor, CONTROLS)
    assert list(overlapping(boxes)) == []
    assert len(await boxes_of(visitor, "#storeys button")) == 2
    upper = visitor.page.get_by_role("button", name="Floor 1")
    await upper.click()
    assert await upper.get_attribute("aria-pressed") == "true"
    assert await visitor.complaints() == []
    await visitor.page.context.close()


async def test_a_click_on_the_mesh_walks_there(meadow: str, profile: BrowserContext) -> None:
    ann = await Visitor.arrive(profile, meadow)
    await ann.join("Ann")
    before = own(await ann.look())
    assert before is not None
    await ann.page.mouse.click(420, 480)
    await ann.until(lambda view: moved_m(view, before) > WALKED_M)
    assert await ann.complaints() == []


async def test_who_is_upstairs_stays_there(balcony: str, profile: BrowserContext) -> None:
    ann = await Visitor.arrive(profile, balcony)
    await ann.join("Ann")
    before = own(await ann.look())
    assert before is not None
    assert before["pose"]["z"] == pytest.approx(UPPER_M, abs=0.05)
    here = ann.page.get_by_role("button", name="Floor 1")
    await here.locator("xpath=self::*[@aria-pressed='true']").wait_for()
    # Towards the railing, and along it: it holds.
    await ann.page.keyboard.down("s")
    await ann.page.keyboard.down("a")
    await ann.until(partial(has_walked, before))
    await ann.page.keyboard.up("a")
    await ann.page.keyboard.up("s")
    now = own(await ann.look())
    assert now is not None
    assert now["pose"]["z"] == pytest.approx(UPPER_M, abs=0.05)
    assert await ann.complaints() == []


def has_walked(before: dict[str, object], view: dict[str, object]) -> bool:
    return moved_m(view, before) > WALKED_M

"""The card of another person: find and follow them, and see whether they are away."""

import math
from collections.abc import AsyncIterator
from typing import Any

import pytest
import pytest_asyncio
from playwright.async_api import BrowserContext, expect

from esplanade.server.app import Running
from tests.browser.visitor import View, Visitor, avatar_of, own, place_of
from tests.browser.worlds import PROMENADE, PROMENADE_END, entered_at, served
from tests.patience import PATIENCE_S

pytestmark = [pytest.mark.browser, pytest.mark.asyncio(loop_scope="module")]

expect.set_options(timeout=1e3 * PATIENCE_S)

HIDE = """(state) => {
  Object.defineProperty(document, "visibilityState", { configurable: true, get: () => state });
  document.dispatchEvent(new Event("visibilitychange"));
}"""


@pytest_asyncio.fixture(scope="module", loop_scope="module")
async def server(tmp_path_factory: pytest.TempPathFactory) -> AsyncIterator[Running]:
    """A world in which everybody comes in at one end of a promenade."""
    scene = entered_at(PROMENADE, PROMENADE_END, tmp_path_factory.mktemp("promenade"))
    async with served(scene=scene) as made:
        yield made


async def met(
    server: Running, profile: BrowserContext, other_profile: BrowserContext, *names: str
) -> tuple[Visitor, Visitor, int]:
    """Two people of these names, and the id of the second, whom the first sees."""
    url = f"http://127.0.0.1:{server.port}/"
    ann, ben = await Visitor.arrive(profile, url), await Visitor.arrive(other_profile, url)
    await ann.join(names[0])
    await ben.join(names[1])
    ben_id = (await ben.look())["id"]
    await ann.until(lambda view: avatar_of(view, ben_id) is not None)
    return ann, ben, ben_id


async def open_card(visitor: Visitor, name: str) -> None:
    await visitor.page.click("#people-open")
    await visitor.page.locator("#people-list li.person button", has_text=name).click()
    await visitor.page.click("#people-open")


def apart_m(view: View, other_id: int) -> float:
    here, there = own(view), avatar_of(view, other_id)
    assert here is not None
    return math.dist(place_of(here), place_of(there)) if there else math.inf


async def test_a_person_is_followed_until_one_walks_on_one_s_own(
    server: Running, profile: BrowserContext, other_profile: BrowserContext
) -> None:
    ann, ben, ben_id = await met(server, profile, other_profile, "Ann", "Ben")
    await open_card(ann, "Ben")
    await ann.page.click("#person-follow")
    await expect(ann.page.locator("#following")).to_contain_text("You follow Ben.")
    start = own(await ann.look())
    await ben.page.keyboard.down("s")
    await ann.until(lambda view: walked_m(view, start) > 6.0)
    await ben.page.keyboard.up("s")
    await ann.until(lambda view: apart_m(view, ben_id) < 1.7 and stands(view))
    await ann.page.locator("#picture").focus()
    await ann.page.keyboard.down("w")
    await expect(ann.page.locator("#following")).to_be_hidden()
    await ann.page.keyboard.up("w")
    await expect(ann.page.locator("#person-follow")).to_have_attribute("aria-pressed", "false")
    assert await ann.complaints() == []
    await ben.page.close()


async def test_who_is_away_is_marked_in_list_label_and_card(
    server: Running, profile: BrowserContext, other_profile: BrowserContext
) -> None:
    ann, ben, ben_id = await met(server, profile, other_profile, "Cid", "Dan")
    await open_card(ann, "Dan")
    await ben.page.evaluate(HIDE, "hidden")
    await ann.until(lambda view: away(view, ben_id))
    await expect(ann.page.locator("#person-where")).to_contain_text("away")
    await expect(ann.page.locator(".label.away")).to_contain_text("Dan · away")
    await ann.page.click("#people-open")
    await expect(ann.page.locator("#people-list button", has_text="Dan")).to_contain_text("away")
    await ben.page.evaluate(HIDE, "visible")
    await ann.until(lambda view: not away(view, ben_id))
    await expect(ann.page.locator(".label.away")).to_have_count(0)
    # A page that is gone leaves an avatar that waits for its person.
    await ben.page.close()
    await ann.until(lambda view: away(view, ben_id))


async def test_a_click_on_the_map_walks_there_or_opens_the_card(
    server: Running, profile: BrowserContext, other_profile: BrowserContext
) -> None:
    ann, ben, ben_id = await met(server, profile, other_profile, "Eva", "Fay")
    start = own(await ann.look())
    await ann.page.click("#minimap")  # its middle
    await ann.until(lambda view: walked_m(view, start) > 3.0)
    await ann.page.keyboard.press("s")
    map_x, map_y = await spot_of(ann, ben_id)
    await ann.page.mouse.click(map_x, map_y)
    await expect(ann.page.locator("#person-name")).to_have_text("Fay")
    assert await ann.complaints() == []
    await ben.page.close()


async def spot_of(visitor: Visitor, other_id: int) -> tuple[float, float]:
    """Where somebody is on the map, pixels of the page."""
    box = await visitor.page.locator("#minimap").bounding_box()
    assert box is not None
    other: dict[str, Any] | None = avatar_of(await visitor.look(), other_id)
    assert other is not None
    left, top = await visitor.page.evaluate(
        """([x, y, x0, y0, x1, y1]) => {
          const map = document.querySelector("#minimap");
          const [width, height] = [map.clientWidth, map.clientHeight];
          const scale = Math.min(width / (x1 - x0), height / (y1 - y0));
          return [(width - (x1 - x0) * scale) / 2 + (x - x0) * scale,
                  (height - (y1 - y0) * scale) / 2 + (y1 - y) * scale];
        }""",
        [*place_of(other), *PROMENADE.bounds],
    )
    return box["x"] + left, box["y"] + top


def walked_m(view: View, start: dict[str, Any] | None) -> float:
    now = own(view)
    assert now is not None
    assert start is not None
    return math.dist(place_of(now), place_of(start))


def stands(view: View) -> bool:
    now = own(view)
    return now is not None and now["pose"]["speed"] == 0.0


def away(view: View, avatar_id: int) -> bool:
    avatar = avatar_of(view, avatar_id)
    return avatar is not None and avatar["away"]

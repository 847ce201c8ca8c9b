"""The page on a desk and on a phone: what there is to press lies within reach and apart."""

import base64
from collections.abc import Iterator
from itertools import combinations
from typing import Any

import pytest
from playwright.async_api import Browser

from tests.browser.visitor import Visitor

pytestmark = [pytest.mark.browser, pytest.mark.asyncio(loop_scope="module")]

SIZES = pytest.mark.parametrize(
    ("width", "height"), [(1280, 720), (390, 844), (360, 640)], ids=["desk", "phone", "small phone"]
)
CONTROLS = (
    "#status, #top button, #minimap, #storeys button, "
    "#chat-toggle, #stick, #chat-line, #chat-form button"
)
PANELS = "#people, #plan"
THUMB_PX = 44.0
MOST_OF_ONE_COLOUR = 0.4
LEAST_COLOURS = 700
"""Of 32 768 that are told apart. Without the picture the page has fewer than 500."""

_BOXES = """(selector) => [...document.querySelectorAll(selector)]
  .map((e) => ({ name: e.id || e.textContent, box: e.getBoundingClientRect().toJSON() }))
  .filter(({ box }) => box.width > 0)"""

_COLOURS = """async (picture) => {
  const image = new Image();
  image.src = `data:image/png;base64,${picture}`;
  await image.decode();
  const canvas = document.createElement("canvas");
  canvas.width = image.width;
  canvas.height = image.height;
  const pen = canvas.getContext("2d");
  pen.drawImage(image, 0, 0);
  const { data } = pen.getImageData(0, 0, image.width, image.height);
  const counts = new Map();
  for (let i = 0; i < data.length; i += 4) {
    const colour = ((data[i] >> 3) << 10) | ((data[i + 1] >> 3) << 5) | (data[i + 2] >> 3);
    counts.set(colour, (counts.get(colour) ?? 0) + 1);
  }
  return [...counts.values()].map((count) => (4 * count) / data.length);
}"""


async def visit(browser: Browser, url: str, width: int, height: int) -> Visitor:
    narrow = width < 640
    context = await browser.new_context(
        viewport={"width": width, "height": height}, has_touch=narrow, is_mobile=narrow
    )
    visitor = await Visitor.arrive(context, url)
    await visitor.join("Ann")
    return visitor


async def boxes_of(visitor: Visitor, selector: str) -> list[dict[str, Any]]:
    """Names and boxes of what is seen of the page's elements."""
    boxes: list[dict[str, Any]] = await visitor.page.evaluate(_BOXES, selector)
    return boxes


async def shares_of_colours(visitor: Visitor) -> list[float]:
    """The share of the page's picture that each colour takes, for all colours in it."""
    picture = base64.b64encode(await visitor.page.screenshot()).decode()
    shares: list[float] = await visitor.page.evaluate(_COLOURS, picture)
    return shares


def overlapping(boxes: list[dict[str, Any]]) -> Iterator[str]:
    for a, b in combinations(boxes, 2):
        one, other = a["box"], b["box"]
        across = min(one["right"], other["right"]) - max(one["left"], other["left"])
        down = min(one["bottom"], other["bottom"]) - max(one["top"], other["top"])
        if across > 0 and down > 0:
            yield f"{a['name']} and {b['name']}"


@SIZES
async def test_controls_lie_apart_and_within_the_window(
    browser: Browser, url: str, width: int, height: int
) -> None:
    visitor = await visit(browser, url, width, height)
    boxes = await boxes_of(visitor, CONTROLS)
    assert len(boxes) >= 6
    assert list(overlapping(boxes)) == []
    outside = [
        each["name"]
        for each in boxes
        if each["box"]["left"] < 0
        or each["box"]["top"] < 0
        or each["box"]["right"] > width
        or each["box"]["bottom"] > height
    ]
    assert outside == []
    await visitor.page.context.close()


@SIZES
async def test_open_panels_cover_no_control(
    browser: Browser, url: str, width: int, height: int
) -> None:
    visitor = await visit(browser, url, width, height)
    for opener in ("#people-open", "#plan-open"):
        await visitor.page.click(opener)
        boxes = await boxes_of(visitor, f"{CONTROLS}, {PANELS}")
        assert list(overlapping(boxes)) == [], opener
    await visitor.page.context.close()


async def test_thumbs_have_room_on_a_phone(browser: Browser, url: str) -> None:
    visitor = await visit(browser, url, 390, 844)
    boxes = await boxes_of(visitor, "button")
    assert [b["name"] for b in boxes if b["box"]["height"] < THUMB_PX] == []
    await visitor.page.context.close()


async def test_the_stick_walks_on_a_phone(browser: Browser, url: str) -> None:
    visitor = await visit(browser, url, 390, 844)
    stick = await visitor.page.locator("#stick").bounding_box()
    assert stick is not None
    x, y = stick["x"] + stick["width"] / 2, stick["y"] + stick["height"] / 2
    await visitor.page.mouse.move(x, y)
    await visitor.page.mouse.down()
    await visitor.page.mouse.move(x, y + stick["height"] / 2.5)
    await visitor.until(
        lambda view: any(a["own"] and a["pose"]["speed"] > 1 for a in view["avatars"])
    )
    await visitor.page.mouse.up()
    await visitor.until(
        lambda view: any(a["own"] and a["pose"]["speed"] == 0 for a in view["avatars"])
    )
    await visitor.page.context.close()


@SIZES
async def test_a_picture_is_drawn(browser: Browser, url: str, width: int, height: int) -> None:
    visitor = await visit(browser, url, width, height)
    frames = (await visitor.look())["frames"]
    await visitor.until(lambda view: view["frames"] > frames + 5)
    shares = await shares_of_colours(visitor)
    assert len(shares) > LEAST_COLOURS
    assert max(shares) < MOST_OF_ONE_COLOUR
    assert await visitor.complaints() == []
    await visitor.page.context.close()

"""The page on a desk and on a phone: what there is to press lies within reach and apart."""

import base64
from collections.abc import Iterator
from itertools import combinations
from typing import Any, Final

import pytest
from playwright.async_api import Browser

from tests.browser.visitor import Visitor

pytestmark = [pytest.mark.browser, pytest.mark.asyncio(loop_scope="module")]

SIZES = pytest.mark.parametrize(
    ("width", "height"), [(1280, 720), (390, 844), (360, 640)], ids=["desk", "phone", "small phone"]
)
CONTROLS = (
    "#status, #top button, #minimap, #storeys button, "
    "#chat-toggle, #gestures-toggle, #stick, #chat-line, #chat-form button"
)
PANELS = "#people, #plan, #person, #told, #gestures"
THUMB_PX = 44.0
MOUSE_PX = 38.0

DESKS: Final = [(1280, 720), (1366, 768), (1920, 1080), (2560, 1440)]
ZOOMS: Final = [1.0, 1.5, 2.0, 3.0]
PHONES: Final = [(320, 568), (568, 320), (390, 844), (844, 390), (768, 1024), (1024, 768)]
WINDOWS: Final = sorted({(round(w / z), round(h / z)) for w, h in DESKS for z in ZOOMS})
"""A page that is zoomed has a window with fewer pixels of the page."""
MOST_OF_ONE_COLOUR = 0.4
LEAST_COLOURS = 700
"""Of 32 768 that are told apart. Without the picture the page has fewer than 500."""

_BOXES = """(selector) => [...document.querySelectorAll(selector)]
  .map((e) => ({ name: e.id || e.textContent, box: e.getBoundingClientRect().toJSON() }))
  .filter(({ box }) => box.width > 0)"""

# Scripts that open what a person may have open.
OPENINGS: Final = {
    "people": "() => document.querySelector('#people-open').click()",
    "plan": "() => document.querySelector('#plan-open').click()",
    "chat": """() => { const toggle = document.querySelector('#chat-toggle');
      if (toggle.checkVisibility()) toggle.click(); }""",
    "gestures": "() => document.querySelector('#gestures-toggle').click()",
    "told": """() => { for (const id of ['banner', 'pace', 'following', 'invitation', 'shared']) {
      const told = document.getElementById(id);
      if (id === 'banner' || id === 'pace')
        told.textContent = 'The connection was lost. Coming back by itself…';
      told.hidden = false; } }""",
    "person": "() => { document.querySelector('#person').hidden = false; }",
    "report": """() => { document.querySelector('#person').hidden = false;
      document.querySelector('#person-report').open = true; }""",
}
CLOSED: Final = """() => {
  for (const opener of document.querySelectorAll('[aria-expanded="true"]')) opener.click();
  document.querySelector('#person-report').open = false;
  for (const id of ['banner', 'pace', 'following', 'invitation', 'shared', 'person'])
    document.getElementById(id).hidden = true;
}"""

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


@pytest.mark.parametrize("locale", ["en-US", "de-DE"])
@pytest.mark.parametrize(
    ("sizes", "touch"), [(WINDOWS, False), (PHONES, True)], ids=["mouse", "touch"]
)
async def test_no_control_covers_another_whatever_the_window(
    browser: Browser, url: str, sizes: list[tuple[int, int]], touch: bool, locale: str
) -> None:
    """With each panel open, with the chat open, and with something told; German has long words."""
    width, height = sizes[-1]
    context = await browser.new_context(
        viewport={"width": width, "height": height},
        has_touch=touch,
        is_mobile=touch,
        locale=locale,
    )
    visitor = await Visitor.arrive(context, url)
    await visitor.join("Ann")
    faults = []
    for width, height in sizes:
        await visitor.page.set_viewport_size({"width": width, "height": height})
        for state in ("", *OPENINGS):
            if state:
                await visitor.page.evaluate(OPENINGS[state])
            faults += [
                f"{width}x{height} {state}: {fault}"
                for fault in await faults_of(visitor, width, height, touch=touch)
            ]
            if state:
                await visitor.page.evaluate(CLOSED)
    assert faults == []
    await context.close()


async def faults_of(visitor: Visitor, width: int, height: int, *, touch: bool) -> list[str]:
    """Whatever covers something else, lies outside of the window, or is too small to be hit."""
    boxes = await boxes_of(visitor, f"{CONTROLS}, {PANELS}")
    assert len(boxes) >= 4
    faults = list(overlapping(boxes))
    for each in boxes:
        box = each["box"]
        if min(box["left"], box["top"]) < 0 or box["right"] > width or box["bottom"] > height:
            faults.append(f"{each['name']} is outside")
    least_px = THUMB_PX if touch else MOUSE_PX
    buttons = await boxes_of(
        visitor, "#top button, #chat-toggle, #gestures-toggle, #chat-form button"
    )
    faults += [f"{b['name']} is low" for b in buttons if b["box"]["height"] < least_px]
    return faults


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

"""Gestures by key, by mouse and by touch, seen and told in words."""

import time
from typing import Final

import pytest
from playwright.async_api import Browser, BrowserContext, expect

from tests.browser.visitor import View, Visitor, avatar_of, own
from tests.patience import PATIENCE_S

pytestmark = [pytest.mark.browser, pytest.mark.asyncio(loop_scope="module")]

expect.set_options(timeout=1e3 * PATIENCE_S)

AGAIN_S: Final = 10.0
"""A key whose gesture was not seen for so long is pressed again."""


def gestures(view: View, avatar_id: int) -> bool:
    avatar = avatar_of(view, avatar_id)
    return avatar is not None and avatar["gesturing"]


async def raise_a_hand(ann: Visitor, ben: Visitor, ann_id: int) -> None:
    """Press Ann's key until both pages tell of it while Ben sees it.

    People press it again whose line was cut; and a busy machine may draw a picture less often than
    a gesture lasts.

    Raises
    ------
    AssertionError
        It was not seen while a test waits.
    """
    own, others = ann.page.locator("#captions"), ben.page.locator("#captions")
    label = ben.page.locator(".label .spoken", has_text="raises a hand")
    deadline_s = time.monotonic() + PATIENCE_S
    while True:
        await ann.page.keyboard.press("6")
        try:
            await expect(own).to_have_text("You raise a hand.", timeout=1e3 * AGAIN_S)
            await ben.until(lambda view: gestures(view, ann_id), AGAIN_S)
            await expect(others).to_have_text("Ann raises a hand.", timeout=1e3 * AGAIN_S)
            await expect(label).to_be_visible(timeout=1e3 * AGAIN_S)
        except AssertionError:
            if time.monotonic() > deadline_s:
                raise
        else:
            return


async def test_a_wave_by_key_is_seen_and_told_to_others(
    url: str, profile: BrowserContext, other_profile: BrowserContext
) -> None:
    ann, ben = await Visitor.arrive(profile, url), await Visitor.arrive(other_profile, url)
    await ann.join("Ann")
    await ben.join("Ben")
    ann_id = (await ann.look())["id"]
    await ben.until(lambda view: avatar_of(view, ann_id) is not None)
    await raise_a_hand(ann, ben, ann_id)
    # Digits in a line of chat are what they are.
    await ann.page.fill("#chat-line", "")
    await ann.page.focus("#chat-line")
    await ann.page.keyboard.type("1")
    assert await ann.page.input_value("#chat-line") == "1"
    await expect(ann.page.locator("#captions")).to_have_text("You raise a hand.")
    assert await ann.complaints() == []
    assert await ben.complaints() == []


async def test_the_menu_works_by_keyboard_alone(url: str, profile: BrowserContext) -> None:
    ann = await Visitor.arrive(profile, url)
    await ann.join("Ann")
    await ann.page.keyboard.press("g")
    await expect(ann.page.locator("#gestures button").first).to_be_focused()
    await ann.page.keyboard.press("Tab")
    await ann.page.keyboard.press("Enter")
    await expect(ann.page.locator("#captions")).to_have_text("You nod.")
    await ann.page.keyboard.press("Escape")
    await expect(ann.page.locator("#gestures")).to_be_hidden()
    await expect(ann.page.locator("#gestures-toggle")).to_be_focused()


async def test_the_menu_works_by_touch_and_moves_little_where_that_is_wanted(
    browser: Browser, url: str
) -> None:
    context = await browser.new_context(
        viewport={"width": 390, "height": 844},
        has_touch=True,
        is_mobile=True,
        reduced_motion="reduce",
    )
    ann = await Visitor.arrive(context, url)
    await ann.join("Ann")
    await ann.page.tap("#gestures-toggle")
    await ann.page.get_by_role("button", name="Clap").tap()
    await ann.until(lambda view: (own(view) or {})["gesturing"])
    await expect(ann.page.locator("#captions")).to_have_text("You clap.")
    assert await ann.complaints() == []
    await context.close()

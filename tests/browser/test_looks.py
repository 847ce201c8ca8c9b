"""Looks: chosen at the door and later, by keyboard and by touch, seen by others and kept."""

from typing import Any

import pytest
from playwright.async_api import Browser, BrowserContext, expect

from tests.browser.visitor import View, Visitor, avatar_of, own
from tests.patience import PATIENCE_S

pytestmark = [pytest.mark.browser, pytest.mark.asyncio(loop_scope="module")]

expect.set_options(timeout=1e3 * PATIENCE_S)

STATURE = 5


def look_of(view: View, avatar_id: int) -> list[int] | None:
    avatar = avatar_of(view, avatar_id)
    return None if avatar is None else avatar["look"]


async def test_a_look_is_chosen_by_keyboard_and_seen_by_others(
    url: str, profile: BrowserContext, other_profile: BrowserContext
) -> None:
    ann, ben = await Visitor.arrive(profile, url), await Visitor.arrive(other_profile, url)
    await ben.join("Ben")
    await ann.page.focus("#join-look summary")
    await ann.page.keyboard.press("Enter")
    await expect(ann.page.locator("#look-figure canvas")).to_be_visible()
    await ann.page.get_by_label("red").first.check()
    await ann.page.get_by_label("shaven").focus()
    await ann.page.keyboard.press("Space")
    await ann.page.keyboard.press("ArrowLeft")
    await expect(ann.page.get_by_label("curls")).to_be_checked()
    await ann.page.focus("#look-stature")
    await ann.page.keyboard.press("Home")
    await ann.page.keyboard.press("ArrowRight")
    await expect(ann.page.locator("#look-stature-said")).to_have_text("151 cm")
    await ann.join("Ann")
    seen = own(await ann.look())
    assert seen is not None
    chosen = seen["look"]
    assert (chosen[0], chosen[2], chosen[STATURE]) == (1, 4, 151)
    await ben.until(lambda view: look_of(view, seen["id"]) == chosen)
    # Nothing is drawn of the figure that nobody sees.
    await expect(ann.page.locator("#look-figure canvas")).to_have_count(0)

    await ann.page.keyboard.press("g")
    await ann.page.focus("#look-open")
    await ann.page.keyboard.press("Enter")
    await expect(ann.page.locator("#look-figure canvas")).to_be_visible()
    await expect(ann.page.get_by_label("curls")).to_be_checked()
    await ann.page.get_by_label("long").check()
    await ann.page.keyboard.press("Enter")
    await expect(ann.page.locator("#look")).to_be_hidden()
    longhaired = [*chosen[:2], 2, *chosen[3:]]
    await ben.until(lambda view: look_of(view, seen["id"]) == longhaired)
    # It is kept in the browser, and an avatar that is taken up again has it.
    await ann.page.reload()
    await ann.until(lambda view: look_of(view, seen["id"]) == longhaired)
    assert await ann.complaints() == []
    assert await ben.complaints() == []


async def test_a_look_that_is_only_tried_on_is_not_worn(url: str, profile: BrowserContext) -> None:
    ann = await Visitor.arrive(profile, url)
    await ann.join("Ann")
    before = (own(await ann.look()) or {})["look"]
    await ann.page.click("#gestures-toggle")
    await ann.page.click("#look-open")
    await ann.page.click("#look-surprise")
    await ann.page.click("#look-cancel")
    await expect(ann.page.locator("#look")).to_be_hidden()
    await ann.page.click("#look-open")
    assert await checked(ann) == before[:STATURE]
    assert (own(await ann.look()) or {})["look"] == before


async def test_the_figure_shows_what_is_chosen_by_touch(browser: Browser, url: str) -> None:
    context = await browser.new_context(
        viewport={"width": 390, "height": 844},
        has_touch=True,
        is_mobile=True,
        reduced_motion="reduce",
    )
    ann = await Visitor.arrive(context, url)
    first = await stored(ann)
    await ann.page.tap("#join-look summary")
    figure = ann.page.locator("#look-figure")
    await expect(figure.locator("canvas")).to_be_visible()
    pictures = []
    for shirt in ("red", "blue"):
        await ann.page.locator("#look-parts fieldset").first.get_by_label(shirt).tap()
        await ann.page.wait_for_function(
            "() => new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame("
            "() => drawn(true))))"
        )
        pictures.append(await figure.screenshot())
    assert pictures[0] != pictures[1]
    await ann.join("Ann")
    worn = (own(await ann.look()) or {})["look"]
    assert worn == await stored(ann) == [2, *first[1:]]
    assert await ann.complaints() == []
    await context.close()


async def stored(visitor: Visitor) -> Any:
    """The look that the browser keeps."""
    return await visitor.page.evaluate("() => JSON.parse(localStorage.getItem('esplanade.look'))")


async def checked(visitor: Visitor) -> list[int]:
    """The numbers of the choices that the editor shows."""
    found: list[int] = await visitor.page.evaluate(
        "() => [...document.querySelectorAll('#look-parts input:checked')]"
        ".map((radio) => Number(radio.value))"
    )
    return found

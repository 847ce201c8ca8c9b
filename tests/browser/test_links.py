"""Links to places and people, leaving, and what is said of the surroundings."""

import re

import pytest
from playwright.async_api import Browser, BrowserContext, expect

from tests.browser.visitor import Visitor, avatar_of, own
from tests.patience import PATIENCE_S

pytestmark = [pytest.mark.browser, pytest.mark.asyncio(loop_scope="module")]

expect.set_options(timeout=1e3 * PATIENCE_S)


async def test_a_link_to_a_person_asks_whether_to_follow_them(
    url: str, profile: BrowserContext, other_profile: BrowserContext
) -> None:
    ann = await Visitor.arrive(profile, url)
    await ann.join("Ann")
    ben = await Visitor.arrive(other_profile, f"{url}#follow=Ann")
    await ben.join("Ben")
    await expect(ben.page.locator("#invitation")).to_contain_text("leads to Ann")
    await ben.page.click("#invitation-go")
    await expect(ben.page.locator("#following")).to_contain_text("You follow Ann.")
    await ben.page.click("#following-end")
    await expect(ben.page.locator("#following")).to_be_hidden()
    ann_id = (await ann.look())["id"]
    await ben.page.click("#people-open")
    await ben.page.click(f'#people-list [data-id="{ann_id}"]')
    await ben.page.click("#person-share")
    await expect(ben.page.locator("#shared-link")).to_have_value(f"{url}#follow=Ann")
    assert await ben.complaints() == []


async def test_the_place_where_one_is_is_shared(url: str, profile: BrowserContext) -> None:
    ann = await Visitor.arrive(profile, url)
    await ann.join("Ann")
    await ann.page.click("#share")
    link = await ann.page.input_value("#shared-link")
    found = re.fullmatch(re.escape(url) + r"#at=([\d.-]+),([\d.-]+),([\d.-]+)&look=90", link)
    assert found is not None, link
    here = own(await ann.look())
    assert here is not None
    assert float(found[1]) == pytest.approx(here["pose"]["x"], abs=0.06)
    assert float(found[2]) == pytest.approx(here["pose"]["y"], abs=0.06)
    await ann.page.click("#shared-close")
    await expect(ann.page.locator("#shared")).to_be_hidden()
    assert await ann.complaints() == []


async def test_whoever_leaves_is_gone_at_once_and_may_come_again(
    url: str, profile: BrowserContext, other_profile: BrowserContext
) -> None:
    ann, ben = await Visitor.arrive(profile, url), await Visitor.arrive(other_profile, url)
    await ann.join("Cid")
    await ben.join("Dan")
    cid_id = (await ann.look())["id"]
    await ben.until(lambda view: avatar_of(view, cid_id) is not None)
    await ann.page.click("#leave")
    await expect(ann.page.locator("#join-reason")).to_contain_text("You have left.")
    await ben.until(lambda view: avatar_of(view, cid_id) is None)
    await ann.page.reload()
    await expect(ann.page.locator("#join-name")).to_be_visible()
    await ann.join("Cid")
    assert (await ann.look())["id"] != cid_id
    assert await ann.complaints() == []


async def test_the_surroundings_are_said_on_request(
    url: str, profile: BrowserContext, other_profile: BrowserContext
) -> None:
    ann, ben = await Visitor.arrive(profile, url), await Visitor.arrive(other_profile, url)
    await ann.join("Eva")
    await ben.join("Fay")
    fay_id = (await ben.look())["id"]
    await ann.until(lambda view: avatar_of(view, fay_id) is not None)
    await ann.page.keyboard.press("l")
    await expect(ann.page.locator("#chat-log")).to_contain_text(re.compile(r"Fay, \d+ m, "))
    assert await ann.complaints() == []


async def test_the_page_has_more_contrast_for_those_who_want_it(browser: Browser, url: str) -> None:
    context = await browser.new_context(contrast="more", color_scheme="light")
    ann = await Visitor.arrive(context, url)
    style = "getComputedStyle(document.querySelector('#join'))"
    colours = await ann.page.evaluate(f"[{style}.backgroundColor, {style}.color]")
    assert colours == ["rgb(255, 255, 255)", "rgb(0, 0, 0)"]
    await context.close()

"""The first minutes of a person: they come in, talk, look for somebody, read the help."""

import math
from typing import Any, Final

import pytest
from playwright.async_api import Browser, BrowserContext, expect

from tests.browser.chromium import launched
from tests.browser.visitor import View, Visitor, own
from tests.patience import PATIENCE_S

pytestmark = [pytest.mark.browser, pytest.mark.asyncio(loop_scope="module")]

expect.set_options(timeout=1e3 * PATIENCE_S)

LOW: Final = {"width": 640, "height": 360}
"""A window of 1280 by 720 at twice its size."""


async def test_enter_opens_the_chat_after_a_click_on_the_ground(
    url: str, profile: BrowserContext
) -> None:
    ann = await Visitor.arrive(profile, url)
    await ann.join("Ann")
    await ann.page.mouse.click(640, 500)
    await ann.page.keyboard.press("Enter")
    await expect(ann.page.locator("#chat-line")).to_be_focused()
    await ann.page.keyboard.type("hello there")
    await ann.page.keyboard.press("Enter")
    await ann.page.locator("#chat-log li", has_text="hello there").wait_for()
    assert await ann.complaints() == []


async def test_enter_on_a_button_presses_that_button(url: str, profile: BrowserContext) -> None:
    ann = await Visitor.arrive(profile, url)
    await ann.join("Ann")
    await ann.page.focus("#people-open")
    await ann.page.keyboard.press("Enter")
    await expect(ann.page.locator("#people")).to_be_visible()
    await expect(ann.page.locator("#chat-line")).not_to_be_focused()


async def test_esc_at_the_door_leaves_nobody_outside(url: str, profile: BrowserContext) -> None:
    ann = await Visitor.arrive(profile, url)
    for _ in range(4):
        await ann.page.keyboard.press("Escape")
    await expect(ann.page.locator("#join-name")).to_be_visible()
    await ann.join("Ann")
    await expect(ann.page.locator("#join")).to_be_hidden()


async def test_a_name_that_nobody_sees_is_refused_in_words(
    url: str, profile: BrowserContext
) -> None:
    ann = await Visitor.arrive(profile, url)
    await ann.page.fill("#join-name", "   ")
    await ann.page.click("#join-button")
    await expect(ann.page.locator("#join-reason")).to_contain_text("give a name")
    await ann.page.fill("#join-name", "n" * 33)
    await ann.page.click("#join-button")
    await expect(ann.page.locator("#join-reason")).to_contain_text("1 character too long")
    await ann.join("Ann")


async def test_a_line_that_is_too_long_is_not_cut_in_silence(
    url: str, profile: BrowserContext
) -> None:
    ann = await Visitor.arrive(profile, url)
    await ann.join("Ann")
    await ann.page.fill("#chat-line", "x" * 304)
    await expect(ann.page.locator("#chat-fault")).to_contain_text("4 characters too long")
    await ann.page.press("#chat-line", "Enter")
    assert len(await ann.page.input_value("#chat-line")) == 304
    await ann.page.fill("#chat-line", "x" * 300)
    await expect(ann.page.locator("#chat-fault")).to_be_hidden()
    await ann.page.press("#chat-line", "Enter")
    await ann.page.locator("#chat-log li", has_text="x" * 300).wait_for()


async def test_addresses_that_are_said_are_links(url: str, profile: BrowserContext) -> None:
    ann = await Visitor.arrive(profile, url)
    await ann.join("Ann")
    said = "see https://example.org/a?b=1, or javascript:alert(1) <b>"
    await ann.page.fill("#chat-line", said)
    await ann.page.press("#chat-line", "Enter")
    line = ann.page.locator("#chat-log li", has_text="example.org")
    assert said in await line.inner_text()
    link = line.locator("a")
    assert await link.count() == 1
    assert await link.get_attribute("href") == "https://example.org/a?b=1"
    assert "noopener" in str(await link.get_attribute("rel"))


async def test_the_help_opens_at_its_beginning(url: str, profile: BrowserContext) -> None:
    ann = await Visitor.arrive(profile, url)
    await ann.join("Ann")
    await ann.page.set_viewport_size(LOW)  # type: ignore[arg-type]
    await ann.page.click("#help-open")
    assert await ann.page.evaluate("document.querySelector('#help').scrollTop") == 0
    top, bottom = await ann.page.evaluate(
        "(({top, bottom}) => [top, bottom])"
        "(document.querySelector('#help-title').getBoundingClientRect())"
    )
    assert 0 <= top < bottom <= LOW["height"]
    await expect(ann.page.locator("#help-title")).to_be_focused()


async def test_actors_are_found_among_many_people(url: str, profile: BrowserContext) -> None:
    ann = await Visitor.arrive(profile, url)
    await ann.join("Ann")
    view = await ann.until(lambda view: any(a["kind"] == "actor" for a in view["avatars"]))
    actor = next(a for a in view["avatars"] if a["kind"] == "actor")
    await ann.page.click("#people-open")
    await ann.page.locator("#people-list summary", has_text="People").click()
    await expect(ann.page.locator("#people-list li.own")).to_be_hidden()
    await expect(ann.page.locator("#people-list li.actor").first).to_be_visible()
    await ann.page.fill("#people-find", actor["name"].upper())
    await expect(ann.page.locator("#people-list li")).to_have_count(1)
    await ann.page.fill("#people-find", "nobody of that name")
    await expect(ann.page.locator("#people-list li")).to_have_count(0)


async def test_choosing_an_actor_turns_the_camera_to_it(url: str, profile: BrowserContext) -> None:
    ann = await Visitor.arrive(profile, url)
    await ann.join("Ann")
    await ann.page.click("#people-open")
    await ann.page.locator("#people-list li.actor button").first.click()
    yaw = "() => window.esplanade.cameraYaw"
    wanted = await ann.until(lambda view: view["plan"] is not None)
    seen = next(a for a in wanted["avatars"] if a["id"] == wanted["chosenId"])
    for _ in range(50):
        view = await ann.look()
        seen = next((a for a in view["avatars"] if a["id"] == wanted["chosenId"]), seen)
        off = off_axis(own(view), seen, await ann.page.evaluate(yaw))
        if off < 0.5:
            break
        await ann.page.wait_for_timeout(100)
    assert off < 0.5


async def test_the_first_view_is_at_people(url: str, profile: BrowserContext) -> None:
    """It goes to whoever is seen, wherever the gallery has its north."""
    ann = await Visitor.arrive(profile, url)
    await ann.join("Ann")
    here = await ann.until(lambda view: any(a["own"] for a in view["avatars"]))
    ben = await Visitor.arrive(profile, f"{url}#")
    await ben.join("Ben")
    view = await ben.until(lambda view: any(a["id"] == here["id"] for a in view["avatars"]))
    yaw = await ben.page.evaluate("() => window.esplanade.cameraYaw")
    off = [off_axis(own(view), a, yaw) for a in view["avatars"] if not a["own"]]
    assert min(off) < 0.6


async def test_the_reason_of_an_actor_names_a_place(url: str, profile: BrowserContext) -> None:
    ann = await Visitor.arrive(profile, url)
    await ann.join("Ann")
    await ann.page.click("#people-open")
    await ann.page.locator("#people-list li.actor button").first.click()
    await expect(ann.page.locator("#plan-behaviour")).to_contain_text("now to: ")


async def test_without_3d_a_map_is_the_picture(url: str) -> None:
    async with launched("--disable-3d-apis") as browser:
        context = await browser.new_context(viewport={"width": 1280, "height": 720})
        ann = await Visitor.arrive(context, url)
        await expect(ann.page.locator("#join-picture")).to_be_visible()
        await ann.join("Ann")
        before = own(await ann.look())
        assert before is not None
        await ann.page.mouse.click(640, 250)  # some metres to the north
        await ann.until(lambda view: northward_m(view, before) > 1.0)
        await ann.page.keyboard.down("s")
        walking = own(await ann.look())
        await ann.until(lambda view: northward_m(view, walking) < -0.5)
        await ann.page.keyboard.up("s")
        await ann.page.click("#people-open")
        await ann.page.locator("#people-list li.actor button").first.click()
        await ann.until(lambda view: view["plan"] is not None)
        await ann.page.fill("#chat-line", "flat but here")
        await ann.page.press("#chat-line", "Enter")
        await ann.page.locator("#chat-log li", has_text="flat but here").wait_for()
        assert await ann.complaints() == []


async def test_the_page_is_dark_for_those_who_want_it(browser: Browser, url: str) -> None:
    paper = {}
    for scheme in ("light", "dark"):
        context = await browser.new_context(color_scheme=scheme)  # type: ignore[arg-type]
        ann = await Visitor.arrive(context, url)
        paper[scheme] = await ann.page.evaluate(
            "getComputedStyle(document.querySelector('#join')).backgroundColor"
        )
        await context.close()
    assert paper["light"] == "rgb(250, 247, 241)"
    assert paper["dark"] == "rgb(34, 39, 45)"


def northward_m(view: View, before: dict[str, Any] | None) -> float:
    now = own(view)
    assert now is not None
    assert before is not None
    return float(now["pose"]["y"] - before["pose"]["y"])


def off_axis(here: dict[str, Any] | None, there: dict[str, Any], yaw: float) -> float:
    """The angle between where the camera looks and somebody, radians."""
    assert here is not None
    to = math.atan2(there["pose"]["y"] - here["pose"]["y"], there["pose"]["x"] - here["pose"]["x"])
    return abs(math.remainder(to - yaw, 2.0 * math.pi))

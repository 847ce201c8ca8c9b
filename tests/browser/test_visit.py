"""Two people meet in the world, each through a page in a real browser."""

import asyncio
from collections.abc import AsyncIterator
from functools import partial
from typing import Any

import pytest
import pytest_asyncio
from playwright.async_api import BrowserContext, Error

from tests.browser.visitor import View, Visitor, avatar_of, moved_m, own
from tests.browser.worlds import PROMENADE, PROMENADE_END, entered_at, world
from tests.patience import PATIENCE_S

pytestmark = [pytest.mark.browser, pytest.mark.asyncio(loop_scope="module")]

WALKED_M = 1.5


async def test_two_people_see_each_other_walk(
    url: str, profile: BrowserContext, other_profile: BrowserContext
) -> None:
    ann = await Visitor.arrive(profile, url)
    await ann.join("Ann")
    ben = await Visitor.arrive(other_profile, url)
    await ben.join("Ben")
    for walker, watcher in ((ann, ben), (ben, ann)):
        walker_id = (await walker.look())["id"]
        before = await _seen(watcher, walker_id)
        await walker.page.keyboard.down("s")
        await watcher.until(partial(_has_walked, before=before))
        await walker.page.keyboard.up("s")
    assert await ann.complaints() == []
    assert await ben.complaints() == []


async def test_a_click_on_the_ground_walks_there(url: str, profile: BrowserContext) -> None:
    ann = await Visitor.arrive(profile, url)
    await ann.join("Ann")
    before = own(await ann.look())
    assert before is not None
    # An actor that passes just there would be chosen by the click instead, but not by all of them.
    clicks = 0

    def walked_or_clicked_in_vain(view: View) -> bool:
        return _has_walked(view, before) or view["frames"] > since + 60

    while not _has_walked(await ann.look(), before):
        assert clicks < 10
        await ann.page.mouse.click(200 + 40 * clicks, 400)
        clicks += 1
        since = (await ann.look())["frames"]
        await ann.until(walked_or_clicked_in_vain)
    assert await ann.complaints() == []


async def test_actors_walk_about(url: str, profile: BrowserContext) -> None:
    ann = await Visitor.arrive(profile, url)
    await ann.join("Ann")
    view = await ann.until(lambda view: any(a["kind"] == "actor" for a in view["avatars"]))
    before = [avatar for avatar in view["avatars"] if avatar["kind"] == "actor"]
    await ann.until(lambda view: sum(_has_walked(view, actor) for actor in before) >= 2)


@pytest_asyncio.fixture(scope="module", loop_scope="module")
async def waiting_world(tmp_path_factory: pytest.TempPathFactory) -> AsyncIterator[str]:
    """Address of a world whose avatars wait for a page as long as a slow machine opens it."""
    scene = entered_at(PROMENADE, PROMENADE_END, tmp_path_factory.mktemp("promenade"))
    async with world(scene=scene, resume_seconds=PATIENCE_S) as address:
        yield address


async def test_a_killed_page_comes_back_as_the_same_avatar(
    waiting_world: str, profile: BrowserContext, other_profile: BrowserContext
) -> None:
    ann = await Visitor.arrive(profile, waiting_world)
    await ann.join("Cora")
    ann_id = (await ann.look())["id"]
    ben = await Visitor.arrive(other_profile, waiting_world)
    await ben.join("Ben")
    await ben.until(lambda view: avatar_of(view, ann_id) is not None)

    crashed = asyncio.Event()
    ann.page.on("crash", lambda _page: crashed.set())
    with pytest.raises(Error):
        await ann.page.goto("chrome://crash")
    await asyncio.wait_for(crashed.wait(), PATIENCE_S)

    again = await Visitor.arrive(profile, waiting_world)
    await again.join("Cora")
    assert (await again.look())["id"] == ann_id
    names = [avatar["name"] for avatar in (await ben.look())["avatars"]]
    assert names.count("Cora") == 1


async def test_a_reload_goes_straight_back_in(waiting_world: str, profile: BrowserContext) -> None:
    ann = await Visitor.arrive(profile, waiting_world)
    await ann.join("Ann")
    ann_id = (await ann.look())["id"]
    await ann.page.reload()
    await ann.until(lambda view: view["phase"] == "live" and view["id"] == ann_id)


async def test_two_tabs_are_two_people(url: str, profile: BrowserContext) -> None:
    first = await Visitor.arrive(profile, url)
    await first.join("Ann")
    second = await Visitor.arrive(profile, url)
    await second.join("Ann")
    assert (await first.look())["id"] != (await second.look())["id"]
    assert (await first.look())["phase"] == "live"


async def test_what_one_says_the_other_reads(
    url: str, profile: BrowserContext, other_profile: BrowserContext
) -> None:
    ann = await Visitor.arrive(profile, url)
    await ann.join("Ann")
    ben = await Visitor.arrive(other_profile, url)
    await ben.join("Ben")
    await _seen(ann, (await ben.look())["id"])
    await _seen(ben, (await ann.look())["id"])
    await ann.page.keyboard.press("Enter")
    await ann.page.keyboard.type("Good morning <b>Ben</b>!")
    await ann.page.keyboard.press("Enter")
    await ann.page.keyboard.press("Escape")
    line = ben.page.locator("#chat-log li", has_text="Good morning <b>Ben</b>!")
    await line.wait_for()
    assert (await ann.page.evaluate("() => document.activeElement.tagName")) == "BODY"


async def test_the_overlay_shows_the_plan_of_an_actor(url: str, profile: BrowserContext) -> None:
    ann = await Visitor.arrive(profile, url)
    await ann.join("Ann")
    await ann.page.click("#people-open")
    actor = ann.page.locator("#people-list li.actor button").first
    await actor.click()
    view = await ann.until(lambda view: view["plan"] is not None and len(view["plan"]["path"]) > 1)
    assert view["plan"]["id"] == view["chosenId"]
    await ann.page.locator("#plan-reason:not(:empty)").wait_for()
    await ann.page.click("#plan-open")
    await ann.until(lambda view: view["plan"] is None)
    assert await ann.complaints() == []


async def _seen(watcher: Visitor, avatar_id: int) -> dict[str, Any]:
    """Somebody, once the watcher has them in view."""
    view = await watcher.until(lambda view: avatar_of(view, avatar_id) is not None)
    avatar = avatar_of(view, avatar_id)
    assert avatar is not None
    return avatar


def _has_walked(view: View, before: dict[str, Any]) -> bool:
    return moved_m(view, before) > WALKED_M

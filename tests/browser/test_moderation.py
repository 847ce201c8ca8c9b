"""People mute and report others in their page, and read there what moderators do."""

from collections.abc import AsyncIterator

import pytest
import pytest_asyncio
from playwright.async_api import Browser, BrowserContext

from esplanade.server.app import Running
from tests.browser.visitor import Visitor, avatar_of, own
from tests.browser.worlds import PROMENADE, PROMENADE_END, entered_at, served
from tests.patience import PATIENCE_S
from tests.server.console.operators import Operator, operator

pytestmark = [pytest.mark.browser, pytest.mark.asyncio(loop_scope="module")]


@pytest_asyncio.fixture(scope="module", loop_scope="module")
async def server(tmp_path_factory: pytest.TempPathFactory) -> AsyncIterator[Running]:
    """A world that keeps chat, in which everybody comes in at one end of a promenade."""
    scene = entered_at(PROMENADE, PROMENADE_END, tmp_path_factory.mktemp("promenade"))
    more = {"keep_chat": True, "resume_seconds": PATIENCE_S, "chat_rate": 100.0}
    async with served(scene=scene, **more) as made:
        yield made


@pytest_asyncio.fixture(scope="module", loop_scope="module")
async def mona(server: Running) -> Operator:
    return await operator(server, "mona", "moderator")


async def arrived(server: Running, profile: BrowserContext, name: str) -> tuple[Visitor, int]:
    visitor = await Visitor.arrive(profile, f"http://127.0.0.1:{server.port}/")
    await visitor.join(name)
    return visitor, (await visitor.look())["id"]


async def say(visitor: Visitor, text: str) -> None:
    await visitor.page.fill("#chat-line", text)
    await visitor.page.press("#chat-line", "Enter")


async def done(mona: Operator, **command: object) -> None:
    status, answer = await mona.send(command)
    assert status == 200, answer


async def test_a_person_mutes_and_reports_another(
    server: Running, mona: Operator, profile: BrowserContext, other_profile: BrowserContext
) -> None:
    ann, _ = await arrived(server, profile, "Ann")
    ben, ben_id = await arrived(server, other_profile, "Ben")
    await ann.until(lambda view: avatar_of(view, ben_id) is not None)
    await say(ben, "you are all silly")
    await ann.page.locator("#chat-log li", has_text="you are all silly").wait_for()

    await ann.page.click("#people-open")
    await ann.page.get_by_role("button", name="Ben", exact=True).click()
    await ann.page.locator("#person-report summary").click()
    await ann.page.select_option("#person-line", label="you are all silly")
    await ann.page.fill("#person-text", "all day long")
    await ann.page.get_by_role("button", name="Report", exact=True).click()
    await ann.page.locator("#person-state", has_text="Thank you.").wait_for()
    (report,) = (await mona.get("/reports"))[1]["reports"]
    assert report["text"] == "is rude or threatens: all day long"
    assert (report["name"], report["said"]) == ("Ben", "you are all silly")

    await ann.page.click("#person-mute")
    await ann.page.get_by_role("button", name="Ben muted", exact=True).wait_for()
    await ann.page.click("#person-close")
    await say(ben, "nobody likes you")
    await ben.page.locator("#chat-log li", has_text="nobody likes you").wait_for()
    await say(ann, "how quiet")
    await ann.page.locator("#chat-log li", has_text="how quiet").wait_for()
    lines = await ann.page.locator("#chat-log").inner_text()
    assert "nobody likes you" not in lines

    await ann.page.reload()
    await ann.until(lambda view: view["phase"] == "live" and own(view) is not None)
    await ann.until(lambda view: avatar_of(view, ben_id) is not None)
    await say(ben, "still here")
    await ben.page.locator("#chat-log li", has_text="still here").wait_for()
    await say(ann, "still quiet")
    await ann.page.locator("#chat-log li", has_text="still quiet").wait_for()
    assert "still here" not in await ann.page.locator("#chat-log").inner_text()

    line = next(
        kept["line"]
        for kept in (await mona.get("/chat"))[1]["lines"]
        if kept["text"] == "nobody likes you"
    )
    await done(mona, op="hide_line", line=line)
    await ben.page.locator("#chat-log li", has_text="nobody likes you").wait_for(state="detached")
    assert await ann.complaints() == []
    assert await ben.complaints() == []


async def test_moderators_are_read_in_the_page(
    server: Running, mona: Operator, profile: BrowserContext
) -> None:
    eve, eve_id = await arrived(server, profile, "Eve")
    banner = eve.page.locator("#moderation")
    await done(mona, op="warn", person=eve_id, text="Softly, please.")
    await banner.filter(has_text="A moderator warns you. Softly, please.").wait_for()
    await eve.page.click("#moderation-close")
    await banner.wait_for(state="hidden")
    await done(mona, op="mute", person=eve_id, seconds=600, text="Ten minutes of rest.")
    await banner.filter(has_text="You are muted for 9:5").wait_for()
    await say(eve, "but")
    await eve.page.locator("#chat-log li", has_text="you are muted for 9:").last.wait_for()
    await done(mona, op="mute", person=eve_id, seconds=0, text="Welcome back.")
    await banner.filter(has_text="You are heard again.").wait_for()
    await done(mona, op="ban", person=eve_id, until_s=4e9, text="No shouting.")
    reason = eve.page.locator("#join-reason", has_text="No shouting. You may come back after")
    await reason.wait_for()
    await eve.page.click("#join-button")
    await eve.page.locator("#join-reason", has_text="You cannot come in here.").wait_for()
    assert await eve.complaints() == []


async def test_who_is_walked_out_sees_their_avatar_go(
    server: Running, mona: Operator, profile: BrowserContext
) -> None:
    dan, dan_id = await arrived(server, profile, "Dan")
    await dan.page.keyboard.down("s")
    await dan.until(lambda view: (own(view) or {"pose": {"y": 155.0}})["pose"]["y"] < 152.0)
    await done(mona, op="walk_out", person=dan_id, text="We close.")
    await dan.page.locator("#moderation", has_text="walked to the way out").wait_for()
    await dan.page.locator("#join-reason", has_text="We close.").wait_for()
    await dan.page.keyboard.up("s")
    assert await dan.complaints() == []


@pytest.mark.parametrize(("width", "height"), [(1280, 720), (390, 844)])
async def test_what_a_person_is_told_stands_one_below_the_other(
    server: Running, browser: Browser, width: int, height: int
) -> None:
    dora = await operator(server, f"dora-{width}", "director")
    profile = await browser.new_context(viewport={"width": width, "height": height})
    visitor, who = await arrived(server, profile, f"Ann {width}")
    page = visitor.page
    await done(dora, op="pace", pause=True)
    await done(dora, op="mute", person=who, seconds=600, text="Please calm down for a while.")
    try:
        boxes = []
        for banner in ("#pace", "#moderation"):
            await page.wait_for_selector(banner)
            box = await page.locator(banner).bounding_box()
            assert box is not None
            assert box["x"] >= 0
            assert box["x"] + box["width"] <= width
            boxes.append(box)
        top, below = boxes
        assert top["y"] + top["height"] <= below["y"]
        await page.click("#moderation-close")
    finally:
        await done(dora, op="pace", pause=False)

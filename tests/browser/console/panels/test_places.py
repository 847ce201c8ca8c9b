"""Drawings of operators on the map: areas of an announcement and of quiet, a guide's tour."""

import re
from typing import Any, Final

import pytest
from playwright.async_api import Browser, expect

from esplanade.protocol.messages import Bye, Chat, ChatLine, Error, Notice
from esplanade.server.app import Running
from tests.browser.console.visit import arrived
from tests.browser.console.worlds import script_of
from tests.patience import PATIENCE_S
from tests.server.client import Client, joined

pytestmark = pytest.mark.asyncio(loop_scope="package")
expect.set_options(timeout=1e3 * PATIENCE_S)

RING: Final = ((0.35, 0.3), (0.65, 0.3), (0.65, 0.65), (0.35, 0.65))
WITHIN: Final = (8.0, 6.5, 0)
BESIDE: Final = (1.0, 1.0, 0)


async def _announced(client: Client) -> str:
    while (notice := await client.until(Notice)).notice != "announcement":
        pass
    return notice.text


async def test_an_announcement_is_heard_in_an_area(server: Running, browser: Browser) -> None:
    olga = await arrived(browser, server, "olga")
    await olga.show("People")
    people = olga.panel("people")
    words = people.get_by_label("What is announced")
    to_whom = people.locator("fieldset", has_text="Announce").locator("select")
    announce = people.get_by_role("button", name="Announce")
    async with joined(server.port, "Eve", WITHIN) as eve, joined(server.port, "Ann", BESIDE) as ann:
        await words.fill("Mind the step.")
        await to_whom.select_option("an area, drawn on the map")
        await announce.click()
        await olga.draw(*RING)
        await expect(words).to_have_value("")
        await words.fill("We close at six.")
        await to_whom.select_option("everybody")
        await announce.click()
        assert (await _announced(eve)).endswith("Mind the step.")
        assert (await _announced(eve)).endswith("We close at six.")
        assert (await _announced(ann)).endswith("We close at six.")
    assert olga.complaints == []


async def test_it_is_quiet_in_a_zone_until_it_is_taken_away(
    server: Running, browser: Browser
) -> None:
    olga = await arrived(browser, server, "olga")
    await olga.show("Chat")
    chat = olga.panel("chat")
    async with joined(server.port, "Eve", WITHIN) as eve, joined(server.port, "Ann", BESIDE) as ann:
        await chat.get_by_role("button", name="Draw one on the map").click()
        await olga.draw(*RING)
        gone = chat.get_by_role("button", name=re.compile("Take the quiet zone"))
        await expect(gone).to_have_count(1)
        await eve.send(ChatLine(text="Hello?"))
        assert (await eve.until(Error)).error == "quiet_zone"
        await ann.send(ChatLine(text="Hello!"))
        assert (await ann.until(Chat)).text == "Hello!"
        await gone.click()
        await expect(gone).to_have_count(0)
        await eve.send(ChatLine(text="At last."))
        assert (await ann.until(Chat)).text == "At last."
    assert olga.complaints == []


async def test_lines_are_slowed_down_and_not_any_more(server: Running, browser: Browser) -> None:
    olga = await arrived(browser, server, "olga")
    await olga.show("Chat")
    every = olga.panel("chat").get_by_label("One line in")
    async with joined(server.port, "Eve") as eve:
        await every.select_option("60 s")
        await expect(olga.page.get_by_text("The rule holds from now on.")).to_be_visible()
        await eve.send(ChatLine(text="one"))
        assert (await eve.until(Chat)).text == "one"
        await eve.send(ChatLine(text="two"))
        assert (await eve.until(Error)).error == "slow_mode"
        async with olga.page.expect_response("**/commands"):
            await every.select_option("no time (off)")
        await eve.send(ChatLine(text="three"))
        assert (await eve.until(Chat)).text == "three"
    assert olga.complaints == []


async def test_a_person_is_walked_out(server: Running, browser: Browser) -> None:
    olga = await arrived(browser, server, "olga")
    await olga.show("People")
    people = olga.panel("people")
    async with joined(server.port, "Eve", BESIDE) as eve:
        await people.get_by_role("button", name="Eve", exact=True).click()
        await people.get_by_label(re.compile("What the person is told")).fill("We close.")
        await people.get_by_role("button", name="Walk out").click()
        assert (await eve.until(Notice)).notice == "walked_out"
        bye = await eve.until(Bye)
        assert (bye.reason, bye.text) == ("walked_out", "We close.")
    await expect(people.get_by_role("button", name="Eve", exact=True)).to_have_count(0)
    assert olga.complaints == []


async def test_an_actor_becomes_a_guide_on_a_tour_that_is_drawn(
    server: Running, browser: Browser
) -> None:
    script = await script_of(server, "otto", "tour")
    olga = await arrived(browser, server, "olga")
    await olga.show("Actors")
    actors = olga.panel("actors")
    await actors.locator("tbody tr").first.get_by_role("button").click()
    form = actors.locator("details", has_text="Another behaviour")
    await form.locator("summary").click()
    await form.locator("[name=behaviour]").select_option("guide")
    await form.get_by_role("button", name="Draw on the map").click()
    await olga.draw(*RING[:3])
    stops = form.get_by_role("listitem")
    await expect(stops).to_have_count(3)
    await form.get_by_role("button", name="Leave stop 2 out").click()
    await expect(stops).to_have_count(2)
    await form.get_by_role("button", name="Let them do that").click()
    await expect(actors.locator("tbody tr").first).to_contain_text("Guide")
    _, found = await script.get("/actors/actor-1")
    tour = found["behaviour"]["tour"]
    assert len(tour) == 2
    shown = [await stops.nth(index).inner_text() for index in range(2)]
    assert all(text.startswith(_text(stop)) for text, stop in zip(shown, tour, strict=True))
    assert olga.complaints == []


def _text(stop: list[Any]) -> str:
    return f"{stop[0]:.1f}, {stop[1]:.1f}"

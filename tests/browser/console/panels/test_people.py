"""Operators look after people on their page: what they click reaches the people it is about."""

import re

import pytest
from playwright.async_api import Browser, Locator, expect

from esplanade.protocol.messages import Bye, Chat, ChatLine, Notice, Report
from esplanade.server.app import Running
from tests.browser.console.visit import Visit, arrived
from tests.patience import PATIENCE_S
from tests.server.client import Client, joined

pytestmark = pytest.mark.asyncio(loop_scope="package")
expect.set_options(timeout=1e3 * PATIENCE_S)


async def _heard(client: Client, notice: str) -> Notice:
    """The next notice of a matter."""
    while (found := await client.until(Notice)).notice != notice:
        pass
    return found


async def _choose(olga: Visit, name: str) -> Locator:
    await olga.show("People")
    people = olga.panel("people")
    await people.get_by_role("button", name=name, exact=True).click()
    await expect(people.locator("legend").first).to_have_text(name)
    return people


async def test_a_person_is_warned_muted_heard_again_and_sent_out(
    server: Running, browser: Browser
) -> None:
    olga = await arrived(browser, server, "olga")
    async with joined(server.port, "Eve") as eve:
        people = await _choose(olga, "Eve")
        await expect(people.get_by_role("button", name="Warn")).to_be_disabled()
        words = people.get_by_label(re.compile("What the person is told"))
        await words.fill("Please do not shout.")
        await people.get_by_role("button", name="Warn").click()
        assert (await _heard(eve, "warned")).text == "Please do not shout."
        await people.get_by_role("button", name="Mute", exact=True).click()
        await _heard(eve, "muted")
        await people.get_by_role("button", name="Let speak").click()
        await _heard(eve, "unmuted")
        await people.get_by_label("What is announced").fill("The doors close at six.")
        await people.get_by_role("button", name="Announce").click()
        assert (await _heard(eve, "announcement")).text.endswith("The doors close at six.")
        await people.get_by_role("button", name="Kick").click()
        assert (await eve.until(Bye)).reason == "kicked"
    await expect(people.get_by_role("button", name="Eve", exact=True)).to_have_count(0)
    assert olga.complaints == []


async def test_a_person_is_banned_and_the_ban_lifted(server: Running, browser: Browser) -> None:
    olga = await arrived(browser, server, "olga")
    async with joined(server.port, "Mallory") as mallory:
        people = await _choose(olga, "Mallory")
        await people.get_by_role("button", name="Ban", exact=True).click()
        assert (await mallory.until(Bye)).reason == "banned"
    await olga.show("Bans")
    bans = olga.panel("bans")
    row = bans.locator("tbody tr").first
    await expect(row).to_contain_text("olga")
    await row.get_by_role("button", name=re.compile("Lift")).click()
    await expect(row).to_contain_text("lifted")
    await bans.get_by_label(re.compile("Name")).fill("spam*")
    await bans.get_by_label("What they are told").fill("No advertising.")
    await bans.get_by_role("button", name="Ban", exact=True).click()
    newest = bans.locator("tbody tr").first
    await expect(newest).to_contain_text("spam*")
    await expect(newest).to_contain_text("for ever")
    await newest.get_by_role("button", name=re.compile("Lift")).click()
    await expect(newest).to_contain_text("lifted")
    assert olga.complaints == []


async def test_reports_are_settled_and_lines_taken_away(server: Running, browser: Browser) -> None:
    olga = await arrived(browser, server, "olga")
    async with joined(server.port, "Rude") as rude, joined(server.port, "Ann") as ann:
        await rude.send(ChatLine(text="Something rude"))
        line = await ann.until(Chat)
        await ann.send(Report(id=rude.id, line=line.line, text="He is rude."))
        await _heard(ann, "report_taken")
        await olga.show("Inbox")
        inbox = olga.panel("reports")
        report = inbox.get_by_role("listitem").filter(has_text="He is rude.")
        await expect(report).to_contain_text("Something rude")
        await report.get_by_role("button", name="Show").click()
        await report.get_by_role("button", name="Take the line away").click()
        await report.get_by_role("textbox").fill("talked to him")
        await report.get_by_role("button", name=re.compile("Done with")).click()
        await expect(report).to_have_count(0)
        await olga.show("Chat")
        chat = olga.panel("chat")
        await expect(chat.get_by_role("listitem").first).to_contain_text("taken away")
        await chat.get_by_label("Words that are not said here").fill("darn")
        await chat.get_by_role("button", name="Mask them").click()
        await expect(olga.page.get_by_text("The words are noted.")).to_be_visible()
        await rude.send(ChatLine(text="Well, darn"))
        assert "darn" not in (await ann.until(Chat)).text
    assert olga.complaints == []

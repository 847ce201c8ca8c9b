"""Clicks of directors and admins on their page: time, waves, ways in, a password, the audit."""

import csv
import json
import re
from pathlib import Path

import pytest
from playwright.async_api import Browser, expect

from esplanade.server.accounts.identity import MACHINE
from esplanade.server.app import Running
from tests.browser.console.stage_answers import PASSWORD
from tests.browser.console.visit import arrived
from tests.patience import PATIENCE_S

pytestmark = pytest.mark.asyncio(loop_scope="package")
expect.set_options(timeout=1e3 * PATIENCE_S)


async def test_time_stops_goes_on_by_ticks_and_runs_at_another_pace(
    server: Running, browser: Browser
) -> None:
    olga = await arrived(browser, server, "olga")
    await olga.show("World")
    world = olga.panel("world")
    await world.get_by_role("button", name="Pause").click()
    await expect(world.get_by_role("button", name="Go on")).to_be_visible()
    before = server.world.tick
    await world.get_by_role("button", name="10 ticks").click()
    # The command itself is an input of a tick in which nobody moves.
    after = re.compile(f"tick ({before + 10}|{before + 11}),")
    await expect(world.locator("dl")).to_contain_text(after)
    assert server.world.tick <= before + 11
    await world.get_by_role("button", name="Go on").click()
    await world.get_by_role("button", name="0.5×").click()
    await expect(world.locator("dl")).to_contain_text("at 0.5×")
    await world.get_by_role("button", name="1×", exact=True).click()
    await expect(world.locator("dl")).to_contain_text("at 1×")
    await expect(world.locator("dl")).to_contain_text(re.compile(r"each actor once in [2-4] ticks"))
    await world.get_by_label("Mark this moment").fill("a quiet moment")
    await world.get_by_role("button", name="Mark", exact=True).click()
    await olga.show("Events")
    await expect(olga.panel("events")).to_contain_text("a quiet moment")
    assert olga.complaints == []


async def test_a_recording_begins_grows_and_ends(server: Running, browser: Browser) -> None:
    olga = await arrived(browser, server, "olga")
    await olga.show("World")
    world = olga.panel("world")
    state = world.get_by_role("group", name="Recording").locator("span")
    await expect(state).to_have_text("The world is not recorded.")
    await world.get_by_role("button", name="Record the world").click()
    grown = re.compile(r"room\.mcap: \d\.\d MB, \d+ min ([2-9]|[1-5]\d) s of the world")
    await expect(state).to_have_text(grown)
    await world.get_by_role("button", name="End the recording").click()
    await expect(state).to_have_text("The world is not recorded.")
    await olga.show("Events")
    await expect(olga.panel("events")).to_contain_text("room.mcap is complete")
    vera = await arrived(browser, server, "vera")
    await vera.show("World")
    refused = vera.panel("world").get_by_role("button", name="Record the world")
    await expect(refused).to_have_attribute("title", re.compile("may not record the world"))
    assert olga.complaints == vera.complaints == []


async def test_a_wave_comes_and_goes(server: Running, browser: Browser) -> None:
    olga = await arrived(browser, server, "olga")
    await olga.show("Actors")
    actors = olga.panel("actors")
    rows = actors.locator("tbody tr")
    await expect(rows).not_to_have_count(0)
    before = await rows.count()
    await actors.get_by_label("How many").fill("3")
    await actors.get_by_label("How many").press("Tab")
    await actors.get_by_label("Groups").fill("school")
    await actors.get_by_label("Preset").select_option("brisk")
    await actors.get_by_role("button", name="Add 3 actors").click()
    await expect(rows).to_have_count(before + 3)
    await olga.show("Changes")
    newest = olga.panel("changes").get_by_role("listitem").first
    await expect(newest).to_contain_text("add actors")
    await newest.get_by_role("button", name=re.compile("Undo change")).click()
    await olga.show("Actors")
    await expect(rows).to_have_count(before)
    assert olga.complaints == []


async def test_ways_in_are_shown_once_and_end(server: Running, browser: Browser) -> None:
    olga = await arrived(browser, server, "olga")
    await olga.show("Invitations")
    ways = olga.panel("invitations")
    await ways.get_by_label("For whom, or why").fill("the press")
    await ways.get_by_role("button", name="Invite").click()
    await expect(ways.locator(".secret code")).to_contain_text("#invitation=")
    await ways.get_by_role("button", name="I have it").click()
    await ways.get_by_role("button", name="Take back invitation the press").click()
    await expect(ways.get_by_text("taken back")).to_be_visible()
    await ways.get_by_label("Name").fill("crowd")
    await ways.get_by_role("button", name="Let a bot in").click()
    await expect(ways.locator(".secret code")).to_contain_text("esplanade_")
    await ways.get_by_role("button", name="Revoke the bot crowd").click()
    await expect(ways.get_by_role("button", name="Revoke the bot crowd")).to_have_count(0)
    await olga.show("My account")
    account = olga.panel("account")
    await account.get_by_role("button", name="Make a link").click()
    link = await account.get_by_role("link", name="Walk in").get_attribute("href")
    assert link is not None
    assert f":{server.port}/#pass=" in link
    assert olga.complaints == []


async def test_a_password_is_changed_and_the_audit_taken_away(
    server: Running, browser: Browser, tmp_path: Path
) -> None:
    await server.kept.directory.add(MACHINE, "paula", "admin", PASSWORD)
    paula = await arrived(browser, server, "paula")
    await paula.show("My account")
    account = paula.panel("account")
    await account.get_by_label("The one until now").fill(PASSWORD)
    await account.get_by_label("The new one").fill("another one, long enough")
    await account.get_by_role("button", name="Change").click()
    await expect(paula.page.get_by_text("You have another password.")).to_be_visible()
    await paula.show("Audit")
    audit = paula.panel("audit")
    await expect(audit.locator("tbody tr").first).to_contain_text("paula")
    async with paula.page.expect_download() as started:
        await audit.get_by_role("button", name="Take away as CSV").click()
    file = tmp_path / "audit.csv"
    await (await started.value).save_as(file)
    assert "password" in file.read_text()
    async with paula.page.expect_download() as started:
        await audit.get_by_role("button", name="as JSON lines").click()
    download = await started.value
    assert download.suggested_filename == "audit.jsonl"
    await download.save_as(tmp_path / "audit.jsonl")
    rows = [json.loads(line) for line in (tmp_path / "audit.jsonl").read_text().splitlines()]
    assert ("paula", "user_password") in {(row["account"], row["command"]) for row in rows}
    with file.open(newline="") as table:
        assert [row["hash"] for row in csv.DictReader(table)] == [row["hash"] for row in rows]
    await audit.get_by_role("button", name="Verify the chains").click()
    await expect(paula.page.get_by_text("The audit is as it was written.")).to_be_visible()
    assert paula.complaints == []

"""The whole way of an operator through a change, with the keyboard alone, beside a second one."""

import re

import pytest
from playwright.async_api import Browser, expect

from esplanade.server.accounts.identity import MACHINE
from esplanade.server.app import Running
from tests.browser.console.panels.page import OperatorPage
from tests.patience import PATIENCE_S
from tests.server.console.operators import Operator

pytestmark = pytest.mark.asyncio(loop_scope="package")
expect.set_options(timeout=1e3 * PATIENCE_S)

FIELD = "hysteresis_s"
WINDOW = {"width": 1280, "height": 900}


async def test_a_change_from_logging_in_to_logging_out(server: Running, browser: Browser) -> None:
    olga = await OperatorPage.arrive(await browser.new_context(viewport=WINDOW), server, "olga")
    keys = olga.page.keyboard
    script = Operator(server.private_port, await server.kept.tokens.add(MACHINE, "otto", "story"))
    await olga.page.locator("esp-everybody [role=option]").first.focus()
    await keys.press("Enter")
    effective = olga.panel("inspector").locator("tr", has_text="hysteresis")
    await expect(effective).to_be_visible()
    await olga.page.get_by_role("tab", name="Everybody").focus()
    await keys.press("ArrowRight")
    await expect(olga.slider(FIELD)).to_be_visible()

    # A draft, with its price; nobody else is touched by it.
    before = await olga.box(FIELD).input_value()
    await olga.slider(FIELD).focus()
    await keys.press("PageUp")
    state = olga.panel("parameters").locator(".state")
    await expect(state).to_contain_text("takes effect at once")
    drafted = await olga.box(FIELD).input_value()
    assert float(drafted) > float(before)
    await expect(olga.page).to_have_url(re.compile("draft"))

    # Its link shows another operator the same draft, also after loading the page anew.
    otto = await OperatorPage.arrive(await browser.new_context(viewport=WINDOW), server, "otto")
    await otto.page.goto(olga.page.url)
    await otto.page.reload()
    await otto.show("Parameters")
    await expect(otto.box(FIELD)).to_have_value(drafted)
    await otto.box(FIELD).fill("0.4")

    # Applied: the actor has it within a second of the world's time.
    begun = server.world.tick
    await olga.slider(FIELD).focus()
    await keys.press("ControlOrMeta+Enter")
    await expect(state).to_contain_text("No draft")
    await expect(effective).to_contain_text(drafted)
    _, told = await script.get("/changes?limit=1")
    assert told["changes"][0]["after"]["world"][FIELD] == float(drafted)
    assert told["changes"][0]["tick"] - begun <= 1.0 / server.world.tick_s

    # The second one's typing stays, with what the first has set beside it.
    await expect(otto.row(FIELD).locator(".beside")).to_contain_text(f"olga has set {drafted}")
    await expect(otto.box(FIELD)).to_have_value("0.4")
    await olga.show("Parameters")
    await olga.slider(FIELD).focus()
    await keys.press("ControlOrMeta+z")
    await expect(olga.box(FIELD)).to_have_value(before)
    await expect(effective).to_contain_text(before)
    await olga.page.locator("esp-topbar summary", has_text="olga").focus()
    await keys.press("Enter")
    await olga.page.get_by_role("button", name="Log out").focus()
    await keys.press("Enter")
    await expect(olga.page.get_by_label("Password", exact=True)).to_be_visible()
    await olga.check_nothing_went_wrong()
    await otto.check_nothing_went_wrong()

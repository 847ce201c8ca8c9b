"""Operators tune parameters on their page: drafts, prices, undo, links, two operators at once."""

import re
from typing import Any, Final

import pytest
from playwright.async_api import Browser, expect

from esplanade.server.accounts.identity import MACHINE
from esplanade.server.app import Running
from tests.browser.console.panels.page import OperatorPage
from tests.patience import PATIENCE_S
from tests.server.console.operators import Operator

pytestmark = pytest.mark.asyncio(loop_scope="package")

FIELD: Final = "risk_weight"
BODY_FIELD: Final = "radius_m"

expect.set_options(timeout=1e3 * PATIENCE_S)


async def _script(server: Running, name: str) -> Operator:
    """An operator's script, which is not the page."""
    token = await server.kept.tokens.add(MACHINE, "otto", name)
    return Operator(server.private_port, token)


async def _value(script: Operator, name: str = FIELD) -> Any:
    return (await script.values("actor-1"))[name]


async def test_a_slider_makes_a_draft_which_is_applied_undone_and_shared(
    server: Running, browser: Browser
) -> None:
    script = await _script(server, "first")
    before = await _value(script)
    context = await browser.new_context(viewport={"width": 1280, "height": 900})
    olga = await OperatorPage.arrive(context, server, "olga")
    await olga.show("Parameters")
    slider = olga.slider(FIELD)
    await slider.focus()
    for _ in range(3):
        await olga.page.keyboard.press("PageUp")
    state = olga.panel("parameters").locator(".state")
    await expect(state).to_contain_text("takes effect at once")
    drafted = float(await olga.box(FIELD).input_value())
    assert drafted > before
    assert await _value(script) == before, "a draft is not sent"

    # A draft is in the address, and there again when the page is loaded anew.
    await expect(olga.page).to_have_url(re.compile("draft"))
    await olga.page.reload()
    await expect(olga.box(FIELD)).to_have_value(f"{drafted:g}")
    await expect(state).to_contain_text("takes effect at once")

    await olga.panel("parameters").get_by_role("button", name="Apply").click()
    await expect(state).to_contain_text("No draft")
    assert await _value(script) == drafted
    await expect(olga.row(FIELD).locator(".chip").first).to_have_text("world")

    await olga.panel("parameters").get_by_role("button", name="Undo my latest change").click()
    await expect(olga.box(FIELD)).to_have_value(f"{before:g}")
    assert await _value(script) == before
    await olga.check_nothing_went_wrong()


async def test_a_body_has_a_price_and_values_that_do_not_go_together_a_fault(
    server: Running, browser: Browser
) -> None:
    context = await browser.new_context(viewport={"width": 1280, "height": 900})
    olga = await OperatorPage.arrive(context, server, "olga")
    await olga.show("Parameters")
    state = olga.panel("parameters").locator(".state")
    await olga.box(BODY_FIELD).fill("0.3")
    await expect(state).to_contain_text("preparation")
    await olga.box(BODY_FIELD).press("Escape")
    await olga.box("leg_length_m").fill("0.5")
    await expect(olga.row("leg_length_m").locator(".fault")).to_contain_text("step_on_m")
    await expect(state).to_contain_text("cannot be applied")
    await olga.box("step_on_m").fill("0.4")
    await expect(state).to_contain_text("preparation")
    await expect(olga.row("leg_length_m").locator(".fault")).to_have_count(0)
    await olga.check_nothing_went_wrong()


async def test_nobody_types_over_another_operator(server: Running, browser: Browser) -> None:
    script = await _script(server, "second")
    context = await browser.new_context(viewport={"width": 1280, "height": 900})
    olga = await OperatorPage.arrive(context, server, "olga")
    await olga.show("Parameters")
    await olga.box(FIELD).click()
    await olga.box(FIELD).press("ControlOrMeta+a")
    await olga.page.keyboard.type("17")

    status, answer = await script.send(
        {"op": "set_parameters", "scope": "world", "values": {FIELD: 21, "foresight_s": 5}}
    )
    assert status == 200, answer
    beside = olga.row(FIELD).locator(".beside")
    await expect(beside).to_contain_text("otto has set 21 meanwhile")
    await olga.page.keyboard.type(".5")
    await expect(olga.box(FIELD)).to_have_value("17.5")
    await expect(olga.box("foresight_s")).to_have_value("5")

    # Applying it without a look at the other value is refused, and nothing is lost.
    await olga.page.keyboard.press("ControlOrMeta+Enter")
    await expect(olga.row(FIELD).locator(".fault")).to_be_visible()
    await expect(olga.box(FIELD)).to_have_value("17.5")
    assert await _value(script) == 21
    await beside.get_by_role("button", name="Keep mine").click()
    await olga.box(FIELD).press("ControlOrMeta+Enter")
    await expect(olga.panel("parameters").locator(".state")).to_contain_text("No draft")
    assert await _value(script) == 17.5
    await olga.check_nothing_went_wrong()


async def test_a_live_drag_is_one_change(server: Running, browser: Browser) -> None:
    script = await _script(server, "third")
    context = await browser.new_context(viewport={"width": 1280, "height": 900})
    olga = await OperatorPage.arrive(context, server, "olga")
    await olga.show("Parameters")
    await olga.panel("parameters").get_by_label("live drag").check()
    before = await _value(script, "turn_weight")
    slider = olga.slider("turn_weight")
    await slider.scroll_into_view_if_needed()
    box = await slider.bounding_box()
    assert box is not None
    x, y = box["x"] + 4, box["y"] + box["height"] / 2
    await olga.page.mouse.move(x, y)
    await olga.page.mouse.down()
    for step in range(30):
        await olga.page.mouse.move(x + box["width"] * step / 40, y)
    await olga.page.mouse.up()
    await expect(olga.panel("parameters").locator(".state")).to_contain_text("No draft")
    dragged = await _value(script, "turn_weight")
    assert dragged != before
    assert f"{dragged:g}" == await olga.box("turn_weight").input_value()
    status, answer = await script.get("/changes?limit=5")
    assert status == 200
    mine = [one for one in answer["changes"] if "turn_weight" in str(one["after"])]
    assert len(mine) == 1
    assert mine[0]["before"]["world"]["turn_weight"] != dragged
    await olga.check_nothing_went_wrong()


async def test_the_keyboard_is_enough(server: Running, browser: Browser) -> None:
    script = await _script(server, "fourth")
    context = await browser.new_context(viewport={"width": 1280, "height": 900})
    olga = await OperatorPage.arrive(context, server, "olga")
    await olga.show("Parameters")
    box = olga.box("wall_weight")
    await box.focus()
    await olga.page.keyboard.press("ControlOrMeta+a")
    await olga.page.keyboard.type("0.7")
    await olga.page.keyboard.press("ControlOrMeta+z")
    await expect(box).to_have_value("0.3")
    await olga.page.keyboard.press("ControlOrMeta+Shift+z")
    await expect(box).to_have_value("0.7")
    await olga.page.keyboard.press("ControlOrMeta+Enter")
    await expect(olga.panel("parameters").locator(".state")).to_contain_text("No draft")
    assert await _value(script, "wall_weight") == 0.7
    await olga.page.keyboard.press("ControlOrMeta+z")
    await expect(box).to_have_value("0.3")
    assert await _value(script, "wall_weight") == 0.3
    await olga.check_nothing_went_wrong()

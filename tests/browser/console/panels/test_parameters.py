"""Operators tune parameters on their page: prices, faults, values that are dragged, keys."""

from typing import Any, Final

import pytest
from playwright.async_api import Browser, expect

from esplanade.server.app import Running
from tests.browser.console.visit import arrived
from tests.browser.console.worlds import script_of
from tests.patience import PATIENCE_S
from tests.server.console.operators import Operator

pytestmark = pytest.mark.asyncio(loop_scope="package")

BODY_FIELD: Final = "radius_m"

expect.set_options(timeout=1e3 * PATIENCE_S)


async def _value(script: Operator, name: str) -> Any:
    return (await script.values("actor-1"))[name]


async def test_a_body_has_a_price_and_values_that_do_not_go_together_a_fault(
    server: Running, browser: Browser
) -> None:
    olga = await arrived(browser, server, "olga")
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
    assert olga.complaints == []


async def test_a_live_drag_is_one_change(server: Running, browser: Browser) -> None:
    script = await script_of(server, "otto", "drag")
    olga = await arrived(browser, server, "olga")
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
    assert olga.complaints == []


async def test_the_keyboard_is_enough(server: Running, browser: Browser) -> None:
    script = await script_of(server, "otto", "keys")
    olga = await arrived(browser, server, "olga")
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
    assert olga.complaints == []

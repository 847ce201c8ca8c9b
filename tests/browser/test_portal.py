"""A portal in a real page: it is seen, and one walks through it."""

import io
import json
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Final

import numpy as np
import pytest
import pytest_asyncio
from playwright.async_api import BrowserContext, Page

from tests.browser.visitor import Visitor, own, place_of
from tests.browser.worlds import built, world
from tests.server.zones import HALL, YARD, write_town

pytestmark = [pytest.mark.browser, pytest.mark.asyncio(loop_scope="module")]

# Newcomers look to the north, so the gate lies there.
GATE: Final = {
    "name": "gate",
    "points": [[8, 12], [12, 12], [12, 13.5], [8, 13.5]],
    "arrival": [10, 9],
}
SPAWN: Final = {"position": [10, 7], "radius_m": 0.2}
DOOR: Final = {
    "name": "door",
    "points": [[5, 0.5], [7, 0.5], [7, 1.5], [5, 1.5]],
    "arrival": [6, 5],
}
LIT: Final = 1500
"""Pixels of the light of a portal that is seen from a few metres away, at least."""


def write_yard(folder: Path, *portals: object) -> None:
    (folder / "yard.json").write_text(json.dumps({**YARD, "portals": portals, "spawns": [SPAWN]}))


@pytest_asyncio.fixture(scope="module", loop_scope="module")
async def town(tmp_path_factory: pytest.TempPathFactory) -> AsyncIterator[str]:
    """Address of a world of a yard and a hall; the gate is to the north of where people come in."""
    built("index.html")
    folder = tmp_path_factory.mktemp("town")
    path = write_town(folder)
    write_yard(folder, GATE)
    (folder / "hall.json").write_text(json.dumps({**HALL, "portals": [DOOR]}))
    async with world(world=path) as address:
        yield address


async def lit_pixels(page: Page) -> int:
    """Number of pixels amid the picture that have the colour of a portal's light."""
    image = pytest.importorskip("PIL.Image")
    picture = await page.locator("#picture").screenshot()
    colours = np.asarray(image.open(io.BytesIO(picture)).convert("RGB")).astype(np.int64)
    colours = colours[150:450, 300:980]  # without the buttons at the edges
    red, green, blue = colours[..., 0], colours[..., 1], colours[..., 2]
    return int(((blue > red + 45) & (green > red + 35) & (blue < green + 40)).sum())


async def test_one_sees_where_a_portal_leads_and_walks_through_it(
    town: str, profile: BrowserContext
) -> None:
    ann = await Visitor.arrive(profile, town)
    await ann.join("Ann")
    before = await ann.look()
    assert await lit_pixels(ann.page) > LIT
    await ann.page.keyboard.down("w")
    await ann.page.get_by_text("You have come to The hall.").wait_for()
    await ann.page.keyboard.up("w")
    view = await ann.until(lambda view: view["phase"] == "live" and own(view) is not None)
    assert view["id"] == before["id"]
    x, y = place_of(own(view) or {})
    assert abs(x - 6.0) < 3.0
    assert y < 12.0
    assert await ann.complaints() == []


async def test_a_scene_that_is_served_alone_shows_no_portals(
    tmp_path: Path, profile: BrowserContext
) -> None:
    write_yard(tmp_path, GATE)
    async with world(scene=tmp_path / "yard.json") as address:
        cid = await Visitor.arrive(profile, address)
        await cid.join("Cid")
        assert await lit_pixels(cid.page) < LIT
        assert await cid.complaints() == []
        await cid.page.close()


async def test_a_page_that_is_loaded_anew_comes_back_into_the_zone_where_it_was(
    town: str, profile: BrowserContext
) -> None:
    bob = await Visitor.arrive(profile, town)
    await bob.join("Bob")
    await bob.page.keyboard.down("w")
    await bob.page.get_by_text("You have come to The hall.").wait_for()
    await bob.page.keyboard.up("w")
    await bob.page.reload()
    await bob.page.get_by_text("Welcome back, Bob.").wait_for()
    view = await bob.until(lambda view: own(view) is not None)
    # The yard reaches further than the hall, and its people come in at another place.
    x, y = place_of(own(view) or {})
    assert abs(x - 10.0) > 0.5 or abs(y - 9.0) > 0.5
    assert await bob.complaints() == []

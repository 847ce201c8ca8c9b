"""A closed world asks at its door, and the page takes secrets out of its address."""

import re
from pathlib import Path

import pytest
from playwright.async_api import BrowserContext, expect

from esplanade.planning import Scene
from esplanade.server.accounts.identity import MACHINE, Identity
from esplanade.server.accounts.rights import ROLES
from esplanade.server.app import running
from esplanade.server.settings import ServerSettings
from tests.browser.visitor import Visitor
from tests.browser.worlds import entered_at, world

pytestmark = [pytest.mark.browser, pytest.mark.asyncio(loop_scope="module")]

YARD = Scene.open_space((0.0, 0.0, 12.0, 12.0), name="yard")
WORLD = "the password of the world"


async def test_the_door_asks_for_the_password_and_says_when_it_is_wrong(
    profile: BrowserContext, tmp_path: Path
) -> None:
    scene = entered_at(YARD, (6.0, 6.0, 0.0), tmp_path)
    async with world(scene=scene, closed=True, world_password=WORLD) as address:
        ann = await Visitor.arrive(profile, address)
        password, reason = ann.page.locator("#join-password"), ann.page.locator("#join-reason")
        await expect(password).to_be_hidden()
        await ann.page.fill("#join-name", "Ann")
        await ann.page.click("#join-button")
        await expect(reason).to_contain_text("the way in is an invitation or its password")
        await expect(password).to_be_focused()
        await password.fill("a guess")
        await ann.page.click("#join-button")
        await expect(reason).to_contain_text("this is not the password of this world")
        await password.fill(WORLD)
        await ann.join("Ann")
        await ann.page.reload()
        await ann.until(lambda view: view["phase"] == "live")
        assert await ann.complaints() == []


async def test_a_pass_and_an_invitation_leave_the_address_and_let_in(
    profile: BrowserContext, tmp_path: Path
) -> None:
    values = {"host": "127.0.0.1", "port": 0, "private_port": 0, "actors": 0, "closed": True}
    scene = entered_at(YARD, (6.0, 6.0, 0.0), tmp_path)
    async with running(ServerSettings(scene=scene, **values)) as server:
        address, kept = f"http://127.0.0.1:{server.port}/", server.kept
        _, secret = await kept.invitations.add(MACHINE, label=None, uses=1, lasts_us=10**9)
        guest = await Visitor.arrive(profile, f"{address}#invitation={secret}")
        assert guest.page.url == address
        await guest.join("Guest")
        await kept.directory.add(MACHINE, "dora", "director", None)
        dora = Identity(account="dora", role="director", rights=ROLES["director"], via="session")
        given = await kept.one_time.seat_pass(dora)
        walker = await Visitor.arrive(profile, f"{address}#pass={given}&at=2,5")
        assert walker.page.url == f"{address}#at=2,5"
        await walker.join("Dora")
        late = await Visitor.arrive(profile, f"{address}#invitation={secret}")
        await late.page.fill("#join-name", "Late")
        await late.page.click("#join-button")
        told = re.compile("this invitation is not good, or no longer")
        await expect(late.page.locator("#join-reason")).to_contain_text(told)
        await expect(late.page.locator("#join-password")).to_be_hidden()

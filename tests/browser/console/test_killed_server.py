"""A server that is killed and started again, under a page of its operators that stays open."""

import asyncio
import subprocess
import sys
from pathlib import Path

import pytest
from playwright.async_api import BrowserContext

from tests.browser.console.stage_answers import ACCOUNT, PASSWORD
from tests.browser.console.visit import Visit
from tests.browser.worlds import built
from tests.patience import PATIENCE_S
from tests.server.test_process import served
from tests.server.worlds import ROOM

pytestmark = pytest.mark.asyncio(loop_scope="module")


async def test_the_page_comes_back_by_itself(profile: BrowserContext, tmp_path: Path) -> None:
    built("console.html")
    room, data = tmp_path / "room.json", ["--data", str(tmp_path / "world")]
    room.write_text(ROOM.model_dump_json())
    await asyncio.to_thread(_add_account, *data)
    with served(room, *data) as server:
        port = server.private_port
        visit = Visit(await profile.new_page(), f"http://127.0.0.1:{port}/console/")
        page = visit.page
        await visit.come_in()
        server.process.kill()
        server.process.wait(PATIENCE_S)
        await page.wait_for_selector("text=live", state="hidden")
    with served(room, *data, "--private-port", f"{port}") as server:
        await page.wait_for_selector("text=live")
        await page.wait_for_selector("text=1 actors, 0 people")
        # The operator is still logged in, and commands are carried out.
        await page.click("esp-topbar summary:has-text('Panels')")
        await page.click("esp-topbar details button:has-text('World')")
        await page.fill("esp-world input", "the server is back")
        await page.click("esp-world button:has-text('Mark')")
        await page.click("[role=tab]:has-text('Events')")
        await page.wait_for_selector("esp-events :text('the server is back')")
        assert server.stop() == 0


def _add_account(*data: str) -> None:
    words = ["op", "user", "add", ACCOUNT, "--role", "director", "--password-stdin", *data]
    subprocess.run(
        [sys.executable, "-m", "esplanade", *words],
        input=PASSWORD.encode(),
        timeout=PATIENCE_S,
        check=True,
    )

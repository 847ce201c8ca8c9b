"""The operators' page in a real chromium."""

from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any, Final

import pytest
import pytest_asyncio
from playwright.async_api import Browser, BrowserContext, Page

from esplanade.server.assets import CLIENT_ASSETS
from tests.browser.console.stage import Stage, staged
from tests.browser.console.stage_answers import ACCOUNT, PASSWORD
from tests.patience import PATIENCE_S

AXE: Final = Path(__file__).parents[3] / "client_web/node_modules/axe-core/axe.min.js"


class Visit:
    """A page of an operator, and what the browser complained of."""

    def __init__(self, page: Page, url: str) -> None:
        self.page, self.url = page, url
        self.complaints: list[str] = []
        page.set_default_timeout(1e3 * PATIENCE_S)
        page.on("pageerror", lambda error: self.complaints.append(str(error)))
        page.on("console", self._heard)

    def _heard(self, message: Any) -> None:
        # The browser tells of every refusal, which the page shows by itself.
        refusal = message.text.startswith("Failed to load resource")
        if message.type in ("error", "warning") and not refusal:
            self.complaints.append(message.text)

    async def open(self, fragment: str = "") -> None:
        """Load the page anew."""
        await self.page.goto("about:blank")
        await self.page.goto(self.url + fragment)

    async def log_in(self, password: str = PASSWORD) -> None:
        """Fill in the form and send it."""
        await self.page.fill("#name", ACCOUNT)
        await self.page.fill("#password", password)
        await self.page.press("#password", "Enter")

    async def come_in(self, fragment: str = "") -> None:
        """Load the page, log in, and wait until everybody is on the map."""
        await self.open(fragment)
        await self.log_in()
        await self.page.wait_for_selector("text=live")
        await self.page.wait_for_selector("canvas.map[data-ms]")

    async def findings(self) -> list[str]:
        """The findings of axe in the page as it is now."""
        await self.page.evaluate(AXE.read_text())
        found = await self.page.evaluate("axe.run(document, {resultTypes: ['violations']})")
        return [
            f"{each['id']}: {node['html'][:160]} {node['failureSummary']}"
            for each in found["violations"]
            for node in each["nodes"]
        ]


@pytest_asyncio.fixture(loop_scope="module")
async def stage() -> AsyncIterator[tuple[str, Stage]]:
    """A staged server: the address of the page, and what may be changed of it."""
    if not (CLIENT_ASSETS / "console.html").is_file():
        pytest.fail("the web client is not built; run: make client")
    async with staged() as made:
        yield made


@pytest_asyncio.fixture(loop_scope="module")
async def visit(profile: BrowserContext, stage: tuple[str, Stage]) -> AsyncIterator[Visit]:
    """A page of 1280 × 720 that is not loaded yet; nothing may be complained of in it."""
    made = Visit(await profile.new_page(), stage[0])
    yield made
    assert made.complaints == []


@pytest.fixture
def server(stage: tuple[str, Stage]) -> Stage:
    """The parts of the server that a test may change."""
    return stage[1]


async def visit_of(browser: Browser, url: str, width: int, height: int, scheme: Any) -> Visit:
    """A page in a window of a size, in a colour scheme."""
    context = await browser.new_context(
        viewport={"width": width, "height": height}, color_scheme=scheme
    )
    return Visit(await context.new_page(), url)

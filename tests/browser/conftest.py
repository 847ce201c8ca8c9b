"""A real server and a real chromium for the tests of the web client."""

import os
import shutil
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Final

import pytest
import pytest_asyncio
from playwright.async_api import Browser, BrowserContext, Playwright, async_playwright

from esplanade.server.app import running
from esplanade.server.assets import CLIENT_ASSETS
from esplanade.server.settings import ServerSettings

ACTORS: Final = 6

FLAGS: Final = (
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
)
_NAMES: Final = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")


@pytest_asyncio.fixture(scope="module", loop_scope="module")
async def url() -> AsyncIterator[str]:
    """Address of a running world."""
    if not (CLIENT_ASSETS / "index.html").is_file():
        pytest.fail("the web client is not built; run: make client")
    settings = ServerSettings(
        host="127.0.0.1", port=0, private_port=0, actors=ACTORS, seed=7, log_level="warning"
    )
    async with running(settings) as server:
        yield f"http://127.0.0.1:{server.port}/"


@pytest_asyncio.fixture(scope="module", loop_scope="module")
async def browser() -> AsyncIterator[Browser]:
    """Chromium, drawing WebGL in software."""
    async with async_playwright() as playwright:
        path = executable(playwright)
        if path is None:
            pytest.skip("no chromium or chrome on this machine")
        started = await playwright.chromium.launch(executable_path=path, args=[*FLAGS])
        try:
            yield started
        finally:
            await started.close()


@pytest_asyncio.fixture(loop_scope="module")
async def profile(browser: Browser) -> AsyncIterator[BrowserContext]:
    """A fresh browser profile with a window of 1280 × 720."""
    context = await browser.new_context(viewport={"width": 1280, "height": 720})
    yield context
    await context.close()


@pytest_asyncio.fixture(loop_scope="module")
async def other_profile(browser: Browser) -> AsyncIterator[BrowserContext]:
    """Another one, which shares nothing with the first."""
    context = await browser.new_context(viewport={"width": 1280, "height": 720})
    yield context
    await context.close()


def executable(playwright: Playwright) -> str | None:
    """What ESPLANADE_CHROMIUM names, the machine's own, or playwright's download."""
    named = os.environ.get("ESPLANADE_CHROMIUM")
    if named:
        return named
    found = next(filter(None, map(shutil.which, _NAMES)), None)
    downloaded = playwright.chromium.executable_path
    return found or (downloaded if Path(downloaded).is_file() else None)

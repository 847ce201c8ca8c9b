"""A real server and a real chromium for the tests of the web client."""

import os
import shutil
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Final

import pytest
import pytest_asyncio
from playwright.async_api import Browser, BrowserContext, Playwright, async_playwright

from esplanade.planning.scene.scene_file import read_scene
from esplanade.server.assets import CLIENT_ASSETS
from esplanade.server.loading import DEFAULT_SCENE
from tests.browser.worlds import FORECOURT, entered_at, world
from tests.patience import PATIENCE_S

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
    "--host-resolver-rules=MAP world.test 127.0.0.1",
)
_NAMES: Final = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")


@pytest_asyncio.fixture(scope="module", loop_scope="module")
async def url(tmp_path_factory: pytest.TempPathFactory) -> AsyncIterator[str]:
    """Address of a running world, the gallery; people come in on its forecourt."""
    if not (CLIENT_ASSETS / "index.html").is_file():
        pytest.fail("the web client is not built; run: make client")
    gallery = read_scene(DEFAULT_SCENE)
    scene = entered_at(gallery, FORECOURT, tmp_path_factory.mktemp("gallery"))
    async with world(scene=scene, actors=ACTORS, seed=7) as address:
        yield address


@pytest_asyncio.fixture(scope="module", loop_scope="module")
async def chromium() -> AsyncIterator[Browser]:
    """Chromium, drawing WebGL in software."""
    async with async_playwright() as playwright:
        path = executable(playwright)
        if path is None:
            pytest.skip("no chromium or chrome on this machine")
        started = await playwright.chromium.launch(
            executable_path=path, args=[*FLAGS], timeout=1e3 * PATIENCE_S
        )
        try:
            yield started
        finally:
            await started.close()


@pytest_asyncio.fixture(loop_scope="module")
async def browser(chromium: Browser) -> AsyncIterator[Browser]:
    """The same without any page of another test, that would go on drawing."""
    yield chromium
    for context in chromium.contexts:
        await context.close()


@pytest_asyncio.fixture(loop_scope="module")
async def profile(browser: Browser) -> BrowserContext:
    """A fresh browser profile with a window of 1280 × 720."""
    return await browser.new_context(viewport={"width": 1280, "height": 720})


@pytest_asyncio.fixture(loop_scope="module")
async def other_profile(browser: Browser) -> BrowserContext:
    """Another one, which shares nothing with the first."""
    return await browser.new_context(viewport={"width": 1280, "height": 720})


def executable(playwright: Playwright) -> str | None:
    """The chromium that ESPLANADE_CHROMIUM names, the machine's own, or playwright's download."""
    named = os.environ.get("ESPLANADE_CHROMIUM")
    if named:
        return named
    found = next(filter(None, map(shutil.which, _NAMES)), None)
    downloaded = playwright.chromium.executable_path
    return found or (downloaded if Path(downloaded).is_file() else None)

"""A real server and a real chromium for the tests of the web client."""

from collections.abc import AsyncIterator
from typing import Final

import pytest
import pytest_asyncio
from playwright.async_api import Browser, BrowserContext

from esplanade.planning.scene.scene_file import read_scene
from esplanade.server.loading import DEFAULT_SCENE
from tests.browser.chromium import WEBGL, browser_fixture, chromium_fixture
from tests.browser.worlds import FORECOURT, built, entered_at, world

ACTORS: Final = 6


chromium = chromium_fixture("module", *WEBGL)
browser = browser_fixture("module")


@pytest_asyncio.fixture(scope="module", loop_scope="module")
async def url(tmp_path_factory: pytest.TempPathFactory) -> AsyncIterator[str]:
    """Address of a running world, the gallery; people come in on its forecourt."""
    built("index.html")
    gallery = read_scene(DEFAULT_SCENE)
    scene = entered_at(gallery, FORECOURT, tmp_path_factory.mktemp("gallery"))
    async with world(scene=scene, actors=ACTORS, seed=7) as address:
        yield address


@pytest_asyncio.fixture(loop_scope="module")
async def profile(browser: Browser) -> BrowserContext:
    """A fresh browser profile with a window of 1280 × 720."""
    return await browser.new_context(viewport={"width": 1280, "height": 720})


@pytest_asyncio.fixture(loop_scope="module")
async def other_profile(browser: Browser) -> BrowserContext:
    """Another one, which shares nothing with the first."""
    return await browser.new_context(viewport={"width": 1280, "height": 720})

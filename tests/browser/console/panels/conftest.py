"""A real server with operators, and a real chromium for their page."""

from collections.abc import AsyncIterator
from pathlib import Path
from typing import Final

import pytest
import pytest_asyncio
from playwright.async_api import Browser, async_playwright

from esplanade.planning import Scene
from esplanade.server.app import Running, running
from esplanade.server.assets import CLIENT_ASSETS
from esplanade.server.settings import ServerSettings
from tests.browser.conftest import executable
from tests.browser.console.panels.page import operator
from tests.patience import PATIENCE_S

FLAGS: Final = (
    "--no-sandbox",
    "--disable-gpu",
    "--no-first-run",
    "--disable-background-networking",
)
ROOM: Final = Scene.open_space((0.0, 0.0, 16.0, 12.0), name="room")
ACTORS: Final = 4
OPERATORS: Final = {"olga": "admin", "otto": "admin", "vera": "viewer"}


@pytest_asyncio.fixture(scope="package", loop_scope="package")
async def server(tmp_path_factory: pytest.TempPathFactory) -> AsyncIterator[Running]:
    """A small world with operators."""
    if not (CLIENT_ASSETS / "console.html").is_file():
        pytest.fail("the web client is not built; run: make client")
    scene = _written(tmp_path_factory.mktemp("room"))
    settings = ServerSettings(
        host="127.0.0.1",
        port=0,
        private_port=0,
        actors=ACTORS,
        scene=scene,
        log_level="warning",
        seed=7,
        keep_chat=True,
        resume_seconds=PATIENCE_S,
    )
    async with running(settings) as started:
        for name, role in OPERATORS.items():
            await operator(started, name, role)
        yield started


@pytest_asyncio.fixture(scope="package", loop_scope="package")
async def chromium() -> AsyncIterator[Browser]:
    """Chromium without WebGL: the page draws its map on a canvas."""
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


@pytest_asyncio.fixture(loop_scope="package")
async def browser(chromium: Browser) -> AsyncIterator[Browser]:
    """The same; pages of a test are closed after it."""
    yield chromium
    for context in chromium.contexts:
        await context.close()


def _written(folder: Path) -> Path:
    scene = folder / "scene.json"
    scene.write_text(ROOM.model_dump_json())
    return scene

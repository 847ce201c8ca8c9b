"""A real server with operators, and a real chromium for their page."""

from collections.abc import AsyncIterator
from typing import Final

import pytest
import pytest_asyncio

from esplanade.planning import Scene
from esplanade.server.app import Running
from tests.browser.chromium import FLAT, browser_fixture, chromium_fixture
from tests.browser.console.worlds import operated
from tests.browser.worlds import entered_at
from tests.patience import PATIENCE_S
from tests.server.client import PLACING_KEY

ROOM: Final = Scene.open_space((0.0, 0.0, 16.0, 12.0), name="room")
ENTRANCE: Final = (4.0, 2.0, 0.0)
ACTORS: Final = 4
OPERATORS: Final = {"olga": "admin", "otto": "admin", "vera": "viewer"}

chromium = chromium_fixture("package", *FLAT)
browser = browser_fixture("package")


@pytest_asyncio.fixture(scope="package", loop_scope="package")
async def server(tmp_path_factory: pytest.TempPathFactory) -> AsyncIterator[Running]:
    """A small world with operators."""
    scene = entered_at(ROOM, ENTRANCE, tmp_path_factory.mktemp("room"))
    more = {
        "keep_chat": True,
        "resume_seconds": PATIENCE_S,
        "operator_key": PLACING_KEY,
        "record": tmp_path_factory.mktemp("recordings"),
        "record_later": True,
    }
    async with operated(OPERATORS, scene=scene, actors=ACTORS, seed=7, **more) as started:
        yield started

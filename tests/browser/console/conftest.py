"""The operators' page in a real chromium."""

from collections.abc import AsyncIterator

import pytest
import pytest_asyncio
from playwright.async_api import BrowserContext

from tests.browser.console.stage import Stage, staged
from tests.browser.console.visit import Visit
from tests.browser.worlds import built


@pytest_asyncio.fixture(loop_scope="module")
async def stage() -> AsyncIterator[tuple[str, Stage]]:
    """A staged server: the address of the page, and what may be changed of it."""
    built("console.html")
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

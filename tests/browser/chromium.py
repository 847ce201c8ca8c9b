"""A real chromium for tests and pictures, and the fixtures that give it to tests."""

import os
import shutil
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any, Final, Literal

import pytest
import pytest_asyncio
from playwright.async_api import Browser, Playwright, async_playwright

from tests.patience import PATIENCE_S

FLAGS: Final = (
    "--no-sandbox",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--host-resolver-rules=MAP world.test 127.0.0.1",
)
WEBGL: Final = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader")
"""Has WebGL drawn in software."""
FLAT: Final = ("--disable-gpu",)
"""Has no WebGL, which pages without a picture in 3D do not need."""
_NAMES: Final = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")


class NoBrowserError(Exception):
    """There is no chromium on this machine."""


@asynccontextmanager
async def launched(*flags: str) -> AsyncIterator[Browser]:
    """A chromium that runs with these flags beside the usual ones.

    Raises
    ------
    NoBrowserError
        None is installed.
    """
    async with async_playwright() as playwright:
        started = await playwright.chromium.launch(
            executable_path=_executable(playwright),
            args=[*FLAGS, *flags],
            timeout=1e3 * PATIENCE_S,
        )
        try:
            yield started
        finally:
            await started.close()


def chromium_fixture(scope: Literal["module", "package"], *flags: str) -> Any:
    """A fixture `chromium` that tests of a module, or of a package, share."""

    @pytest_asyncio.fixture(name="chromium", scope=scope, loop_scope=scope)
    async def chromium() -> AsyncIterator[Browser]:
        try:
            async with launched(*flags) as started:
                yield started
        except NoBrowserError as error:
            pytest.skip(str(error))

    return chromium


def browser_fixture(scope: Literal["module", "package"]) -> Any:
    """A fixture `browser`: that chromium without pages of other tests, which go on drawing."""

    @pytest_asyncio.fixture(name="browser", loop_scope=scope)
    async def browser(chromium: Browser) -> AsyncIterator[Browser]:
        yield chromium
        for context in chromium.contexts:
            await context.close()

    return browser


def _executable(playwright: Playwright) -> str:
    """The chromium that ESPLANADE_CHROMIUM names, the machine's own, or playwright's download."""
    named = os.environ.get("ESPLANADE_CHROMIUM")
    if named:
        return named
    found = next(filter(None, map(shutil.which, _NAMES)), None)
    if found is not None:
        return found
    downloaded = playwright.chromium.executable_path
    if not Path(downloaded).is_file():
        raise NoBrowserError("no chromium or chrome on this machine")
    return downloaded

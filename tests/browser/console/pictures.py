"""Take the pictures of the operators' page anew.

Call it with `python -m tests.browser.console.pictures docs/images`.
"""

import asyncio
import sys
from io import BytesIO
from pathlib import Path
from typing import Any, Final

from PIL import Image
from playwright.async_api import Browser, Locator, Page

from esplanade.server.app import Running
from tests.browser.chromium import FLAT, launched
from tests.browser.console.stage_answers import ACCOUNT
from tests.browser.console.visit import arrived
from tests.browser.console.worlds import operated, script_of
from tests.server.console.operators import Operator

ACTORS: Final = 24
VISITORS: Final = 8
LIVELY_S: Final = 60.0
"""Time for everybody to walk about, so that figures and reasons have something to tell."""
COLOURS: Final = 256
WIDE: Final[dict[str, Any]] = {"width": 1440, "height": 900}
NARROW: Final[dict[str, Any]] = {"width": 390, "height": 844}
NOTE: Final = "more room at the door"


async def take(folder: Path) -> None:
    """All pictures, of a lively gallery."""
    async with operated({ACCOUNT: "director"}, actors=ACTORS) as server, launched(*FLAT) as browser:
        script = await script_of(server, ACCOUNT, "pictures")
        visitors = await _visitors(server)
        try:
            await asyncio.sleep(LIVELY_S)
            await _wide(browser, server, script, folder)
            await _narrow(browser, server, folder)
        finally:
            visitors.terminate()
            await visitors.wait()


async def _wide(browser: Browser, server: Running, script: Operator, folder: Path) -> None:
    page = (await arrived(browser, server, ACCOUNT, **WIDE)).page
    risk = {"op": "set_parameters", "scope": "world", "values": {"risk_weight": 14}, "note": NOTE}
    status, answer = await script.send(risk)
    if status != 200:
        raise RuntimeError(f"the change was refused: {answer}")
    await page.locator("esp-everybody [role=option]").first.click()
    band = page.locator("esp-inspector .band span").first
    await band.wait_for(state="attached")
    await asyncio.sleep(20.0)
    await _save(page, folder / "console.png")
    for panel in ("inspector", "series"):
        area = page.locator("esp-area", has=page.locator(f"esp-{panel}"))
        await _save(area, folder / f"console-{panel}.png")
    await page.get_by_role("tab", name="Parameters", exact=True).click()
    box = page.locator('esp-parameters [data-field="radius_m"]').get_by_role("textbox")
    await box.fill("0.3")
    state = page.locator("esp-parameters .state")
    await state.filter(has_text="preparation").wait_for()
    await box.scroll_into_view_if_needed()
    await _save(page, folder / "console-parameters.png")


async def _narrow(browser: Browser, server: Running, folder: Path) -> None:
    page = (await arrived(browser, server, ACCOUNT, **NARROW)).page
    await page.get_by_role("tab", name="Map", exact=True).click()
    await page.wait_for_selector("canvas.map[data-ms]")
    await _save(page, folder / "console-narrow.png")


async def _visitors(server: Running) -> asyncio.subprocess.Process:
    url = f"ws://127.0.0.1:{server.port}"
    command = ["bots", "--count", str(VISITORS), "--duration", "600", "--url", url]
    return await asyncio.create_subprocess_exec(
        sys.executable, "-m", "esplanade", *command, stdout=asyncio.subprocess.DEVNULL
    )


async def _save(of: Page | Locator, file: Path) -> None:
    """A picture in those colours that most of it has, which makes it small."""
    image = Image.open(BytesIO(await of.screenshot())).convert("RGB")
    counts = image.getcolors(image.width * image.height) or []
    colours = [colour for _, colour in sorted(counts, reverse=True)[:COLOURS]]
    palette = Image.new("P", (1, 1))
    palette.putpalette([part for colour in colours for part in colour])
    image.quantize(palette=palette, dither=Image.Dither.NONE).save(file, optimize=True)


if __name__ == "__main__":
    asyncio.run(take(Path(sys.argv[1])))

"""Take the pictures of the operators' page anew.

Call it with `python -m tests.browser.console.pictures docs/images`.
"""

import asyncio
import sys
from io import BytesIO
from pathlib import Path
from typing import Final

from PIL import Image
from playwright.async_api import Browser, BrowserContext, Locator, Page, async_playwright

from esplanade.server.accounts.identity import MACHINE
from esplanade.server.app import Running, running
from esplanade.server.settings import ServerSettings
from tests.browser.conftest import FLAGS, executable
from tests.browser.console.stage_answers import ACCOUNT, PASSWORD
from tests.patience import PATIENCE_S
from tests.server.console.operators import Operator

ACTORS: Final = 24
VISITORS: Final = 8
LIVELY_S: Final = 60.0
"""Time for everybody to walk about, so that figures and reasons have something to tell."""
COLOURS: Final = 256
WIDE: Final = (1440, 900)
NARROW: Final = (390, 844)
NOTE: Final = "more room at the door"


async def take(folder: Path) -> None:
    """All pictures, of a lively gallery."""
    settings = ServerSettings(
        host="127.0.0.1", port=0, private_host="127.0.0.1", private_port=0, actors=ACTORS
    )
    async with running(settings) as server, async_playwright() as playwright:
        await server.kept.directory.add(MACHINE, ACCOUNT, "director", PASSWORD)
        token = await server.kept.tokens.add(MACHINE, ACCOUNT, "pictures")
        script = Operator(server.private_port, token)
        visitors = await _visitors(server)
        browser = await playwright.chromium.launch(
            executable_path=executable(playwright), args=[*FLAGS]
        )
        try:
            await asyncio.sleep(LIVELY_S)
            await _wide(browser, server, script, folder)
            await _narrow(browser, server, folder)
        finally:
            await browser.close()
            visitors.terminate()
            await visitors.wait()


async def _wide(browser: Browser, server: Running, script: Operator, folder: Path) -> None:
    page = await _page(browser, server, WIDE)
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
    page = await _page(browser, server, NARROW)
    await page.get_by_role("tab", name="Map", exact=True).click()
    await asyncio.sleep(3.0)
    await _save(page, folder / "console-narrow.png")


async def _page(browser: Browser, server: Running, size: tuple[int, int]) -> Page:
    width, height = size
    context: BrowserContext = await browser.new_context(viewport={"width": width, "height": height})
    context.set_default_timeout(1e3 * PATIENCE_S)
    page = await context.new_page()
    await page.goto(f"http://127.0.0.1:{server.private_port}/console")
    await page.get_by_label("Name", exact=True).fill(ACCOUNT)
    await page.get_by_label("Password", exact=True).fill(PASSWORD)
    await page.keyboard.press("Enter")
    await page.get_by_text("live", exact=True).first.wait_for()
    return page


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

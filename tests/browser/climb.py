"""A strip of somebody who climbs the stairs of the gallery, as a page draws it.

Call it with `python -m tests.browser.climb docs/images/climb.png`; a second argument `joints`
shows footprints, joints and targets too. Needs Pillow (`pip install '.[gait]'`).
"""

import asyncio
import io
import math
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

from PIL import Image
from playwright.async_api import Browser, Page

from esplanade.planning import Scene
from esplanade.server.app import running
from esplanade.server.settings import ServerSettings
from tests.browser.chromium import WEBGL, launched
from tests.browser.visitor import Visitor, own

SCENE: Final = Path(__file__).parents[2] / "scenes" / "gallery.json"
WIDTH: Final = 420
HEIGHT: Final = 420
COLUMNS: Final = 3
PICTURES: Final = 6
RISE_M: Final = 0.28
"""Height between one picture and the next."""
SPEED_MPS: Final = 0.6
"""The walk is slow, so that a machine without a graphics card keeps up."""
BEFORE_M: Final = 0.4
"""The walk begins this far before the foot of the stairs."""
FROM_THE_SIDE_PX: Final = -262
"""A drag that turns the camera by a quarter."""
NEARER_PX: Final = -900

_HIDE: Final = """() => {
  for (const id of ["top", "minimap", "storeys", "chat", "chat-toggle", "stick", "labels"]) {
    document.getElementById(id).style.visibility = "hidden";
  }
}"""


def take(joints: bool) -> Image.Image:
    """Six pictures in two rows."""
    scene = Scene.model_validate_json(SCENE.read_text(encoding="utf-8"))
    stairs = next(each for each in scene.stairs if each.bottom_m == 0.0)
    (x, y), (x1, y1) = stairs.start, stairs.end
    far = BEFORE_M / math.hypot(x1 - x, y1 - y)
    foot = (x - far * (x1 - x), y - far * (y1 - y))
    spawn = scene.spawns[0].model_copy(update={"position": foot, "z_m": 0.0, "radius_m": 0.05})
    with TemporaryDirectory() as folder:
        file = Path(folder, "stairs.json")
        file.write_text(scene.model_copy(update={"spawns": (spawn,)}).model_dump_json())
        return _strip(asyncio.run(_run(file, joints)))


async def _run(scene: Path, joints: bool) -> list[Image.Image]:
    settings = ServerSettings(
        host="127.0.0.1",
        port=0,
        private_port=0,
        actors=0,
        scene=scene,
        person_max_speed_mps=SPEED_MPS,
    )
    async with running(settings) as server, launched(*WEBGL) as browser:
        return await _climb(browser, f"http://127.0.0.1:{server.port}/", joints)


async def _climb(browser: Browser, url: str, joints: bool) -> list[Image.Image]:
    context = await browser.new_context(viewport={"width": WIDTH, "height": HEIGHT})
    visitor = await Visitor.arrive(context, url, drawing="fine")
    await visitor.join("Ida")
    page = visitor.page
    if joints:
        await page.click("#help-open")
        await page.check("#skeletons")
        await page.click("#help-close")
    await page.evaluate(_HIDE)
    await _look_from_the_side(page)
    pictures: list[Image.Image] = []
    # The camera looks to the west, and the stairs lead to the north.
    await page.keyboard.down("d")
    while len(pictures) < PICTURES:
        height = len(pictures) * RISE_M

        def high(view: dict[str, object], height: float = height) -> bool:
            me = own(view)
            return me is not None and me["pose"]["z"] >= height

        await visitor.until(high)
        pictures.append(Image.open(io.BytesIO(await page.screenshot())))
    return pictures


async def _look_from_the_side(page: Page) -> None:
    middle = WIDTH / 2
    await page.mouse.move(1.8 * middle, middle)
    await page.mouse.down()
    await page.mouse.move(1.8 * middle + FROM_THE_SIDE_PX, middle, steps=2)
    await page.mouse.up()
    await page.mouse.wheel(0, NEARER_PX)
    await asyncio.sleep(1.5)


def _strip(pictures: list[Image.Image]) -> Image.Image:
    rows = math.ceil(len(pictures) / COLUMNS)
    strip = Image.new("RGB", (COLUMNS * WIDTH, rows * HEIGHT))
    for index, picture in enumerate(pictures):
        strip.paste(picture, (index % COLUMNS * WIDTH, index // COLUMNS * HEIGHT))
    return strip


if __name__ == "__main__":
    take(joints="joints" in sys.argv[2:]).quantize(256).save(sys.argv[1], optimize=True)

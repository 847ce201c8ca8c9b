"""Take the picture of the lively gallery anew.

Call it with `python -m tests.browser.picture docs/images/world.png`.
"""

import asyncio
import math
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

from esplanade.planning import Scene
from esplanade.server.app import running
from esplanade.server.loading import DEFAULT_SCENE
from esplanade.server.settings import ServerSettings
from tests.browser.chromium import WEBGL, launched
from tests.browser.visitor import View, Visitor, own, place_of

ACTORS: Final = 30
VISITORS: Final = 16
SPREAD_S: Final = 25.0
"""Time for everybody to walk away from where they came in."""
VIEWPOINT: Final = (16.5, -7.0)
NEAR_M: Final = 12.0
WALKING_MPS: Final = 0.8
PLANNED: Final = 8
"""The shortest plan that is worth a picture, points."""


def take() -> bytes:
    """A world with actors and visitors, seen from before the fountain, with one actor's plan."""
    scene = Scene.model_validate_json(DEFAULT_SCENE.read_text(encoding="utf-8"))
    spawn = scene.spawns[0].model_copy(update={"position": VIEWPOINT, "radius_m": 0.5})
    with TemporaryDirectory() as folder:
        file = Path(folder, DEFAULT_SCENE.name)
        file.write_text(scene.model_copy(update={"spawns": (spawn,)}).model_dump_json())
        return asyncio.run(_run(file))


async def _run(scene: Path) -> bytes:
    settings = ServerSettings(host="127.0.0.1", port=0, private_port=0, actors=ACTORS, scene=scene)
    async with running(settings) as server:
        address = f"127.0.0.1:{server.port}"
        visitors = await _visitors(f"ws://{address}")
        try:
            await asyncio.sleep(SPREAD_S)
            return await _picture(f"http://{address}/")
        finally:
            visitors.terminate()
            await visitors.wait()


async def _visitors(url: str) -> asyncio.subprocess.Process:
    command = ["bots", "--count", str(VISITORS), "--duration", "600", "--url", url]
    return await asyncio.create_subprocess_exec(
        sys.executable, "-m", "esplanade", *command, stdout=asyncio.subprocess.DEVNULL
    )


async def _picture(url: str) -> bytes:
    async with launched(*WEBGL) as browser:
        context = await browser.new_context(viewport={"width": 1280, "height": 720})
        visitor = await Visitor.arrive(context, url, drawing="fine")
        await visitor.join("Ida")
        await visitor.page.keyboard.press("Enter")
        await visitor.page.keyboard.type("Good morning!")
        await visitor.page.keyboard.press("Enter")
        await visitor.page.keyboard.press("Escape")
        await visitor.page.click("#people-open")
        view = await visitor.look()
        while not _shows_a_plan(view):
            view = await visitor.until(lambda view: _actor_ahead(view) is not None)
            await visitor.page.click(f'#people-list [data-id="{_actor_ahead(view)}"]')
            view = await visitor.until(lambda view: view["plan"] is not None)
        await visitor.page.click("#people-open")
        picture: bytes = await visitor.page.screenshot()
        return picture


def _shows_a_plan(view: View) -> bool:
    """Whether the chosen actor is the one ahead, and on its way."""
    plan = view["plan"]
    return bool(plan and plan["id"] == _actor_ahead(view) and len(plan["path"]) > PLANNED)


def _actor_ahead(view: View) -> int | None:
    """The nearest actor that comes towards the camera, which looks to the north."""
    me = own(view)
    if me is None:
        return None
    x, y = place_of(me)
    ahead = {
        int(avatar["id"]): math.dist((x, y), place_of(avatar))
        for avatar in view["avatars"]
        if avatar["kind"] == "actor"
        and avatar["pose"]["speed"] > WALKING_MPS
        and math.sin(avatar["pose"]["heading"]) < 0.0
        and abs(place_of(avatar)[0] - x) < place_of(avatar)[1] - y
    }
    nearest = min(ahead, key=ahead.__getitem__, default=None)
    return nearest if nearest is not None and ahead[nearest] < NEAR_M else None


if __name__ == "__main__":
    Path(sys.argv[1]).write_bytes(take())

"""Worlds that pages visit: everybody comes in at one place, with room where the tests walk.

The camera of a page that has just come in looks to the north, so `s` walks to the south.
"""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any, Final

import pytest

from esplanade.planning import Scene
from esplanade.server.app import Running, running
from esplanade.server.assets import CLIENT_ASSETS
from esplanade.server.settings import ServerSettings
from tests.patience import PATIENCE_S

Place = tuple[float, float, float]

FORECOURT: Final[Place] = (17.0, 1.5, 0.0)
"""In the gallery: twelve metres of free ground lie to the south of it."""
SPREAD_M: Final = 0.25

PROMENADE: Final = Scene.open_space((0.0, 0.0, 40.0, 160.0), name="promenade")
PROMENADE_END: Final[Place] = (20.0, 155.0, 0.0)
"""From here one walks to the south for a minute and a half."""


@asynccontextmanager
async def served(**changes: Any) -> AsyncIterator[Running]:
    """A running world, that drops no page because its machine is slow."""
    values: dict[str, Any] = {
        "host": "127.0.0.1",
        "port": 0,
        "private_port": 0,
        "log_level": "warning",
        "hello_timeout_s": 60.0,
        "drop_seconds": PATIENCE_S,
    }
    if "roster" not in changes:
        values["actors"] = 0
    async with running(ServerSettings(**{**values, **changes})) as server:
        yield server


@asynccontextmanager
async def world(**changes: Any) -> AsyncIterator[str]:
    """The address at which people come into such a world."""
    async with served(**changes) as server:
        yield f"http://127.0.0.1:{server.port}/"


def built(page: str) -> None:
    """Fail a test of a page that is not built."""
    if not (CLIENT_ASSETS / page).is_file():
        pytest.fail("the web client is not built; run: make client")


def entered_at(scene: Scene, place: Place, folder: Path) -> Path:
    """A file of the scene in which everybody comes in at this place."""
    x, y, z_m = place
    spawn = {"position": (x, y), "z_m": z_m, "radius_m": SPREAD_M}
    # Validated anew, so that the spawn is one.
    path = folder / "scene.json"
    moved = Scene.model_validate({**scene.model_dump(), "spawns": [spawn]})
    path.write_text(moved.model_dump_json())
    return path

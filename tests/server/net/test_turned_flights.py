"""People on turned flights of 0.9 m, over real sockets: by keys, and by a click on the floor."""

import asyncio
import json
import math
from pathlib import Path

import pytest

from esplanade import bots
from esplanade.bots.events import SnapshotEvent
from esplanade.protocol.messages import Error
from tests.patience import PATIENCE_S
from tests.server.client import PLACING_KEY
from tests.server.conftest import Serving

DEGREES = (0, 18, 30, 45, 60, 77)
ASIDE_DEG = 6.0
"""Keys that do not point along the flight lead a person against its side."""
SPEED_MPS = 2.5
WIDTH_M, TOP_M = 0.9, 1.6
APART_M = 9.0
STUCK_TICKS = 5

Point = tuple[float, float]


def at(number: int, along: float, across: float = 0.0) -> Point:
    """A point of the flight with this number, from its middle."""
    a = math.radians(DEGREES[number])
    x, y = APART_M * (number + 0.5) + 0.07 * number, 5.0 + 0.05 * number
    return (
        x + along * math.cos(a) - across * math.sin(a),
        y + along * math.sin(a) + across * math.cos(a),
    )


@pytest.fixture
def scene_file(tmp_path: Path) -> Path:
    """Flights of eight steps up to floors, each at another angle."""
    numbers = range(len(DEGREES))
    scene = {
        "bounds": (0.0, 0.0, APART_M * len(DEGREES) + 1.0, 10.0),
        "stairs": [
            {
                "start": at(k, -1.2),
                "end": at(k, 1.2),
                "width_m": WIDTH_M,
                "top_m": TOP_M,
                "steps": 8,
            }
            for k in numbers
        ],
        "polygons": [
            {
                "kind": "floor",
                "height_m": TOP_M,
                "points": [at(k, 1.2, -1.2), at(k, 3.4, -1.2), at(k, 3.4, 1.2), at(k, 1.2, 1.2)],
            }
            for k in numbers
        ],
    }
    path = tmp_path / "flights.json"
    path.write_text(json.dumps(scene))
    return path


async def steer(bot: bots.Bot, direction: float, height: float, along: Point) -> int:
    """Hold a key until the feet are at a height and the flight is behind; the longest standstill.

    `along` is the direction of the flight on the map, towards where the way leads.
    """
    x0, y0, _ = bot.position
    await bot.move(direction, SPEED_MPS)
    last, standing, longest, moving = bot.position, 0, 0, False
    async for event in bot.events():
        if not isinstance(event, SnapshotEvent):
            continue
        here = bot.position
        moved = math.dist(here[:2], last[:2])
        moving = moving or moved > 0.02
        standing = standing + 1 if moving and moved < 0.02 else 0
        longest = max(longest, standing)
        gone = (here[0] - x0) * along[0] + (here[1] - y0) * along[1]
        if abs(here[2] - height) < 0.01 and gone > 2.9:
            break
        assert standing < 20 * STUCK_TICKS, f"stuck at {here}"
        last = here
    await bot.stop()
    return longest


async def by_keys(port: int, number: int, aside_deg: float) -> None:
    a = math.radians(DEGREES[number])
    off = math.radians(aside_deg)
    url = f"ws://127.0.0.1:{port}"
    place = at(number, -1.6)
    async with bots.connect(url, at=(*place, 0), operator=PLACING_KEY) as bot:
        for height, turn in ((TOP_M, 0.0), (0.0, math.pi)):
            along = math.cos(a + turn), math.sin(a + turn)
            standstill = await steer(bot, a + turn + off, height, along)
            assert standstill <= STUCK_TICKS, f"{standstill} ticks without moving"


async def by_click(port: int, number: int) -> None:
    url = f"ws://127.0.0.1:{port}"
    foot, top = at(number, -1.6), at(number, 1.7)
    async with bots.connect(url, at=(*foot, 0), operator=PLACING_KEY) as bot:
        for x, y, z in ((*top, TOP_M), (*foot, 0.0)):
            await bot.walk_to(x, y, z)
            async for event in bot.events():
                assert not isinstance(event, Error), event.text
                if math.dist(bot.position, (x, y, z)) < 0.05:
                    break


async def test_keys_and_clicks_lead_up_and_down_turned_flights(
    serving: Serving, scene_file: Path
) -> None:
    async with (
        serving(scene=scene_file) as server,
        asyncio.timeout(PATIENCE_S),
        asyncio.TaskGroup() as people,
    ):
        for number in range(len(DEGREES)):
            people.create_task(by_click(server.port, number))
            for aside_deg in (0.0, ASIDE_DEG, -ASIDE_DEG):
                people.create_task(by_keys(server.port, number, aside_deg))

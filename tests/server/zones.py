"""A world of two zones for tests: a yard, and a hall behind its gate."""

import asyncio
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

from tests.patience import PATIENCE_S

YARD: dict[str, Any] = {
    "name": "The yard",
    "bounds": [0, 0, 20, 20],
    "spawns": [{"position": [4, 10], "radius_m": 0.5}],
    "doors": [{"name": "shed", "start": [1, 19], "end": [2, 19]}],
    "portals": [
        {"name": "gate", "points": [[16, 8], [18, 8], [18, 12], [16, 12]], "arrival": [14, 10]}
    ],
}
HALL: dict[str, Any] = {
    "name": "The hall",
    "bounds": [0, 0, 12, 12],
    "spawns": [{"position": [10, 10], "radius_m": 0.5}],
    "portals": [{"name": "door", "points": [[1, 5], [2, 5], [2, 7], [1, 7]], "arrival": [4, 6]}],
}
BEFORE_GATE = (15.0, 10.0, 0)
IN_GATE = (17.0, 10.0, 0)
"""Places of the yard."""


def write_town(
    folder: Path, *, with_actors: bool = False, start: str = "yard", **of_hall: Any
) -> Path:
    """The file of a world that newcomers enter in the yard; some facts of the hall are given.

    With `with_actors`, they may walk from the yard to the hall.
    """
    (folder / "yard.json").write_text(json.dumps(YARD))
    (folder / "hall.json").write_text(json.dumps(HALL))
    gate, door = {"zone": "yard", "portal": "gate"}, {"zone": "hall", "portal": "door"}
    town = {
        "name": "Town",
        "start": start,
        "zones": [
            {"name": "hall", "scene": "hall.json", **of_hall},
            {"name": "yard", "scene": "yard.json"},
        ],
        "exits": [
            {"from": gate, "to": door, "actors": with_actors},
            {"from": door, "to": gate},
        ],
    }
    path = folder / "town.json"
    path.write_text(json.dumps(town))
    return path


async def until(condition: Callable[[], bool]) -> None:
    """Let the server run until a condition holds."""
    async with asyncio.timeout(PATIENCE_S):
        while not condition():  # noqa: ASYNC110 - nothing tells of it
            await asyncio.sleep(0.01)

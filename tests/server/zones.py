"""A world of two zones for tests: a yard, and a hall behind its gate."""

import json
from pathlib import Path
from typing import Any

YARD = {
    "name": "The yard",
    "bounds": [0, 0, 20, 20],
    "spawns": [{"position": [4, 10], "radius_m": 0.5}],
    "portals": [
        {"name": "gate", "points": [[16, 8], [18, 8], [18, 12], [16, 12]], "arrival": [14, 10]}
    ],
}
HALL = {
    "name": "The hall",
    "bounds": [0, 0, 12, 12],
    "spawns": [{"position": [10, 10], "radius_m": 0.5}],
    "portals": [{"name": "door", "points": [[1, 5], [2, 5], [2, 7], [1, 7]], "arrival": [4, 6]}],
}
BEFORE_GATE = (15.0, 10.0, 0)
IN_GATE = (17.0, 10.0, 0)
"""Places of the yard."""


def write_town(folder: Path, **of_hall: Any) -> Path:
    """The file of a world that newcomers enter in the yard; some facts of the hall are given."""
    (folder / "yard.json").write_text(json.dumps(YARD))
    (folder / "hall.json").write_text(json.dumps(HALL))
    gate, door = {"zone": "yard", "portal": "gate"}, {"zone": "hall", "portal": "door"}
    town = {
        "name": "Town",
        "start": "yard",
        "zones": [
            {"name": "hall", "scene": "hall.json", **of_hall},
            {"name": "yard", "scene": "yard.json"},
        ],
        "exits": [{"from": gate, "to": door}, {"from": door, "to": gate}],
    }
    path = folder / "town.json"
    path.write_text(json.dumps(town))
    return path

"""Small scenes that contain many kinds of parts."""

import itertools
import json
from pathlib import Path
from typing import Any

from esplanade.planning import Scene

LOFT: dict[str, Any] = {
    "name": "Loft",
    "bounds": [0, 0, 12, 8],
    "polygons": [
        {
            "kind": "floor",
            "offset_m": 2.8,
            "height_m": 0.2,
            "points": [[8, 0], [12, 0], [12, 8], [8, 8]],
        },
        {"kind": "wall", "height_m": 4.5, "points": [[0, 6], [3, 6], [3, 6.5], [0, 6.5]]},
        {"kind": "wall", "height_m": 4.5, "points": [[4.5, 6], [8, 6], [8, 6.5], [4.5, 6.5]]},
        {
            "kind": "wall",
            "offset_m": 1.5,
            "height_m": 3.0,
            "points": [[3, 6], [4.5, 6], [4.5, 6.5], [3, 6.5]],
        },
        {"kind": "wall", "height_m": 2.8, "points": [[8, 6], [8.5, 6], [8.5, 8], [8, 8]]},
    ],
    "stairs": [{"start": [3, 2], "end": [8, 2], "width_m": 2, "top_m": 3.0, "steps": 16}],
    "spawns": [{"position": [1, 2]}],
    "places": [
        {"name": "loft", "position": [10, 4], "z_m": 3.0},
        {"name": "below", "position": [10, 4]},
        {"name": "den", "position": [3.5, 7.25]},
    ],
}
"""A floor above the ground, stairs to it, and a den behind a passage 1.5 m high."""


def loft(**changes: Any) -> Scene:
    """The scene `LOFT` with some parts replaced."""
    return Scene.model_validate({**LOFT, **changes})


def write(folder: Path, parts: Any) -> Path:
    """A scene file."""
    path = folder / "scene.json"
    path.write_text(json.dumps(parts))
    return path


_FACES = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))


def write_building(folder: Path, z_up: bool = False) -> Path:
    """A mesh, OBJ: a ground of 10 m x 8 m, and stairs of twelve steps to a floor at 2.4 m."""
    boxes = [((0, 0, -0.2), (10, 8, 0)), ((6.6, 0, 2.2), (10, 8, 2.4))]
    boxes += [((3 + 0.3 * k, 3, 0), (3.3 + 0.3 * k, 5, 0.2 * (k + 1))) for k in range(12)]
    lines: list[str] = []
    for number, box in enumerate(boxes):
        for x, y, z in itertools.product(*zip(*box, strict=True)):
            lines.append(f"v {x} {y} {z}" if z_up else f"v {x} {z} {-y}")
        for face in _FACES:
            corners = " ".join(str(8 * number + corner + 1) for corner in face)
            lines.append(f"f {corners}")
    path = folder / "building.obj"
    path.write_text("\n".join(lines) + "\n")
    return path

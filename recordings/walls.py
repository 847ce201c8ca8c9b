"""Walls around a recorded crowd, from the JSON file that lies beside it."""

import json
import math
from pathlib import Path
from typing import Any, Final, NamedTuple

from esplanade.recordings.errors import RecordingError, read_text
from esplanade.recordings.units import MAX_METRES

Wall = tuple[tuple[float, float], tuple[float, float]]
"""A straight wall from (x, y) to (x, y), metres."""

CIRCLE_EDGES: Final = 16
"""A circle becomes a polygon of this many walls, which is at most 2 % larger than the circle."""


def walls_beside(crowd_path: str | Path) -> Path | None:
    """The file of walls beside a recording, `<name>.walls.json`; None if there is no such file."""
    path = Path(crowd_path).with_suffix(".walls.json")
    return path if path.is_file() else None


class Obstacles(NamedTuple):
    """The obstacles of a recording: straight walls, and circles as (x, y, radius), metres."""

    segments: tuple[Wall, ...] = ()
    circles: tuple[tuple[float, float, float], ...] = ()

    def as_walls(self) -> list[Wall]:
        """All obstacles as straight walls; circles become regular polygons around them."""
        return [*self.segments, *(edge for circle in self.circles for edge in _polygon(*circle))]


def read_walls(path: str | Path) -> list[Wall]:
    """Read the walls of a file like `read_obstacles`, with circles as polygons."""
    return read_obstacles(path).as_walls()


def read_obstacles(path: str | Path) -> Obstacles:
    """Read a file `{"segments": [[x1, y1, x2, y2], ...], "circles": [[x, y, r], ...]}`.

    All numbers are in metres. Either list may be absent.

    Raises
    ------
    RecordingError
        The file cannot be read, is no JSON object of that form, or has a number that is not
        finite, a wall of length 0 or a circle of radius 0.
    """
    path = Path(path)
    content = _parse(path)
    segments: list[Wall] = []
    circles: list[tuple[float, float, float]] = []
    for where, (x1, y1, x2, y2) in _rows(path, content, "segments", "x1, y1, x2, y2"):
        if (x1, y1) == (x2, y2):
            raise RecordingError(path, f"{where} has no length, expected two different ends")
        segments.append(((x1, y1), (x2, y2)))
    for where, (x, y, radius_m) in _rows(path, content, "circles", "x, y, r"):
        if radius_m <= 0.0:
            raise RecordingError(path, f"{where} has radius {radius_m:g}, expected more than 0")
        circles.append((x, y, radius_m))
    return Obstacles(tuple(segments), tuple(circles))


def _parse(path: Path) -> dict[str, Any]:
    text = read_text(path)
    try:
        content = json.loads(text)
    except json.JSONDecodeError as error:
        raise RecordingError(path, f"is not JSON: {error.msg}", error.lineno) from None
    except ValueError:  # the only other cause is an integer with more digits than Python converts
        raise RecordingError(path, "holds a number out of range, expected metres") from None
    except RecursionError:
        raise RecordingError(path, "is nested too deeply, expected two lists of numbers") from None
    if not isinstance(content, dict):
        raise RecordingError(path, "expected an object with segments and circles")
    unknown = sorted(set(content) - {"segments", "circles"})
    if unknown:
        raise RecordingError(path, f"unknown key {unknown[0]!r:.40}, expected segments or circles")
    return content


def _rows(
    path: Path, content: dict[str, Any], key: str, columns: str
) -> list[tuple[str, tuple[float, ...]]]:
    """The rows of one list with their names; each is checked to have the right number of finite
    numbers."""
    rows = content.get(key, [])
    if not isinstance(rows, list):
        raise RecordingError(path, f"{key} is no list, expected rows of {columns}")
    checked = []
    for index, row in enumerate(rows):
        where = f"{key}[{index}]"
        if not isinstance(row, list) or len(row) != len(columns.split(",")):
            raise RecordingError(path, f"{where} is {row!r:.40}, expected [{columns}]")
        for value in row:
            if isinstance(value, bool) or not isinstance(value, int | float):
                raise RecordingError(path, f"{where} holds {value!r:.40}, expected numbers")
            if not abs(value) <= MAX_METRES:
                raise RecordingError(
                    path, f"{where} holds {value}, expected metres up to {MAX_METRES:g} either way"
                )
        checked.append((where, tuple(float(value) for value in row)))
    return checked


def _polygon(x: float, y: float, radius_m: float) -> list[Wall]:
    """Edges of the regular polygon that touches the circle from outside."""
    corner_m = radius_m / math.cos(math.pi / CIRCLE_EDGES)
    angles = [2.0 * math.pi * edge / CIRCLE_EDGES for edge in range(CIRCLE_EDGES)]
    corners = [(x + corner_m * math.cos(a), y + corner_m * math.sin(a)) for a in angles]
    return list(zip(corners, corners[1:] + corners[:1], strict=True))

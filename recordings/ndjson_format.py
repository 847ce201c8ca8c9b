"""TrajNet++ recordings: one JSON object a line, which is a scene or a sample of a track.

Frames keep the numbers that they had in the video, but the file holds only every sixth or tenth
of them, and `fps` of a scene counts only frames in the file.
"""

import json
import math
from pathlib import Path
from typing import Any, Final

import numpy as np

from esplanade.recordings.errors import RecordingError
from esplanade.recordings.rows import Rows, people

DEFAULT_SAMPLES_PER_S: Final = 2.5
"""The value for files whose scenes have no `fps`; all TrajNet++ files are sampled at this rate."""


def read_ndjson(path: Path, text: str) -> Rows:
    """Read the samples; predicted tracks, which have a `prediction_number`, are passed over.

    Raises
    ------
    RecordingError
        A line is no JSON object with a scene or a track, a value is missing or of the wrong
        kind, or scenes differ in their `fps`.
    """
    lines: list[int] = []
    names: list[str] = []
    columns: tuple[list[float], list[float], list[float]] = ([], [], [])
    samples_per_s: float | None = None
    for line, row in enumerate(text.split("\n"), start=1):
        if not row.strip():
            continue
        kind, content = _parse(path, line, row)
        if kind == "scene":
            samples_per_s = _scene_fps(path, line, content, samples_per_s)
        elif content.get("prediction_number") is None:
            lines.append(line)
            names.append(_pedestrian(path, line, content))
            for column, value in zip(columns, _sample(path, line, content), strict=True):
                column.append(value)
    ids, who = people(names)
    clock, x, y = (np.array(column, np.float64) for column in columns)
    return Rows(
        format="TrajNet++",
        lines=np.array(lines, np.int64),
        ids=ids,
        who=who,
        clock=clock,
        x=x,
        y=y,
        counts_frames=True,
        samples_per_s=samples_per_s or DEFAULT_SAMPLES_PER_S,
        usual_from="as its scenes say" if samples_per_s else "as all of TrajNet++ has",
        unit="m",
        unit_from="as its form has it",
    )


def _parse(path: Path, line: int, text: str) -> tuple[str, dict[str, Any]]:
    try:
        content = json.loads(text)
    except (ValueError, RecursionError):
        raise RecordingError(path, f"{text!r:.40} is not JSON", line) from None
    if isinstance(content, dict):
        for kind in ("scene", "track"):
            if isinstance(content.get(kind), dict):
                return kind, content[kind]
    raise RecordingError(path, 'expected {"scene": {...}} or {"track": {...}}', line)


def _scene_fps(path: Path, line: int, scene: dict[str, Any], before: float | None) -> float | None:
    if scene.get("fps") is None:
        return before
    fps = _number(path, line, scene, "fps")
    if not (math.isfinite(fps) and 0.0 < fps < 1e6):
        raise RecordingError(path, f"fps is {fps:g}, expected more than 0", line)
    if before is not None and fps != before:
        raise RecordingError(path, f"fps is {fps:g}, but {before:g} in a scene before", line)
    return fps


def _pedestrian(path: Path, line: int, track: dict[str, Any]) -> str:
    pedestrian = track.get("p")
    if isinstance(pedestrian, float) and pedestrian.is_integer():
        pedestrian = int(pedestrian)
    if isinstance(pedestrian, bool) or not isinstance(pedestrian, int):
        raise RecordingError(path, f"p is {pedestrian!r:.40}, expected a whole number", line)
    try:
        return str(pedestrian)
    except ValueError:  # more digits than Python writes
        raise RecordingError(path, "p is out of range", line) from None


def _sample(path: Path, line: int, track: dict[str, Any]) -> tuple[float, float, float]:
    frame = _number(path, line, track, "f")
    if not (math.isfinite(frame) and frame.is_integer()):
        raise RecordingError(path, f"f is {frame:g}, expected a whole number", line)
    x, y = (_number(path, line, track, name) for name in "xy")
    return frame, x, y


def _number(path: Path, line: int, content: dict[str, Any], name: str) -> float:
    value = content.get(name)
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise RecordingError(path, f"{name} is {value!r:.40}, expected a number", line)
    try:
        return float(value)
    except OverflowError:
        raise RecordingError(path, f"{name} is out of range", line) from None

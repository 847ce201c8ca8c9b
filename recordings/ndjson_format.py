"""TrajNet++ recordings: one JSON object a line, which is a scene or a sample of a track.

Frames keep the numbers that they had in the video, but the file holds only every sixth or tenth
of them, and `fps` of a scene counts only frames in the file. Therefore one second has `fps` ×
(difference of neighbouring frames) frame numbers.
"""

import json
import math
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, Final, NamedTuple

from esplanade.recordings.errors import RecordingError, read_text
from esplanade.recordings.sample import Sample

DEFAULT_SAMPLES_PER_S: Final = 2.5
"""The value for files whose scenes have no `fps`; all TrajNet++ files are sampled at this rate."""


class _Row(NamedTuple):
    frame: int
    line: int
    id: str
    x: float
    y: float


def read_ndjson(path: Path, fps: float | None) -> Iterator[Sample]:
    """Yield the samples in the order of time.

    `fps` is the number of frame numbers in a second; it overrides the scenes of the file.
    Predicted tracks, which have a `prediction_number`, are skipped. Exact repeats of a sample are
    skipped too, as files have them where scenes overlap.

    Raises
    ------
    RecordingError
        A line is no JSON object with a scene or a track, a value is missing or of the wrong
        kind, or scenes differ in their `fps`.
    """
    rows: dict[tuple[int, str, float, float], _Row] = {}
    samples_per_s: float | None = None
    for line, text in enumerate(read_text(path).splitlines(), start=1):
        if not text.strip():
            continue
        kind, content = _parse(path, line, text)
        if kind == "scene":
            samples_per_s = _scene_fps(path, line, content, samples_per_s)
        elif content.get("prediction_number") is None:
            row = _row(path, line, content)
            rows.setdefault((row.frame, row.id, row.x, row.y), row)
    frames_per_s = fps or (samples_per_s or DEFAULT_SAMPLES_PER_S) * _frame_step(rows.values())
    for row in sorted(rows.values()):
        yield Sample(row.line, row.frame / frames_per_s, row.id, row.x, row.y)


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
    if not (math.isfinite(fps) and fps > 0.0):
        raise RecordingError(path, f"fps is {fps:g}, expected more than 0", line)
    if before is not None and fps != before:
        raise RecordingError(path, f"fps is {fps:g}, but {before:g} in a scene before", line)
    return fps


def _row(path: Path, line: int, track: dict[str, Any]) -> _Row:
    frame = _number(path, line, track, "f")
    if not (math.isfinite(frame) and frame.is_integer()):
        raise RecordingError(path, f"f is {frame:g}, expected a whole number", line)
    pedestrian = track.get("p")
    if isinstance(pedestrian, bool) or not isinstance(pedestrian, int):
        raise RecordingError(path, f"p is {pedestrian!r:.40}, expected a whole number", line)
    x, y = (_number(path, line, track, name) for name in "xy")
    return _Row(int(frame), line, str(pedestrian), x, y)


def _number(path: Path, line: int, content: dict[str, Any], name: str) -> float:
    value = content.get(name)
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise RecordingError(path, f"{name} is {value!r:.40}, expected a number", line)
    try:
        return float(value)
    except OverflowError:
        raise RecordingError(path, f"{name} is out of range", line) from None


def _frame_step(rows: Iterable[_Row]) -> int:
    """The greatest common divisor of all differences of frames; 1 for a single frame."""
    frames = sorted({row.frame for row in rows})
    return math.gcd(*(frame - frames[0] for frame in frames[1:])) or 1

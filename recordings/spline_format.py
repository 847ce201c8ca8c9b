"""UCY's annotations: each person's way as a spline through points clicked in the video."""

import re
from pathlib import Path
from typing import Final

import numpy as np

from esplanade.files.text import lines_of
from esplanade.recordings.errors import RecordingError
from esplanade.recordings.rows import Floats, Rows, number, people

FPS: Final = 25.0
SAMPLE_FRAMES: Final = 10
"""People are sampled every so many frames, 0.4 s, as everyone does with these files."""
MAX_SAMPLES: Final = 3_000_000
_MOST_OF_A_LINE: Final = 1000
MAX_FRAMES: Final = 10_000_000
_REMARK: Final = re.compile(r"\s+-\s.*$|\s*\(.*$")


def looks_like_splines(text: str) -> bool:
    """Whether the text begins with a number of splines and a number of points."""
    heads = [_REMARK.sub("", line).split() for line in text[:2000].split("\n") if line.strip()]
    return (
        len(heads) > 2
        and [len(head) for head in heads[:3]] == [1, 1, 4]
        and all(head[0].isdecimal() for head in heads[:2])
    )


def read_splines(path: Path, text: str) -> Rows:
    """Read the splines, and sample each every `SAMPLE_FRAMES` frames.

    Raises
    ------
    RecordingError
        A number or a point is missing, or frames of a spline do not grow.
    """
    lines: list[tuple[int, list[str]]] = []
    for number_, written in enumerate(lines_of(text), start=1):
        if len(written) > _MOST_OF_A_LINE:
            raise RecordingError(path, "has too many characters for a point of a spline", number_)
        if cells := _REMARK.sub("", written).split():
            lines.append((number_, cells))
    place = 1
    names: list[str] = []
    numbers: list[int] = []
    parts: list[Floats] = []
    total = 0
    count = _count(path, lines[0])
    for spline in range(count):
        if place >= len(lines):
            raise RecordingError(path, f"expected {count} splines, not {spline}", lines[-1][0])
        line, points = lines[place][0], _count(path, lines[place])
        rows = lines[place + 1 : place + 1 + points]
        if len(rows) < points:
            raise RecordingError(path, f"expected {points} points, not {len(rows)}", line)
        place += 1 + points
        if not points:
            continue
        sampled = _sampled(path, rows)
        total += len(sampled)
        if total > MAX_SAMPLES:
            raise RecordingError(path, f"its splines have more than {MAX_SAMPLES} samples", line)
        parts.append(sampled)
        names += [str(spline + 1)] * len(sampled)
        numbers += [line] * len(sampled)
    ids, who = people(names)
    block = np.concatenate([np.empty((0, 3)), *parts])
    return Rows(
        format="UCY splines",
        lines=np.array(numbers, np.int64),
        ids=ids,
        who=who,
        clock=block[:, 2],
        x=block[:, 0],
        y=block[:, 1],
        counts_frames=True,
        usual_fps=FPS,
        usual_from="as UCY's videos have",
    )


def _count(path: Path, line: tuple[int, list[str]]) -> int:
    where, cells = line
    if len(cells) == 1 and cells[0].isdecimal() and len(cells[0]) < 9:
        return int(cells[0])
    raise RecordingError(path, f"{' '.join(cells)!r:.40} is no number of splines or points", where)


def _sampled(path: Path, rows: list[tuple[int, list[str]]]) -> Floats:
    """The samples (x, y, frame) of a spline, (N, 3); the points themselves at its ends."""
    from scipy.interpolate import PchipInterpolator  # noqa: PLC0415 (few files need it)

    points: Floats = np.empty((len(rows), 3))
    for i, (line, cells) in enumerate(rows):
        if len(cells) not in (3, 4):
            raise RecordingError(path, f"expected x y frame angle, not {len(cells)} columns", line)
        for j, column in enumerate(("x", "y", "frame")):
            points[i, j] = number(path, line, column, cells[j])
            if not np.isfinite(points[i, j]):
                raise RecordingError(
                    path, f"{column} is {cells[j]}, expected a finite number", line
                )
        if i and points[i, 2] < points[i - 1, 2]:
            raise RecordingError(path, "the frame goes back, expected a later one", line)
    frames = points[:, 2]
    keep = np.append(True, np.diff(frames) > 0)
    kept: Floats = points[keep]
    frames = frames[keep]
    if abs(frames[0]) > MAX_FRAMES or frames[-1] - frames[0] > MAX_FRAMES:
        raise RecordingError(path, f"frame {frames[-1]:g} is out of range", rows[-1][0])
    if len(frames) < 2:
        return kept
    first = np.ceil(frames[0] / SAMPLE_FRAMES) * SAMPLE_FRAMES
    at = np.arange(first, frames[-1] + 1e-9, SAMPLE_FRAMES)
    if len(at) < 2:
        at = frames[[0, -1]]
    places: Floats = PchipInterpolator(frames, kept[:, :2], axis=0)(at)
    sampled: Floats = np.column_stack([places, at])
    return sampled

"""ETH's `obsmat.txt`: one sample a line in eight columns; times are numbers of video frames."""

import math
from collections.abc import Iterator
from pathlib import Path
from typing import Final

from esplanade.recordings.errors import RecordingError, read_text
from esplanade.recordings.sample import Sample, number

COLUMNS: Final = ("frame", "id", "x", "z", "y", "vx", "vz", "vy")

DEFAULT_FPS: Final = 15.0
"""Frames a second of the well-known recordings, which have a sample every six frames (0.4 s)."""


def read_obsmat(path: Path, fps: float | None) -> Iterator[Sample]:
    """Yield the samples in the order of the file; z is up, and velocities are not used.

    Raises
    ------
    RecordingError
        The number of columns is wrong, a cell is not a number, or an id is not a whole number.
    """
    frames_per_s = DEFAULT_FPS if fps is None else fps
    for line, text in enumerate(read_text(path).splitlines(), start=1):
        cells = text.split()
        if not cells:
            continue
        if len(cells) != len(COLUMNS):
            expected = f"expected 8 columns {' '.join(COLUMNS)}, not {len(cells)}"
            raise RecordingError(path, expected, line)
        values = {
            name: number(path, line, name, cell) for name, cell in zip(COLUMNS, cells, strict=True)
        }
        pedestrian = values["id"]
        if not (math.isfinite(pedestrian) and pedestrian.is_integer()):
            raise RecordingError(path, f"id is {pedestrian:g}, expected a whole number", line)
        t = values["frame"] / frames_per_s
        yield Sample(line, t, str(int(pedestrian)), values["x"], values["y"])

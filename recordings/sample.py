"""What every format of recording comes down to."""

from pathlib import Path
from typing import Final, NamedTuple

from esplanade.recordings.errors import RecordingError

MAX_METRES: Final = 100_000.0
"""A coordinate farther out than this, either way, is taken for a fault of the file."""


class Sample(NamedTuple):
    """Pedestrian `id` is at (x, y) metres at `t` seconds; `line` of the file says so (from 1)."""

    line: int
    t: float
    id: str
    x: float
    y: float


def number(path: Path, line: int, column: str, text: str) -> float:
    """A column's number; RecordingError says where there is none."""
    try:
        return float(text)
    except ValueError:
        raise RecordingError(path, f"{column} is {text!r:.40}, expected a number", line) from None

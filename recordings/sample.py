"""The sample, which all formats of recordings are read into."""

from pathlib import Path
from typing import Final, NamedTuple

from esplanade.recordings.errors import RecordingError

MAX_METRES: Final = 100_000.0
"""Coordinates beyond this, either way, are taken for errors of the file."""


class Sample(NamedTuple):
    """The position (x, y), metres, of pedestrian `id` at `t` seconds.

    It comes from line `line` of the file; lines count from 1.
    """

    line: int
    t: float
    id: str
    x: float
    y: float


def number(path: Path, line: int, column: str, text: str) -> float:
    """The number in a column of a line.

    Raises
    ------
    RecordingError
        The text is not a number.
    """
    try:
        return float(text)
    except ValueError:
        raise RecordingError(path, f"{column} is {text!r:.40}, expected a number", line) from None

"""Comma-separated recordings: the header `t,id,x,y`, then one sample a line (seconds, metres)."""

from collections.abc import Iterator
from pathlib import Path
from typing import Final

from esplanade.recordings.errors import RecordingError, read_text
from esplanade.recordings.sample import Sample, number

HEADER: Final = ["t", "id", "x", "y"]


def read_csv(path: Path) -> Iterator[Sample]:
    """Yield the samples in the order of the file; blank lines are skipped.

    Raises
    ------
    RecordingError
        The file is empty, its header or a number of columns is wrong, an id is empty, or a t, x
        or y is not a number.
    """
    lines = read_text(path).splitlines()
    if not lines:
        raise RecordingError(path, "is empty, expected the header t,id,x,y")
    header = [cell.strip() for cell in lines[0].split(",")]
    if header != HEADER:
        raise RecordingError(path, f"expected the header t,id,x,y, not {lines[0]!r:.60}", 1)
    for line, text in enumerate(lines[1:], start=2):
        if text.strip():
            yield _sample(path, line, text)


def _sample(path: Path, line: int, text: str) -> Sample:
    cells = [cell.strip() for cell in text.split(",")]
    if len(cells) != len(HEADER):
        raise RecordingError(path, f"expected 4 columns t,id,x,y, not {len(cells)}", line)
    t, pedestrian, x, y = cells
    if not pedestrian:
        raise RecordingError(path, "expected a pedestrian's id, not an empty cell", line)
    return Sample(
        line,
        number(path, line, "t", t),
        pedestrian,
        number(path, line, "x", x),
        number(path, line, "y", y),
    )

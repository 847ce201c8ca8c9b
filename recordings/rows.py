"""Rows: what every format is read into, before times, metres and tracks are made of it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt

from esplanade.recordings.errors import RecordingError

Floats = npt.NDArray[np.float64]
Whole = npt.NDArray[np.signedinteger]

_MOST_DIGITS: Final = 400
_PIECE: Final = 65_536
EXACT_WHOLE: Final = 2.0**53
"""Greater whole numbers are not told apart as floating-point numbers."""


class Given(NamedTuple):
    """Statements about a file by the one who reads it, where the file has none or wrong ones.

    `fps` is the number of frame numbers in a second, `unit` the name of a unit of length, `scale`
    the metres in one unit of the file. With `strict`, glitches are refused. `columns` names the
    columns of a table: a name for each, or `role=name` for those that count.
    """

    fps: float | None = None
    unit: str | None = None
    scale: float | None = None
    strict: bool = False
    columns: tuple[str, ...] = ()


AS_IT_SAYS: Final = Given()


@dataclass(frozen=True, eq=False)
class Rows:
    """The samples of a file in its order, with its own numbers.

    `lines` (N,) is where each stands, a range where they follow each other, `who` (N,) whose it
    is, an index into `ids`. `clock` (N,) is seconds or, if `counts_frames`, numbers of frames. `x`
    and `y` (N,) are in units of the file.
    """

    format: str
    lines: Whole | range
    ids: Sequence[str]
    who: Whole
    clock: Floats
    x: Floats
    y: Floats
    counts_frames: bool = False
    velocities: Floats | None = None
    """In metres a second, or in units of the file a second: which, is found by the rate."""
    z: Floats | None = None
    """The coordinate beside `x` and `y`: heights, unless the file has `y` for the height."""
    times_named: bool = False
    """Whether the file says in which unit its times are."""
    fps: float | None = None
    """Frames a second, as the file says."""
    samples_per_s: float | None = None
    """Samples a second, as the file says."""
    usual_fps: float | None = None
    """Frames a second of the sets that have this form."""
    usual_from: str = ""
    unit: str | None = None
    """The unit of length, as the file says or shows; "px" for pixels."""
    unit_from: str = ""
    unknown_units: Mapping[str, str] = field(default_factory=dict)
    """Units that the file gives and that have no known name, by the column."""
    remarks: tuple[str, ...] = ()
    dropped: int = 0
    """Samples that the file itself marks as not those of people, or as not seen."""

    @property
    def lines_listed(self) -> Whole:
        """The lines as an array (N,)."""
        return listed(self.lines)


def listed(lines: Whole | range) -> Whole:
    """Lines as an array."""
    if isinstance(lines, range):
        return np.arange(lines.start, lines.stop, lines.step, dtype=np.int32)
    return lines


def number(path: Path, line: int, column: str, text: str) -> float:
    """The number in a column of a line.

    Raises
    ------
    RecordingError
        The text is not a number.
    """
    try:
        if "_" not in text and len(text) <= _MOST_DIGITS:
            return float(text)
    except ValueError:
        pass
    raise RecordingError(path, f"{column} is {text!r:.40}, expected a number", line) from None


def people(names: Sequence[str]) -> tuple[list[str], Whole]:
    """The different names in the order in which they come, and the index of each into them."""
    index: dict[str, int] = {}
    who = np.fromiter((index.setdefault(name, len(index)) for name in names), np.int64, len(names))
    return list(index), who


def numbered_people(numbers: Floats | Whole) -> tuple[list[str], Whole]:
    """The same of ids that are numbers; 1 and 1.0 are the same one.

    The indices take the place of ids that are int32.
    """
    close = _close_people(numbers)
    if close is not None:
        return close
    found, first, inverse = np.unique(numbers, return_index=True, return_inverse=True)
    order = np.argsort(first, kind="stable")
    rank = np.empty(len(order), np.int64)
    rank[order] = np.arange(len(order))
    firsts = found[order].astype(np.float64).tolist()
    names = [str(int(v)) if v.is_integer() else f"{v:.15g}" for v in firsts]
    return names, rank[inverse.reshape(-1)]


def _close_people(numbers: Floats | Whole) -> tuple[list[str], Whole] | None:
    """The same, without sorting, where ids are whole and not far apart."""
    if not len(numbers):
        return None
    low, high = float(numbers.min()), float(numbers.max())
    if not high - low <= min(4 * len(numbers), 2**31 - 1) or not abs(low) < EXACT_WHOLE:
        return None
    base = int(low)
    rank = np.full(int(high) - base + 1, -1, np.int32)
    kept = numbers.dtype == np.int32
    who: Whole = numbers.view(np.int32) if kept else np.empty(len(numbers), np.int32)
    names: list[str] = []
    for begin in range(0, len(numbers), _PIECE):
        away = numbers[begin : begin + _PIECE].astype(np.int64, copy=False) - base
        if numbers.dtype.kind == "f" and not np.array_equal(
            away, numbers[begin : begin + _PIECE] - base
        ):
            return None
        own = rank[away]
        if own.min() < 0:
            newcomers, first = np.unique(away[own < 0], return_index=True)
            newcomers = newcomers[np.argsort(first)]
            rank[newcomers] = np.arange(len(names), len(names) + len(newcomers))
            names += [str(mark + base) for mark in newcomers.tolist()]
            own = rank[away]
        who[begin : begin + _PIECE] = own
    return names, who

"""The numbers of a table's columns: all at once where they are plain, else cell by cell."""

import math
import re
from collections.abc import Callable, Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Final

import numpy as np

from esplanade.recordings.dialect import Dialect, Line
from esplanade.recordings.errors import RecordingError
from esplanade.recordings.rows import EXACT_WHOLE, Floats, Whole, number, numbered_people, people

_NOWHERE: Final = frozenset(("", "?", "na", "n/a", "nan", "null", "none", "-"))
"""Stand for a place that is not known; `?` for one to be predicted, in the tests of TrajNet."""
_OF_DAY: Final = re.compile(r"(?:(\d{1,2}):)?(\d{1,2}):(\d{1,2}(?:[.,]\d+)?)")
_DAY_S: Final = 86_400.0
_MILLISECONDS: Final = re.compile(r"(:\d\d):(\d{1,6})$")
_CLOCKS: Final = ("time", "frame")
_NO_NUMBERS: Final = ("id", "kind")


class Cells:
    """The columns of a table: numbers by role, and whose each line is."""

    def __init__(self, lines: Whole, numbers: Mapping[str, Floats], ids: list[str], who: Whole):
        self.lines, self.numbers, self.ids, self.who = lines, numbers, ids, who


def read_cells(
    path: Path,
    lines: Sequence[Line],
    dialect: Dialect,
    places: Mapping[str, int],
    width: int,
    names: str = "",
    keep: Callable[[str], bool] | None = None,
) -> tuple[Cells, int]:
    """Read the columns at `places` of lines with `width` cells, whose `names` errors tell.

    With `keep`, lines whose cell of the role "kind" it does not want are left out; the second
    result is their number.

    Raises
    ------
    RecordingError
        A line has another number of cells, or a cell holds no number.
    """
    if keep is None or "kind" not in places:
        found = _all_at_once(lines, dialect, places, width)
        if found is not None:
            return found, 0
    return _one_by_one(path, lines, dialect, places, width, names, keep)


def _all_at_once(
    lines: Sequence[Line], dialect: Dialect, places: Mapping[str, int], width: int
) -> Cells | None:
    """The columns, None where a cell is no plain number or a line has another number of cells."""
    texts = [line.text for line in lines]
    if dialect.decimal_comma or not texts:
        return None
    delimiter = dialect.delimiter
    if delimiter is None:
        if any(len(text.split()) != width for text in texts):
            return None
    elif any(text.count(delimiter) != width - 1 for text in texts):
        return None
    roles = [role for role in places if role != "kind"]
    try:
        block = np.loadtxt(
            texts,
            delimiter=delimiter,
            usecols=[places[role] for role in roles],
            comments=None,
            quotechar='"',
            ndmin=2,
        )
    except (ValueError, IndexError, OverflowError):
        return None
    numbers = {role: np.ascontiguousarray(block[:, i]) for i, role in enumerate(roles)}
    marks = numbers.pop("id", np.ones(len(block)))
    if len(block) != len(texts) or not np.all(np.abs(marks) < EXACT_WHOLE):
        return None
    ids, who = numbered_people(marks)
    return Cells(_numbers(lines), numbers, ids, who)


def _one_by_one(
    path: Path,
    lines: Sequence[Line],
    dialect: Dialect,
    places: Mapping[str, int],
    width: int,
    header: str,
    keep: Callable[[str], bool] | None,
) -> tuple[Cells, int]:
    roles = [role for role in places if role not in _NO_NUMBERS]
    columns: dict[str, list[float]] = {role: [] for role in roles}
    names: list[str] = []
    kept: list[Line] = []
    dropped = 0
    split = dialect.cells
    for line in lines:
        cells = split(line.text)
        if len(cells) > width and not any(cells[width:]):
            cells = cells[:width]
        if len(cells) != width:
            raise RecordingError(
                path, f"expected {width} columns {header:.80}, not {len(cells)}", line.number
            )
        if keep is not None and "kind" in places and not keep(cells[places["kind"]]):
            dropped += 1
            continue
        nowhere = all(cells[places.get(c, 0)].lower() in _NOWHERE for c in "xy")
        name = cells[places["id"]] if "id" in places else "1"
        if not name:
            raise RecordingError(path, "expected a pedestrian's id, not an empty cell", line.number)
        for role in roles:
            cell = dialect.plain(cells[places[role]])
            if nowhere and role not in _CLOCKS:
                columns[role].append(math.nan)
            else:
                if dialect.is_doubtful(cells[places[role]]):
                    _refuse_doubtful(path, line.number, role, cell)
                columns[role].append(_value(path, line.number, role, cell))
        names.append(dialect.plain(name))
        kept.append(line)
    ids, who = _people(names)
    _over_midnight(columns.get("time"), lines, dialect, places)
    numbers = {role: np.array(column, np.float64) for role, column in columns.items()}
    return Cells(_numbers(kept), numbers, ids, who), dropped


def _refuse_doubtful(path: Path, line: int, role: str, cell: str) -> None:
    raise RecordingError(
        path,
        f"{role} is {cell!r:.40} in a table with decimal commas: are these thousands or decimals? "
        "Save it without marks for thousands",
        line,
    )


def _value(path: Path, line: int, role: str, cell: str) -> float:
    column = {"time": "t"}.get(role, role)
    if role == "time" and ":" in cell:
        moment = _moment(cell)
        if moment is not None:
            return moment
    return number(path, line, column, cell)


def _moment(cell: str) -> float | None:
    """Seconds of a date and time, or of a time of day; None where it is neither."""
    of_day = _OF_DAY.fullmatch(cell)
    if of_day is not None:
        hours, minutes, seconds = (
            float((part or "0").replace(",", ".")) for part in of_day.groups()
        )
        return 3600.0 * hours + 60.0 * minutes + seconds
    try:
        # Some write milliseconds behind a colon, and the date with slashes.
        plain = _MILLISECONDS.sub(r"\1.\2", cell).replace("/", "-").replace(",", ".")
        moment = datetime.fromisoformat(plain)
        zoned = moment if moment.tzinfo else moment.replace(tzinfo=UTC)
        return zoned.timestamp()
    except (ValueError, OverflowError):
        return None


def _over_midnight(
    times: list[float] | None, lines: Sequence[Line], dialect: Dialect, places: Mapping[str, int]
) -> None:
    """Let times of day go on after midnight."""
    if not times or not _OF_DAY.fullmatch(dialect.cells(lines[0].text)[places["time"]]):
        return
    days = 0.0
    before = times[0]
    for i, time in enumerate(times):
        days += _DAY_S if before - time > 0.5 * _DAY_S else 0.0
        days -= _DAY_S if time - before > 0.5 * _DAY_S else 0.0
        before = time
        times[i] = time + days


def _people(names: list[str]) -> tuple[list[str], Whole]:
    """The person of each line; where all names are numbers, 1 and 1.0 are the same person."""
    try:
        marks = np.array([float(name) for name in names])
    except ValueError:
        return people(names)
    if len(marks) and np.all(np.abs(marks) < EXACT_WHOLE):
        return numbered_people(marks)
    return people(names)


def _numbers(lines: Sequence[Line]) -> Whole:
    return np.fromiter((line.number for line in lines), np.int64, len(lines))

"""Tables of numbers without a header: TrajNet's four columns, Jülich's five, ETH's eight."""

from collections.abc import Mapping
from pathlib import Path
from typing import Final

import numpy as np

from esplanade.recordings.cells import Cells, read_cells
from esplanade.recordings.comments import said_in
from esplanade.recordings.dialect import Dialect, Table
from esplanade.recordings.errors import RecordingError
from esplanade.recordings.rows import Floats, Rows, Whole, numbered_people

OBSMAT: Final = ("frame", "id", "x", "z", "y", "vx", "vz", "vy")
_HEIGHTS: Final = {"m": (1.0, 2.3), "cm": (100.0, 230.0), "mm": (1000.0, 2300.0)}
"""Heights of heads, by which the unit of a table shows itself."""
_FEWEST: Final = 4


def read_bare(path: Path, table: Table, dialect: Dialect) -> Rows:
    """Read the samples of a table of numbers.

    Raises
    ------
    RecordingError
        The columns cannot be told, or a line does not fit.
    """
    first = table.lines[0]
    width = len(dialect.cells(first.text))
    if width < _FEWEST:
        raise RecordingError(
            path,
            f"expected at least {_FEWEST} columns (frame id x y, id frame x y z, ETH's eight, or a "
            f"header that names them), not {width}",
            first.number,
        )
    if width == len(OBSMAT):
        places = {name: place for place, name in enumerate(OBSMAT)}
        cells, _ = read_cells(path, table.lines, dialect, places, width, " ".join(OBSMAT))
        if _is_obsmat(path, cells):
            return _obsmat(path, table, cells)
    names = "id frame x y z" if width > _FEWEST else "frame id x y"
    places = {"frame": 0, "id": 1, "x": 2, "y": 3, **({"z": 4} if width > _FEWEST else {})}
    cells, _ = read_cells(path, table.lines, dialect, places, width, names)
    firsts, seconds = cells.numbers["frame"], _marks(path, cells)
    is_frame_first = _frame_first(firsts, seconds, cells.numbers, width)
    clock, marks = (firsts, seconds) if is_frame_first else (seconds, firsts)
    ids, who = _whole_people(path, cells.lines, marks)
    said = said_in(path, table.comments)
    unit, unit_from = said.unit, "as its header says"
    if unit is None and width > _FEWEST:
        unit, unit_from = _unit_of_heights(cells.numbers["z"]), "as the heights show"
    return Rows(
        format=f"table without a header, {'frame id' if is_frame_first else 'id frame'} x y",
        lines=cells.lines,
        ids=ids,
        who=who,
        clock=clock,
        x=cells.numbers["x"],
        y=cells.numbers["y"],
        counts_frames=bool(np.all(clock == np.round(clock))) if len(clock) else True,
        fps=said.fps,
        samples_per_s=said.samples_per_s,
        usual_from="as its header says",
        unit=unit,
        unit_from=unit_from if unit else "",
    )


def _is_obsmat(path: Path, cells: Cells) -> bool:
    """Whether eight columns begin with frame and person, not with person and frame as Jülich's."""
    numbers = cells.numbers
    frames, marks, x = numbers["frame"], _marks(path, cells), numbers["x"]
    with np.errstate(invalid="ignore"):
        y = numbers["z"] if np.ptp(numbers["y"]) == 0.0 else numbers["y"]
        usual = _jump(marks, frames, {"x": x, "y": y})
        return usual <= _jump(frames, marks, {"x": x, "y": numbers["z"]})


def _obsmat(path: Path, table: Table, cells: Cells) -> Rows:
    """ETH's eight columns; some write y before z, as one sees where nobody moves along the last."""
    numbers = cells.numbers
    marks = _marks(path, cells)
    ids, who = _whole_people(path, cells.lines, marks)
    said = said_in(path, table.comments)
    y, vy, remarks = numbers["y"], numbers["vy"], list[str]()
    with np.errstate(invalid="ignore"):
        swapped = np.ptp(y) == 0.0 and np.ptp(numbers["z"]) > 0.0
    if swapped:
        y, vy = numbers["z"], numbers["vz"]
        remarks.append("its fifth column is the same everywhere: the fourth is read as y")
    return Rows(
        format="ETH obsmat",
        lines=cells.lines,
        ids=ids,
        who=who,
        clock=numbers["frame"],
        x=numbers["x"],
        y=y,
        counts_frames=True,
        velocities=np.stack([numbers["vx"], vy], axis=1),
        fps=said.fps,
        samples_per_s=said.samples_per_s,
        usual_from="as its header says",
        unit=said.unit,
        unit_from="as its header says" if said.unit else "",
        remarks=tuple(remarks),
    )


def _marks(path: Path, cells: Cells) -> Floats:
    try:
        names = np.array([float(name) for name in cells.ids])
    except ValueError:
        wrong = next(i for i, name in enumerate(cells.ids) if not _is_float(name))
        line = int(cells.lines[np.argmax(cells.who == wrong)])
        raise RecordingError(
            path, f"id is {cells.ids[wrong]!r:.40}, expected a number", line
        ) from None
    return names[cells.who] if len(names) else names


def _is_float(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _whole_people(path: Path, lines: Whole, marks: Floats) -> tuple[list[str], Whole]:
    with np.errstate(invalid="ignore"):
        wrong = np.flatnonzero(~(np.isfinite(marks) & (marks == np.round(marks))))
    if len(wrong):
        text = f"id is {marks[wrong[0]]:g}, expected a whole number"
        raise RecordingError(path, text, int(lines[wrong[0]]))
    return numbered_people(marks)


def _frame_first(first: Floats, second: Floats, numbers: Mapping[str, Floats], width: int) -> bool:
    """Whether the first column counts frames and the second people, rather than the other way.

    People do not jump: of the two readings that one is right in which each person's samples are
    near each other.
    """
    if np.any(second != np.round(second)):
        return False
    if np.any(first != np.round(first)):
        return True
    jumps = [_jump(who, when, numbers) for who, when in ((second, first), (first, second))]
    if jumps[0] == jumps[1] or not np.isfinite(jumps).any():
        return width == _FEWEST
    return bool(jumps[0] < jumps[1]) if np.isfinite(jumps).all() else bool(np.isfinite(jumps[0]))


def _jump(who: Floats, when: Floats, numbers: Mapping[str, Floats]) -> float:
    """The mean distance of neighbouring samples if these columns say whose and when."""
    order = np.lexsort((when, who))
    same = (np.diff(who[order]) == 0) & (np.diff(when[order]) > 0)
    away = np.hypot(np.diff(numbers["x"][order]), np.diff(numbers["y"][order]))
    same &= np.isfinite(away)
    if not same.any():
        return float("inf")
    return float(np.mean(away[same]))


def _unit_of_heights(heights: Floats) -> str | None:
    middle = float(np.median(heights)) if len(heights) else 0.0
    return next((unit for unit, (low, high) in _HEIGHTS.items() if low <= middle <= high), None)

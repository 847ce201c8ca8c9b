"""Tables with named columns, in any dialect: comma, semicolon, tab or space between the cells."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

import numpy as np

from esplanade.recordings.cells import Cells, read_cells
from esplanade.recordings.columns import Columns, find_columns, named_by_hand
from esplanade.recordings.comments import said_in, together
from esplanade.recordings.dialect import Dialect, Line, Table, dialect_of
from esplanade.recordings.errors import RecordingError
from esplanade.recordings.kinds import is_person, others_among, told_others
from esplanade.recordings.rows import Floats, Rows
from esplanade.recordings.units import FRAMES, length_named, time_named

_MOST_LINES_BEFORE: Final = 60
_CITR: Final = ["frame", "id", "x", "y", "type"]


def is_whole_header(dialect: Dialect, line: Line) -> bool:
    """Whether the line names all columns that are needed, but perhaps that of people."""
    return find_columns(header_of(dialect, line)).missing in ([], ["id"])


def header_of(dialect: Dialect, line: Line) -> list[str]:
    """The cells of a header, which may be divided by something else than the lines below it."""
    text = together(line.text) if dialect.delimiter is None else line.text
    usual = dialect.cells(text)
    if find_columns(usual).missing:
        for delimiter in (",", ";", "\t", None):
            found = Dialect(delimiter, dialect.decimal_comma).cells(together(line.text))
            if not find_columns(found).missing:
                return found
    return usual


def read_named(path: Path, table: Table, dialect: Dialect, named: Sequence[str]) -> Rows:
    """Read the samples of a table whose columns are named by hand, whatever its own header says.

    Raises
    ------
    RecordingError
        Names are missing or too many, or a line does not fit.
    """
    first = dialect.cells(table.lines[0].text)
    has_header = not any(dialect.is_number(cell) for cell in first)
    try:
        header = named_by_hand(first, named)
    except ValueError as error:
        raise RecordingError(path, f"--columns: {error}", table.lines[0].number) from None
    columns = find_columns(header)
    if columns.missing:
        told = " and ".join(columns.missing)
        raise RecordingError(path, f"--columns names no column for {told}")
    kept = table._replace(lines=table.lines[1:] if has_header else table.lines)
    if not kept.lines:
        raise RecordingError(path, "holds no samples, expected at least one")
    width = len(dialect.cells(kept.lines[0].text))
    if len(header) > width:
        text = f"expected {len(header)} columns, as --columns names, not {width}"
        raise RecordingError(path, text, kept.lines[0].number)
    return read_table(path, kept, dialect, header)


def names_columns(dialect: Dialect, line: Line) -> bool:
    """Whether the line is a header rather than a sample."""
    cells = header_of(dialect, line)
    numbers = sum(dialect.is_number(cell) for cell in cells)
    return numbers == 0 or len(find_columns(cells).places) >= 3


def from_header(table: Table) -> Table:
    """The table from the line that names its columns, if others stand before it.

    Those lines count as comments, since some programs write of the experiment there.
    """
    for place, line in enumerate(table.lines[1:_MOST_LINES_BEFORE], start=1):
        below = table._replace(lines=table.lines[place:])
        dialect = dialect_of(below)
        if len(below.lines) < 2 or find_columns(cells := header_of(dialect, line)).missing:
            continue
        first = dialect.cells(below.lines[1].text)
        if len(first) >= len(cells) and any(dialect.is_number(cell) for cell in first):
            return below._replace(comments=[*table.comments, *table.lines[:place]])
    return table


def read_table(path: Path, table: Table, dialect: Dialect, header: list[str] | None) -> Rows:
    """Read the samples; without `header` the first line names the columns.

    Raises
    ------
    RecordingError
        A column that is needed is missing, or a line does not fit.
    """
    lines, repeats = table.lines, 0
    if header is not None:
        columns, width = find_columns(header), len(dialect.cells(lines[0].text))
    else:
        head = lines[0]
        lines = [line for line in lines if line.text != head.text]
        repeats = len(table.lines) - len(lines) - 1
        header = header_of(dialect, head)
        columns, width = _columns(path, header, head), len(header)
        first = dialect.cells(lines[0].text) if lines else []
        if dialect.delimiter in (None, "\t") and len(first) == width + 1 and first[-1]:
            # A table whose rows have names has no name for the column of these.
            columns = Columns({r: p + 1 for r, p in columns.places.items()}, columns.units)
            header, width = ["", *header], width + 1
        elif len(first) == width and _names_units(dialect, first, columns):
            units = {r: first[p] or columns.units[r] for r, p in columns.places.items()}
            columns, lines = Columns(columns.places, units), lines[1:]
    said = said_in(path, table.comments)
    unit = _length(path, columns, table) or said.unit
    kinds = _kinds(dialect, lines, columns)
    cells, dropped = read_cells(
        path, lines, dialect, columns.places, width, ",".join(header), is_person if kinds else None
    )
    if "id" not in columns.places:
        _check_one_person(path, columns, cells, header, table)
        cells.ids = [path.stem]
    remarks = []
    if dropped:
        remarks.append(told_others(kinds))
    if repeats:
        remarks.append(f"{repeats} repeated headers are left out")
    in_frames, unit_s = _clock(columns)
    numbers = cells.numbers
    is_citr = [cell.strip().lower() for cell in header] == _CITR
    return Rows(
        format="table with named columns",
        lines=cells.lines,
        ids=cells.ids,
        who=cells.who,
        clock=numbers["frame"] if in_frames and "frame" in numbers else numbers["time"] * unit_s,
        x=numbers["x"],
        y=numbers["y"],
        counts_frames=in_frames,
        velocities=_velocities(numbers),
        fps=said.fps,
        samples_per_s=said.samples_per_s,
        usual_fps=30000 / 1001 if is_citr else None,
        usual_from="as CITR is recorded" if is_citr else "as its header says",
        unit=unit,
        unit_from="as its header says" if unit else "",
        z=numbers.get("z"),
        times_named=bool(columns.units.get("time")),
        unknown_units=columns.unknown_units,
        remarks=tuple(remarks),
        dropped=dropped,
    )


def _columns(path: Path, header: list[str], line: Line) -> Columns:
    columns = find_columns(header)
    if columns.missing and columns.missing != ["id"]:
        raise _lacking(path, header, line, columns)
    return columns


def _lacking(path: Path, header: list[str], line: Line, columns: Columns) -> RecordingError:
    names = ", ".join(cell or "''" for cell in header)
    return RecordingError(
        path,
        f"expected the header t,id,x,y or other names of these columns; none of {names!r:.100} "
        f"is {' or '.join(columns.missing)}; --columns names them",
        line.number,
    )


def _check_one_person(
    path: Path, columns: Columns, cells: Cells, header: list[str], table: Table
) -> None:
    """Check that a table without ids can be the track of one person."""
    clock = cells.numbers["time" if "time" in columns.places else "frame"]
    if not np.all(np.diff(clock) > 0.0):
        raise _lacking(path, header, table.lines[0], columns)


def _names_units(dialect: Dialect, cells: Sequence[str], columns: Columns) -> bool:
    """Whether a line gives the units of the columns: no numbers, and a unit among them."""
    found = [cells[p].strip("[]() ") for r, p in columns.places.items() if p < len(cells)]
    if any(dialect.is_number(cell) for cell in found):
        return False
    return any(length_named(c) is not None or time_named(c) is not None for c in found)


def _length(path: Path, columns: Columns, table: Table) -> str | None:
    x, y = (length_named(columns.units[role].strip("[]() ")) for role in "xy")
    if x != y and x is not None and y is not None:
        line = table.lines[0].number if table.lines else None
        raise RecordingError(path, f"x is in {x} and y in {y}, expected one unit", line)
    return x or y


def _clock(columns: Columns) -> tuple[bool, float]:
    """Whether frames are counted, and the seconds in the unit of the times."""
    if "time" not in columns.places:
        return True, 1.0
    unit_s = time_named(columns.units["time"].strip("[]() "))
    if unit_s == FRAMES:
        return True, 1.0
    return False, 1.0 if unit_s is None else unit_s


def _velocities(numbers: Mapping[str, Floats]) -> Floats | None:
    if "vx" not in numbers or "vy" not in numbers:
        return None
    return np.stack([numbers["vx"], numbers["vy"]], axis=1)


def _kinds(dialect: Dialect, lines: Sequence[Line], columns: Columns) -> dict[str, int]:
    """The kinds that are no people, with their counts, where a column tells kinds."""
    place = columns.places.get("kind")
    if place is None:
        return {}
    split = dialect.cells
    return others_among(cells[place] for line in lines if len(cells := split(line.text)) > place)

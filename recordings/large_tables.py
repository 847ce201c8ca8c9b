"""Large tables of plain numbers, read in pieces by pyarrow where that is installed.

Only what is sure to mean the same is read so: a header in the first line, one delimiter, no decimal
comma, people with whole numbers. All else is read line by line, as far as that is bounded.
"""

import re
from collections.abc import Collection, Mapping
from importlib import import_module
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np

from esplanade.recordings.columns import Columns, find_columns
from esplanade.recordings.dialect import COMMENTS, dialect_of, table_of
from esplanade.recordings.errors import MAX_FILE_BYTES, RecordingError
from esplanade.recordings.rows import Rows, numbered_people
from esplanade.recordings.units import FRAMES, length_named, time_named

LARGE_BYTES: Final = 32 * 2**20
MOST_BYTES: Final = 8 * 2**30
_HEAD_BYTES: Final = 2**16
_BLOCK_BYTES: Final = 2**18
_COLUMN: Final = re.compile(r"column #(\d+)")
"""The words in which pyarrow names the column of a cell that is not as the others are."""
_NOWHERE: Final = ["", "?", "NA", "N/A", "NaN", "nan", "null", "None", "none", "-"]
_NEEDED: Final = ("time", "frame", "id")
_PLAIN: Final = frozenset(("time", "frame", "id", "x", "y", "z"))


class _Head(NamedTuple):
    """The layout of a large table, as its first lines say it."""

    delimiter: str
    header: list[str]
    columns: Columns


def _head_of(path: Path) -> _Head | None:
    """The header of a large table that is plain; None where it is not sure to be one."""
    try:
        if not path.is_file() or not LARGE_BYTES <= path.stat().st_size <= MOST_BYTES:
            return None
        with path.open("rb") as file:
            head = file.read(_HEAD_BYTES)
        text = head.removeprefix(b"\xef\xbb\xbf").decode("ascii").rpartition("\n")[0]
    except (OSError, UnicodeDecodeError):
        return None
    table = table_of(text.replace("\r\n", "\n"))
    if "\r" in text.replace("\r\n", "") or table.comments or len(table.lines) < 2:
        return None
    dialect = dialect_of(table)
    if dialect.delimiter is None or dialect.decimal_comma or table.lines[0].number != 1:
        return None
    header, first = (dialect.cells(line.text) for line in table.lines[:2])
    columns = find_columns(header)
    fits = (
        not columns.missing
        and set(columns.places) <= _PLAIN
        and len(first) == len(header)
        and all(dialect.is_number(first[place]) for place in columns.places.values())
    )
    return _Head(dialect.delimiter, header, columns) if fits else None


def read_large(path: Path) -> Rows | None:
    """Read a large table; None where it is not one, or pyarrow is not installed.

    Raises
    ------
    RecordingError
        A cell holds no number, or a line has another number of cells.
    """
    head = _head_of(path)
    if head is None:
        return None
    columns = head.columns
    try:
        reader = import_module("pyarrow.csv")
    except ImportError:
        return None
    units = {role: unit for role, unit in columns.units.items() if unit}
    blocks = _blocks(path, reader, head.delimiter, head.header, columns.places, ("id",))
    if blocks is None:
        return None
    ids, who = numbered_people(blocks.pop("id"))
    unit_s = time_named(units.get("time", ""))
    in_frames = "time" not in blocks or unit_s == FRAMES
    clock = blocks.get("time", blocks.get("frame", blocks["x"]))
    if in_frames and "frame" in blocks:
        clock = blocks["frame"]
    elif unit_s is not None and not in_frames:
        clock = clock * unit_s
    unit = length_named(units.get("x", ""))
    return Rows(
        format="table with named columns",
        lines=range(2, len(who) + 2),
        ids=ids,
        who=who,
        clock=clock,
        x=blocks["x"],
        y=blocks["y"],
        counts_frames=in_frames,
        z=blocks.get("z"),
        times_named=bool(units.get("time")),
        unit=unit,
        unit_from="as its header says" if unit else "",
        unknown_units=columns.unknown_units,
    )


def _blocks(
    path: Path,
    reader: Any,
    delimiter: str,
    header: list[str],
    places: dict[str, int],
    whole: Collection[str],
) -> dict[str, Any] | None:
    """The columns by role; None where they are not plain, and small enough for the other way.

    Those that are `whole` are read as whole numbers, and once more as others where they are not.
    """
    pa: Any = import_module("pyarrow")
    names = [f"c{i}" for i in range(len(header))]
    used = {role: names[place] for role, place in places.items()}
    kinds = {role: pa.int32() if role in whole else pa.float64() for role in used}
    options = {
        "read_options": reader.ReadOptions(
            use_threads=False, block_size=_BLOCK_BYTES, column_names=names, skip_rows=1
        ),
        "parse_options": reader.ParseOptions(delimiter=delimiter),
        "convert_options": reader.ConvertOptions(
            include_columns=list(used.values()),
            column_types={name: kinds[role] for role, name in used.items()},
            null_values=_NOWHERE,
        ),
    }
    room = _rows_at_most(path)
    found = _columns(used, kinds, room)
    count = 0
    try:
        for batch in reader.open_csv(str(path), **options):
            if any(batch.column(used[role]).null_count for role in used if role in _NEEDED):
                raise pa.ArrowInvalid("a cell is empty")
            end = count + batch.num_rows
            if end > room:
                # Lines further on are shorter than those that were looked at.
                room = end + room // 4
                grown = _columns(used, kinds, room)
                for role, column in found.items():
                    grown[role][:count] = column[:count]
                found = grown
            for role, name in used.items():
                found[role][count:end] = _values(batch.column(name), found[role].dtype)
            count = end
    except (pa.ArrowException, OSError) as error:
        column = _COLUMN.search(f"{error}")
        if whole and (column is None or int(column[1]) == places["id"]):
            return _blocks(path, reader, delimiter, header, places, ())
        fault = _first_fault(path, count + 1, delimiter, header, places)
        if fault is None and path.stat().st_size <= MAX_FILE_BYTES:
            return None
        raise RecordingError(path, *(fault or (f"{error}"[:300], None))) from None
    return {role: column[:count] for role, column in found.items()}


def _values(column: Any, dtype: Any) -> Any:
    """The values of a column, NaN where there is none; pyarrow's own way loads pandas first."""
    if column.null_count:
        column = column.fill_null(float("nan"))
    return np.frombuffer(column.buffers()[1], dtype, len(column), column.offset * dtype.itemsize)


def _columns(used: Collection[str], kinds: Mapping[str, Any], room: int) -> dict[str, Any]:
    """Columns of so many rows; x and y are those of one array, as places are kept."""
    places = np.empty((room, 2))
    made: dict[str, Any] = {"x": places[:, 0], "y": places[:, 1]}
    others = (role for role in used if role not in made)
    return made | {role: np.empty(room, kinds[role].to_pandas_dtype()) for role in others}


def _rows_at_most(path: Path) -> int:
    """About as many lines as the file has, judged by lines at its beginning and at its end."""
    size = path.stat().st_size
    with path.open("rb") as file:
        lines = file.read(_HEAD_BYTES).count(b"\n")
        file.seek(max(0, size - _HEAD_BYTES))
        lines = max(lines, file.read(_HEAD_BYTES).count(b"\n"))
    return int(1.03 * (lines + 1) * max(1.0, size / _HEAD_BYTES)) + 16


def _first_fault(
    path: Path, read: int, delimiter: str, header: list[str], places: dict[str, int]
) -> tuple[str, int] | None:
    """The first fault with its line, looked for from the line after those that were read.

    None where the other way of reading forgives it: comments, headers once more, times of day.
    """
    count = len(header)
    with path.open(encoding="utf-8", errors="replace") as file:
        for number, text in enumerate(file, start=1):
            if number <= read or not text.strip():
                continue
            cells = text.rstrip("\r\n").split(delimiter)
            if text.lstrip().startswith(COMMENTS) or cells == header:
                return None
            if len(cells) != count:
                return f"expected {count} columns {','.join(header)}, not {len(cells)}", number
            for place in places.values():
                cell = cells[place].strip().strip('"')
                try:
                    float(cell)
                except ValueError:
                    if not cell or ":" in cell or '"' in text:
                        return None
                    return f"{header[place]} is {cell!r:.40}, expected a number", number
    return None

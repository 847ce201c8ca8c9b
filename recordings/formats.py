"""The format of a file, by what is in it: the suffix of its name says nothing."""

from dataclasses import replace
from pathlib import Path
from typing import Final

from esplanade.files.content import ContentError
from esplanade.files.text import check_lines
from esplanade.recordings.annotations import looks_annotated, read_annotated
from esplanade.recordings.bare_format import read_bare
from esplanade.recordings.columnar_format import HDF5, PARQUET, read_hdf5, read_parquet
from esplanade.recordings.comments import header_in
from esplanade.recordings.dialect import Table, dialect_of, table_of
from esplanade.recordings.errors import RecordingError, read_bytes, text_of
from esplanade.recordings.folders import read_folder
from esplanade.recordings.json_format import read_json
from esplanade.recordings.large_tables import read_large
from esplanade.recordings.old_formats import (
    looks_like_lists,
    looks_like_triples,
    read_lists,
    read_triples,
)
from esplanade.recordings.rows import AS_IT_SAYS, Given, Rows
from esplanade.recordings.spline_format import looks_like_splines, read_splines
from esplanade.recordings.sqlite_format import MAGIC, read_sqlite
from esplanade.recordings.table_format import (
    from_header,
    is_whole_header,
    names_columns,
    read_named,
    read_table,
)
from esplanade.recordings.xml_format import read_xml

READABLE: Final = (
    "a table with columns t or frame, id, x and y; PeTrack and Jülich text; ETH's obsmat; "
    "TrajNet's four columns and ndjson; JSON of samples; UCY's splines; Stanford Drone, Town "
    "Centre, WildTrack, PETS, KITTI, TRAF, Grand Central and Edinburgh annotations; ATC; Vadere's "
    ".traj; JPScore's XML; JuPedSim's SQLite; Parquet; HDF5; gzip of each; a folder of them"
)
MAX_NUMBERS_BYTES: Final = 2**31
"""Files of numbers are smaller in memory than texts."""

MOST_LINES: Final = 4_000_000
LARGE_CHARACTERS: Final = 4 * 2**20
MOST_OF_A_LINE: Final = 65_536
_OTHERS: Final = {
    b"PK\x03\x04": "is a ZIP archive or a spreadsheet: unpack it, or save it as CSV",
    b"%PDF": "is a PDF file",
    b"\x89PNG": "is a picture",
    b"\xff\xd8\xff": "is a picture",
    b"BZh": "is packed by bzip2: unpack it, or pack it by gzip",
    b"\xfd7zXZ": "is packed by xz: unpack it, or pack it by gzip",
    b"\x28\xb5\x2f\xfd": "is packed by zstd: unpack it, or pack it by gzip",
    b"\x80\x04\x95": "is a pickle of Python, which is never opened: save it as CSV or Parquet",
    b"RIFF": "is a film or a sound",
}


def read_rows(path: Path, given: Given = AS_IT_SAYS) -> Rows:
    """Read the samples of a file of any known format, or of a folder of such files.

    Raises
    ------
    RecordingError
        It cannot be read, or holds something else.
    """
    if path.is_dir():
        return read_folder(path, lambda file: _read_file(file, given))
    return _read_file(path, given)


def _read_file(path: Path, given: Given) -> Rows:
    if not given.columns and (rows := read_large(path)) is not None:
        return rows
    content = read_bytes(path)
    if content.startswith(MAGIC):
        return read_sqlite(path, content)
    for magic, read in ((PARQUET, read_parquet), (HDF5, read_hdf5)):
        if content.startswith(magic):
            return read(path, content, given.columns)
    for magic, what in _OTHERS.items():
        if content.startswith(magic):
            raise RecordingError(path, f"{what}. What is read: {READABLE}")
    text, remark = text_of(path, content)
    rows = _read_text(path, text, given)
    return rows if not remark else _with_remark(rows, remark)


def _read_text(path: Path, text: str, given: Given) -> Rows:
    _check_bounds(path, text, given)
    start = text[:200].lstrip()
    if start.startswith(("{", "[")):
        return read_json(path, text, given.columns)
    if start.startswith("<"):
        return read_xml(path, text)
    if looks_like_splines(text):
        return read_splines(path, text)
    table = table_of(text)
    if not table.lines:
        what = "holds no samples, expected at least one" if text.strip() else "is empty, expected"
        raise RecordingError(path, f"{what} the header t,id,x,y and samples")
    if looks_like_triples(table):
        return read_triples(table)
    return read_lists(path, table) if looks_like_lists(table) else _read_cells(path, table, given)


def _check_bounds(path: Path, text: str, given: Given) -> None:
    """Refuse texts that would fill the memory, and large ones that begin as no table does."""
    try:
        check_lines(text, MOST_LINES)
    except ContentError as error:
        why = f"{error} where it is no plain CSV, or pyarrow is not installed"
        raise RecordingError(path, why) from None
    if len(text) <= LARGE_CHARACTERS or text[:200].lstrip().startswith(("{", "[", "<")):
        return
    if text.find("\n", 0, MOST_OF_A_LINE) < 0:
        raise RecordingError(path, f"has more than {MOST_OF_A_LINE} characters in a line", 1)
    beginning = text[: text.rindex("\n", 0, 4 * MOST_OF_A_LINE)]
    # Forms that count ahead cannot be cut.
    lines = table_of(beginning).lines
    if looks_like_splines(beginning) or all(line.text.isdecimal() for line in lines):
        return
    # Faults at the beginning of a large file are found before all of it is taken apart.
    _read_text(path, beginning, given)


def _read_cells(path: Path, table: Table, given: Given) -> Rows:
    long = next((line for line in table.lines if len(line.text) > MOST_OF_A_LINE), None)
    if long is not None:
        fault = f"has more than {MOST_OF_A_LINE} characters in a line"
        raise RecordingError(path, fault, long.number)
    dialect = dialect_of(table)
    if given.columns:
        return read_named(path, table, dialect, given.columns)
    if looks_annotated(dialect, table.lines[0]):
        return read_annotated(path, table, dialect)
    if names_columns(dialect, table.lines[0]):
        if not is_whole_header(dialect, table.lines[0]):
            below = from_header(table)
            table, dialect = below, dialect_of(below)
        return read_table(path, table, dialect, None)
    header = header_in(table.comments, len(dialect.cells(table.lines[0].text)))
    if header is not None:
        return read_table(path, table, dialect, header)
    if all(dialect.is_number(cell) for cell in dialect.cells(table.lines[0].text)[:3]):
        return read_bare(path, table, dialect)
    below = from_header(table)
    return read_table(path, below, dialect_of(below), None)


def _with_remark(rows: Rows, remark: str) -> Rows:
    return replace(rows, remarks=(*rows.remarks, remark))

"""The format of a file, by what is in it: the suffix of its name says nothing."""

from pathlib import Path
from typing import Final

from esplanade.recordings.bare_format import read_bare
from esplanade.recordings.columnar_format import HDF5, PARQUET, read_hdf5, read_parquet
from esplanade.recordings.dialect import Table, dialect_of, table_of
from esplanade.recordings.errors import RecordingError, read_bytes, text_of
from esplanade.recordings.large_tables import read_large
from esplanade.recordings.ndjson_format import read_ndjson
from esplanade.recordings.old_formats import (
    looks_like_lists,
    looks_like_triples,
    read_lists,
    read_triples,
)
from esplanade.recordings.rows import Rows
from esplanade.recordings.spline_format import looks_like_splines, read_splines
from esplanade.recordings.sqlite_format import MAGIC, read_sqlite
from esplanade.recordings.table_format import header_in, names_columns, read_table

READABLE: Final = (
    "a table with columns t or frame, id, x and y; PeTrack and Jülich text; ETH's obsmat; "
    "TrajNet's four columns and ndjson; UCY's splines; Stanford Drone, Grand Central and Edinburgh "
    "annotations; Vadere's .traj; "
    "JuPedSim's SQLite; Parquet; HDF5; gzip of each"
)
MAX_NUMBERS_BYTES: Final = 2**31
"""Files of numbers are smaller in memory than texts."""

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


def read_rows(path: Path) -> Rows:
    """Read the samples of a file of any known format.

    Raises
    ------
    RecordingError
        It cannot be read, or holds something else.
    """
    if (rows := read_large(path)) is not None:
        return rows
    content = read_bytes(path)
    for magic, read in ((MAGIC, read_sqlite), (PARQUET, read_parquet), (HDF5, read_hdf5)):
        if content.startswith(magic):
            return read(path, content)
    for magic, what in _OTHERS.items():
        if content.startswith(magic):
            raise RecordingError(path, f"{what}. What is read: {READABLE}")
    text, remark = text_of(path, content)
    rows = _read_text(path, text)
    return rows if not remark else _with_remark(rows, remark)


def _read_text(path: Path, text: str) -> Rows:
    start = text[:200].lstrip()
    if start.startswith(("{", "[")):
        return read_ndjson(path, text)
    if start.startswith("<"):
        raise RecordingError(path, f"is XML or HTML. What is read: {READABLE}")
    if looks_like_splines(text):
        return read_splines(path, text)
    table = table_of(text)
    if not table.lines:
        what = "holds no samples, expected at least one" if text.strip() else "is empty, expected"
        raise RecordingError(path, f"{what} the header t,id,x,y and samples")
    if looks_like_triples(table):
        return read_triples(table)
    return read_lists(path, table) if looks_like_lists(table) else _read_cells(path, table)


def _read_cells(path: Path, table: Table) -> Rows:
    dialect = dialect_of(table)
    if names_columns(dialect, table.lines[0]):
        return read_table(path, table, dialect, None)
    header = header_in(table.comments, len(dialect.cells(table.lines[0].text)))
    if header is not None:
        return read_table(path, table, dialect, header)
    if all(dialect.is_number(cell) for cell in dialect.cells(table.lines[0].text)[:3]):
        return read_bare(path, table, dialect)
    return read_table(path, table, dialect, None)


def _with_remark(rows: Rows, remark: str) -> Rows:
    from dataclasses import replace  # noqa: PLC0415

    return replace(rows, remarks=(*rows.remarks, remark))

"""Files that samples are written into as they come: CSV, Jülich text, JuPedSim's SQLite, Parquet.

What was added is on its way to the disk when `flush` returns; a process that is killed afterwards
leaves a file that can be read, but for Parquet, which has its table of contents at its end.
"""

import json
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from importlib import import_module
from pathlib import Path
from typing import Any, Final, Protocol

import numpy as np

from esplanade.recordings.jupedsim_tables import (
    INSERT_FRAME,
    INSERT_NOTE,
    INSERT_SAMPLE,
    new_tables,
)
from esplanade.recordings.samples import UNITS, Head, Note, Samples
from esplanade.recordings.writing import WritingError, told

_ROWS_AT_ONCE: Final = 256
"""Rows that are put into text without letting another thread run."""
_GROUP: Final = 65_536
"""Rows of a piece of a Parquet file."""


class Stream(Protocol):
    """A file that is being written. All of these may raise `WritingError`."""

    def add(self, samples: Samples) -> None:
        """Write the samples of one frame, later than those before."""

    def note(self, note: Note) -> None:
        """Write what holds from a frame on, before the samples of that frame."""

    def flush(self) -> None:
        """Hand over to the system what was added."""

    def close(self) -> None:
        """Complete the file."""


def open_stream(path: Path, head: Head) -> Stream:
    """A new file in the format that its name ends in, in place of one that is there.

    Raises
    ------
    WritingError
        The format is unknown, its library is not installed, or the file cannot be written.
    """
    kind = _STREAMS.get(path.suffix.lower())
    if kind is None:
        raise WritingError(f"{path.name} ends in none of {', '.join(_STREAMS)}")
    with _faults_of(path):
        made: Stream = kind(path, head)
    return made


@contextmanager
def _faults_of(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise WritingError(f"{path} cannot be written: {error.strerror or error}") from None
    except sqlite3.Error as error:
        raise WritingError(f"{path} cannot be written: {error}") from None


class _Text:
    """Lines of text; notes are comments among them."""

    _line = ""
    _columns: tuple[str, ...] = ()

    def __init__(self, path: Path, head: Head) -> None:
        self._path = path
        self._file = path.open("w", encoding="utf-8", newline="\n")
        self._file.writelines(f"{line}\n" for line in (*told(head.provenance), *self._head(head)))

    def _head(self, head: Head) -> Iterator[str]:
        raise NotImplementedError

    def _cells(self, samples: Samples) -> list[list[Any]]:
        return [samples[name].tolist() for name in self._columns]

    def add(self, samples: Samples) -> None:
        with _faults_of(self._path):
            for first in range(0, len(samples), _ROWS_AT_ONCE):
                rows = zip(*self._cells(samples[first : first + _ROWS_AT_ONCE]), strict=True)
                self._file.write("".join([self._line % row for row in rows]))

    def note(self, note: Note) -> None:
        with _faults_of(self._path):
            self._file.write(f"# frame {note.frame}, tick {note.tick}, {note.kind}: {note.text}\n")

    def flush(self) -> None:
        with _faults_of(self._path):
            self._file.flush()

    def close(self) -> None:
        with _faults_of(self._path):
            self._file.close()


class _Csv(_Text):
    _line = "%d,%.10g,%d,%s,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f\n"

    def _head(self, head: Head) -> Iterator[str]:
        yield f"# frames a second: {head.fps:.10g}"
        yield f"# units: {', '.join(f'{name} [{unit}]' for name, unit in UNITS.items())}"
        yield ",".join(UNITS)

    def _cells(self, samples: Samples) -> list[list[Any]]:
        kinds = ["actor" if actor else "person" for actor in samples["actor"].tolist()]
        return [kinds if name == "kind" else samples[name].tolist() for name in UNITS]


class _Plain(_Text):
    """The text of PeTrack and the Jülich archive."""

    _line = "%d %d %.4f %.4f %.4f\n"
    _columns = ("id", "frame", "x", "y", "z")

    def _head(self, head: Head) -> Iterator[str]:
        yield f"# framerate: {head.fps:.10g} fps"
        yield "# id frame x/m y/m z/m"


class _Sqlite:
    """JuPedSim's tables; everything since the last `flush` is one transaction."""

    def __init__(self, path: Path, head: Head) -> None:
        self._path = path
        self._connection = new_tables(path, head.fps, head.bounds, head.area, head.provenance)

    def add(self, samples: Samples) -> None:
        columns = [samples[name].tolist() for name in ("frame", "id", "x", "y")]
        columns += [np.cos(samples["heading"]).tolist(), np.sin(samples["heading"]).tolist()]
        with _faults_of(self._path):
            self._connection.executemany(INSERT_SAMPLE, zip(*columns, strict=True))
            frames = dict.fromkeys(columns[0])
            self._connection.executemany(INSERT_FRAME, ((frame,) for frame in frames))

    def note(self, note: Note) -> None:
        with _faults_of(self._path):
            self._connection.execute(INSERT_NOTE, note)

    def flush(self) -> None:
        with _faults_of(self._path):
            self._connection.commit()

    def close(self) -> None:
        with _faults_of(self._path):
            try:
                self._connection.commit()
            finally:
                self._connection.close()


class _Parquet:
    """Columns; notes stand in the metadata of the file, which is complete once it is closed.

    What it comes from is in the metadata of its schema.
    """

    def __init__(self, path: Path, head: Head) -> None:
        try:
            self._arrow, parquet = import_module("pyarrow"), import_module("pyarrow.parquet")
        except ImportError:
            raise WritingError(
                "Parquet needs pyarrow: install it, or everything of `esplanade[recordings]`"
            ) from None
        self._path = path
        self._waiting: list[Samples] = []
        self._notes: list[Note] = []
        self._rows = 0
        number, whole = self._arrow.float64(), self._arrow.int64()
        kinds = {"frame": whole, "id": whole, "kind": self._arrow.string()}
        self._schema = self._arrow.schema(
            [(name, kinds.get(name, number)) for name in UNITS],
            metadata={
                "esplanade": json.dumps(head.provenance),
                "fps": f"{head.fps:.10g}",
                "units": json.dumps(UNITS),
            },
        )
        self._writer = parquet.ParquetWriter(path, self._schema)

    def add(self, samples: Samples) -> None:
        self._waiting.append(samples)
        self._rows += len(samples)
        if self._rows >= _GROUP:
            self._write()

    def note(self, note: Note) -> None:
        self._notes.append(note)

    def flush(self) -> None:
        """Small pieces would make a file slow to read: rows wait until there are many."""

    def close(self) -> None:
        with _faults_of(self._path):
            if self._rows:
                self._write()
            notes = json.dumps([note._asdict() for note in self._notes])
            self._writer.add_key_value_metadata({"notes": notes})
            self._writer.close()

    def _write(self) -> None:
        block = np.concatenate(self._waiting)
        self._waiting, self._rows = [], 0
        columns = {
            name: np.where(block["actor"], "actor", "person") if name == "kind" else block[name]
            for name in UNITS
        }
        with _faults_of(self._path):
            self._writer.write_table(self._arrow.table(columns, schema=self._schema))


_STREAMS: Final[dict[str, Any]] = {
    ".csv": _Csv,
    ".txt": _Plain,
    ".sqlite": _Sqlite,
    ".parquet": _Parquet,
}
SUFFIXES: Final = tuple(_STREAMS)

"""JuPedSim's trajectories: an SQLite file with a table of samples and the frames a second."""

import sqlite3
import time
from pathlib import Path
from typing import Final

import numpy as np

from esplanade.recordings.errors import RecordingError
from esplanade.recordings.rows import Rows, numbered_people

MAGIC: Final = b"SQLite format 3\0"
MOST_SAMPLES: Final = 40_000_000
_LEAST_PATIENCE_S: Final = 1.0
_SLOWEST_BYTES_A_SECOND: Final = 2e6
_LIMITS: Final = {
    sqlite3.SQLITE_LIMIT_LENGTH: 4_000_000,
    sqlite3.SQLITE_LIMIT_SQL_LENGTH: 100_000,
    sqlite3.SQLITE_LIMIT_EXPR_DEPTH: 100,
    sqlite3.SQLITE_LIMIT_COLUMN: 200,
}
_PIECE: Final = 50_000
_ALONE_STEPS: Final = 100_000
_WANTED: Final = ("frame", "id", "pos_x", "pos_y")


def read_sqlite(path: Path, content: bytes) -> Rows:
    """Read the samples of a file of JuPedSim.

    Raises
    ------
    RecordingError
        It is damaged, or holds no table of trajectories.
    """
    connection = sqlite3.connect(":memory:")
    try:
        connection.deserialize(content)
        for limit, most in _LIMITS.items():
            connection.setlimit(limit, most)
        connection.execute("PRAGMA query_only = 1")
        connection.execute("PRAGMA trusted_schema = 0")
        connection.execute("PRAGMA cell_size_check = 1")
        until = time.monotonic() + _LEAST_PATIENCE_S + len(content) / _SLOWEST_BYTES_A_SECOND
        connection.set_progress_handler(lambda: time.monotonic() > until, _ALONE_STEPS)
        return _read(path, connection)
    except (sqlite3.Error, OverflowError, UnicodeDecodeError) as error:
        raise RecordingError(path, f"is an SQLite file that cannot be read: {error}") from None
    finally:
        connection.close()


def _read(path: Path, connection: sqlite3.Connection) -> Rows:
    kinds = dict(connection.execute("SELECT name, type FROM sqlite_master LIMIT 1000"))
    if kinds.get("trajectory_data") != "table":
        found = ", ".join(sorted(str(name) for name, kind in kinds.items() if kind == "table"))
        raise RecordingError(
            path,
            "is an SQLite file without the table trajectory_data that JuPedSim writes; "
            f"its tables: {found or 'none'}"[:300],
        )
    # Columns that are computed are not among these.
    has = {row[1] for row in connection.execute("PRAGMA table_info(trajectory_data)")}
    lacking = [name for name in _WANTED if name not in has]
    if lacking:
        raise RecordingError(path, f"its table trajectory_data has no column {', '.join(lacking)}")
    cursor = connection.execute(
        "SELECT frame, id, pos_x, pos_y FROM trajectory_data LIMIT ?", (MOST_SAMPLES + 1,)
    )
    parts = [np.empty((0, 4))]
    count = 0
    while piece := cursor.fetchmany(_PIECE):
        # What a damaged index counts says nothing, so that rows are counted as they come.
        for row, values in enumerate(piece, start=count + 1):
            if not all(isinstance(value, int | float) for value in values):
                fault = f"{values!s:.80} is no sample, expected numbers for frame, id, x and y"
                raise RecordingError(path, fault, row)
        parts.append(np.array(piece, np.float64))
        count += len(piece)
    if count > MOST_SAMPLES:
        raise RecordingError(path, f"has more than {MOST_SAMPLES} samples, the most that is read")
    block = np.concatenate(parts)
    ids, who = numbered_people(block[:, 1])
    return Rows(
        format="JuPedSim",
        lines=np.arange(1, count + 1),
        ids=ids,
        who=who,
        clock=block[:, 0],
        x=block[:, 2],
        y=block[:, 3],
        counts_frames=True,
        fps=_fps(path, connection) if "metadata" in kinds else None,
        unit="m",
        unit_from="as JuPedSim has it",
    )


def _fps(path: Path, connection: sqlite3.Connection) -> float | None:
    found = connection.execute("SELECT value FROM metadata WHERE key = 'fps'").fetchone()
    if found is None:
        return None
    try:
        fps = float(found[0])
    except (TypeError, ValueError):
        fps = 0.0
    if not 0.0 < fps < 1e6:
        raise RecordingError(path, f"fps is {found[0]!r:.40} in its metadata, expected more than 0")
    return fps

"""The tables of JuPedSim's trajectories, version 2, and what is laid beside them."""

import sqlite3
from collections.abc import Mapping
from pathlib import Path
from typing import Final

VERSION: Final = "2"
INSERT_SAMPLE: Final = "INSERT INTO trajectory_data VALUES (?, ?, ?, ?, ?, ?)"
INSERT_FRAME: Final = "INSERT INTO frame_data VALUES (?, 1)"
INSERT_NOTE: Final = "INSERT INTO esplanade_notes VALUES (?, ?, ?, ?)"
_TABLES: Final = (
    "CREATE TABLE trajectory_data (frame INTEGER NOT NULL, id INTEGER NOT NULL, "
    "pos_x REAL NOT NULL, pos_y REAL NOT NULL, ori_x REAL NOT NULL, ori_y REAL NOT NULL);"
    "CREATE TABLE metadata (key TEXT NOT NULL UNIQUE PRIMARY KEY, value TEXT NOT NULL);"
    "CREATE TABLE geometry (hash INTEGER NOT NULL, wkt TEXT NOT NULL);"
    "CREATE UNIQUE INDEX geometry_hash ON geometry(hash);"
    "CREATE TABLE frame_data (frame INTEGER NOT NULL, geometry_hash INTEGER NOT NULL);"
    "CREATE INDEX frame_id_idx ON trajectory_data(frame, id);"
    "CREATE TABLE esplanade_notes (frame INTEGER NOT NULL, tick INTEGER NOT NULL, "
    "kind TEXT NOT NULL, text TEXT NOT NULL);"
)


def box(bounds: tuple[float, float, float, float]) -> str:
    """A rectangle as WKT."""
    x0, y0, x1, y1 = bounds
    return f"POLYGON (({x0} {y0}, {x1} {y0}, {x1} {y1}, {x0} {y1}, {x0} {y0}))"


def new_tables(
    path: Path,
    fps: float,
    bounds: tuple[float, float, float, float],
    area: str,
    provenance: Mapping[str, str],
) -> sqlite3.Connection:
    """A new file with empty tables of samples, in place of one that is there.

    Raises
    ------
    sqlite3.Error, OSError
        It cannot be written.
    """
    path.unlink(missing_ok=True)
    x0, y0, x1, y1 = map(str, bounds)
    known = {"version": VERSION, "fps": f"{fps:.10g}", "xmin": x0, "xmax": x1, "ymin": y0}
    known |= {"ymax": y1} | {f"esplanade.{name}": text for name, text in provenance.items()}
    connection = sqlite3.connect(path)
    try:
        # A process may be killed at any time, and what was committed stays; a loss of power may
        # spoil the file, as it does with all that is written here.
        connection.execute("PRAGMA synchronous = OFF")
        with connection:
            connection.executescript(_TABLES)
            connection.executemany("INSERT INTO metadata VALUES (?, ?)", known.items())
            connection.execute("INSERT INTO geometry VALUES (1, ?)", (area,))
    except sqlite3.Error:
        connection.close()
        raise
    return connection

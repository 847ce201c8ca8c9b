"""The files of a store in SQLite: the journal beside the file, and taking all of them away."""

from pathlib import Path

from sqlalchemy import Engine

from esplanade.server.store.location import Location


def empty_journal(engine: Engine, location: Location) -> bool:
    """Write the journal into the file and cut it to nothing, so that no old rows are left in it.

    False where another process reads the store at this moment. A database sees to its own.
    """
    if location.file is None:
        return True
    connection = engine.raw_connection()
    try:
        cursor = connection.cursor()
        cursor.execute("PRAGMA wal_checkpoint(TRUNCATE)")
        (is_busy, *_), *_ = cursor.fetchall()
        cursor.close()
    finally:
        connection.close()
    return not is_busy


def remove_file(file: Path) -> None:
    """Take away the file of a store that nobody has open, with what is beside it."""
    for each in (file, file.with_name(f"{file.name}-wal"), file.with_name(f"{file.name}-shm")):
        each.unlink(missing_ok=True)

"""Copies of a store: one file that fits SQLite and PostgreSQL alike, taken while a server runs.

It is a ZIP archive of one file of JSON lines for each table, and of a manifest. Sessions and tokens
that are used once are not in it, since they would be good again for who has lost them.
"""

import base64
import json
import os
import zipfile
from datetime import UTC, datetime
from itertools import islice
from pathlib import Path
from typing import Final

from sqlalchemy import Connection, Engine, LargeBinary, MetaData, Table, func, insert, select

from esplanade.server.store.location import Location
from esplanade.server.store.store import StoreError
from esplanade.server.store.tables import METADATA, ONE_TIME, REVISION, SESSIONS
from esplanade.server.store.upgrading import check_known, run_migrations

FORMAT: Final = "esplanade backup 1"
_LEFT_OUT: Final = frozenset({SESSIONS.name, ONE_TIME.name})
_MANIFEST: Final = "manifest.json"
_AT_ONCE: Final = 1000


def write_backup(connection: Connection, path: Path) -> dict[str, int]:
    """Write a copy, within a read of the store; returns the number of rows of each table.

    Raises
    ------
    StoreError
        The file is there already, or cannot be written.
    """
    part = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        if path.exists():
            raise StoreError(f"{path} is there already; a backup replaces nothing")
        with (
            os.fdopen(os.open(part, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o600), "wb") as file,
            zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive,
        ):
            counts = {
                table.name: _write_table(connection, archive, table)
                for table in METADATA.sorted_tables
                if table.name not in _LEFT_OUT
            }
            manifest = {
                "format": FORMAT,
                "revision": REVISION,
                "made": datetime.now(UTC).isoformat(timespec="seconds"),
                "rows": counts,
            }
            archive.writestr(_MANIFEST, json.dumps(manifest, indent=1))
        part.rename(path)
    except OSError as error:
        raise StoreError(f"{path}: {error.strerror or error}") from None
    finally:
        part.unlink(missing_ok=True)
    return counts


def read_backup(engine: Engine, location: Location, path: Path) -> dict[str, int]:
    """Fill a store that has no rows yet, all or nothing; returns the number of rows of each table.

    A copy of an older program is brought to the tables of this one.

    Raises
    ------
    StoreError
        The file is no backup or damaged, is of a newer program, or the store has rows.
    """
    try:
        with zipfile.ZipFile(path) as archive, engine.begin() as connection:
            manifest = json.loads(archive.read(_MANIFEST))
            if manifest.get("format") != FORMAT:
                raise StoreError(f"{path}: the format {manifest.get('format')!r} is not known")
            check_known(manifest["revision"], f"{path}")
            _check_empty(connection, location)
            run_migrations(connection, manifest["revision"])
            counts = {
                name: _read_table(connection, archive, name, rows)
                for name, rows in manifest["rows"].items()
            }
            run_migrations(connection, REVISION)
    except (OSError, zipfile.BadZipFile, KeyError, ValueError, TypeError) as error:
        raise StoreError(f"{path}: this is no backup, or it is damaged: {error}") from error
    return counts


def _write_table(connection: Connection, archive: zipfile.ZipFile, table: Table) -> int:
    columns = [column for column in table.columns if column.identity is None]
    query = select(*columns).order_by(*table.primary_key)
    count = 0
    with archive.open(f"{table.name}.jsonl", "w", force_zip64=True) as file:
        for row in connection.execution_options(yield_per=_AT_ONCE).execute(query):
            values = dict(zip([column.name for column in columns], row, strict=True))
            line = json.dumps(values, ensure_ascii=False, default=_as_text)
            file.write(line.encode() + b"\n")
            count += 1
    return count


def _as_text(value: bytes) -> str:
    """Bytes as JSON can hold them."""
    return base64.b64encode(value).decode()


def _check_empty(connection: Connection, location: Location) -> None:
    present = MetaData()
    present.reflect(connection)
    for table in present.sorted_tables:
        if table.name == "alembic_version":
            continue
        if connection.execute(select(func.count()).select_from(table)).scalar():
            raise StoreError(
                f"{location} has rows in its table {table.name}; a backup is restored into a new "
                "folder or an empty database only"
            )


def _read_table(connection: Connection, archive: zipfile.ZipFile, name: str, expected: int) -> int:
    present = MetaData()
    present.reflect(connection, only=[name])
    table = present.tables[name]
    packed = [column.name for column in table.columns if isinstance(column.type, LargeBinary)]
    count = 0
    with archive.open(f"{name}.jsonl") as file:
        rows = map(json.loads, file)
        while chunk := list(islice(rows, _AT_ONCE)):
            for row in chunk:
                row.update({column: base64.b64decode(row[column]) for column in packed})
            connection.execute(insert(table), chunk)
            count += len(chunk)
    if count != expected:
        raise ValueError(f"{name} has {count} rows instead of {expected}")
    return count

"""SQLAlchemy's engines for a store: how connections are set up, and how transactions begin."""

import os
import zlib
from pathlib import Path
from typing import Any, Final

from sqlalchemy import Connection, Engine, StaticPool, create_engine, event, text
from sqlalchemy.exc import NoSuchModuleError

from esplanade.server.store.location import Location
from esplanade.server.store.store import StoreError

BUSY_MS: Final = 10_000
"""So long a write waits for that of another process, milliseconds."""
_POSTGRESQL_OPTIONS: Final = f"-c lock_timeout={BUSY_MS} -c timezone=UTC"


def writing_engine(
    location: Location, *, durable: bool, zone: str, idle_ms: int | None = None
) -> Engine:
    """An engine for transactions that change something, one after the other for a zone.

    With `durable`, what is committed survives a loss of power too, not only that of the process.
    A database ends a transaction in which nothing was asked for `idle_ms`: that of a process which
    stands still holds nobody up.

    Raises
    ------
    StoreError
        The folder cannot be made, or the driver for PostgreSQL is not installed.
    """
    if location.is_sqlite:
        engine = _sqlite(location, f"PRAGMA synchronous={'FULL' if durable else 'NORMAL'}")
        _begin_with(engine, "BEGIN IMMEDIATE")
        return engine
    engine = _postgresql(location)
    kept = "on" if durable else "local"
    idle = [] if idle_ms is None else [f"SET LOCAL idle_in_transaction_session_timeout = {idle_ms}"]
    _on_begin(
        engine,
        *idle,
        f"SET LOCAL synchronous_commit = {kept}",
        f"SELECT pg_advisory_xact_lock({zlib.crc32(zone.encode())})",
    )
    return engine


def reading_engine(location: Location) -> Engine:
    """An engine for transactions that change nothing and see one state of the tables."""
    if location.is_sqlite:
        engine = _sqlite(location, "PRAGMA query_only=ON")
        _begin_with(engine, "BEGIN")
        return engine
    engine = _postgresql(location)
    _on_begin(engine, "SET TRANSACTION ISOLATION LEVEL REPEATABLE READ READ ONLY")
    return engine


def _sqlite(location: Location, pragma: str) -> Engine:
    more: dict[str, Any] = {}
    if location.file is None:
        more = {"poolclass": StaticPool, "connect_args": {"check_same_thread": False}}
    else:
        _make_private(location.file)
    engine = create_engine(location.url, **more)

    @event.listens_for(engine, "connect")
    def set_up(connection: Any, _: object) -> None:
        connection.isolation_level = None  # transactions begin where this file says so
        for line in (
            f"PRAGMA busy_timeout={BUSY_MS}",
            "PRAGMA journal_mode=WAL",
            "PRAGMA foreign_keys=ON",
            "PRAGMA secure_delete=ON",  # what is forgotten is written over
            pragma,
        ):
            connection.execute(line).close()

    return engine


def _make_private(file: Path) -> None:
    """Make folder and file, for this user only: there are hashes of passwords in it."""
    try:
        file.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        os.close(os.open(file, os.O_CREAT | os.O_RDWR, 0o600))
    except OSError as error:
        raise StoreError(f"{file}: {error.strerror or error}") from None


def _postgresql(location: Location) -> Engine:
    try:
        return create_engine(
            location.url,
            pool_pre_ping=True,
            connect_args={
                "connect_timeout": 10,
                "client_encoding": "utf8",
                "options": _POSTGRESQL_OPTIONS,
            },
        )
    except (ImportError, NoSuchModuleError):
        raise StoreError(
            "a store in PostgreSQL needs its driver: install esplanade[postgresql]"
        ) from None


def _begin_with(engine: Engine, statement: str) -> None:
    @event.listens_for(engine, "begin")
    def begin(connection: Connection) -> None:
        connection.exec_driver_sql(statement)


def _on_begin(engine: Engine, *statements: str) -> None:
    @event.listens_for(engine, "begin")
    def begin(connection: Connection) -> None:
        for statement in statements:
            connection.execute(text(statement))

"""Migrations: which revision a store has, and bringing it to the newest."""

import logging
from typing import Final

from sqlalchemy import Connection, Engine, inspect, text

from esplanade.server.store.location import Location
from esplanade.server.store.store import StoreError
from esplanade.server.store.tables import REVISION

_SCRIPTS: Final = "esplanade.server.store:migrations"


def revision_of(connection: Connection) -> str | None:
    """The revision that the tables have; None where there are none yet."""
    if not inspect(connection).has_table("alembic_version"):
        return None
    found = connection.execute(text("SELECT version_num FROM alembic_version")).scalar()
    return None if found is None else str(found)


def upgrade(engine: Engine, location: Location, *, to: str = REVISION) -> str | None:
    """Bring the tables to a revision, all or nothing; returns the one that they had.

    Raises
    ------
    StoreError
        The tables are newer than this program.
    """
    with engine.begin() as connection:
        before = revision_of(connection)
        if before != to:
            check_known(before, location)
            run_migrations(connection, to)
    return before


def check_current(connection: Connection, location: Location) -> None:
    """Check that the tables are those of this program.

    Raises
    ------
    StoreError
        They are older or newer; the message says what helps.
    """
    found = revision_of(connection)
    if found == REVISION:
        return
    check_known(found, location)
    state = "has no tables yet" if found is None else f"has tables of revision {found}"
    raise StoreError(
        f"{location} {state}, and this program needs {REVISION}: run `esplanade data upgrade`"
    )


def check_known(found: str | None, location: object) -> None:
    """Check that this program knows a revision, newer or not.

    Raises
    ------
    StoreError
        It does not.
    """
    if found is not None and found > REVISION:
        raise StoreError(
            f"{location} has tables of revision {found}, which is newer than {REVISION}, "
            "the newest of this program: run a newer program"
        )


def run_migrations(connection: Connection, to: str) -> None:
    """Bring the tables to a revision, within a transaction; those that have it stay as they are."""
    logging.getLogger("alembic").setLevel(logging.WARNING)  # it tells of its own import too
    # Where nothing is to be done, nobody waits for the import.
    from alembic import command  # noqa: PLC0415
    from alembic.config import Config  # noqa: PLC0415

    config = Config()
    config.set_main_option("script_location", _SCRIPTS)
    config.set_main_option("path_separator", "os")
    config.attributes["connection"] = connection
    command.upgrade(config, to)

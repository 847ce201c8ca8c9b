"""Migrations make the tables that the code means; older and newer stores are told of."""

import asyncio

import pytest
from alembic.autogenerate import compare_metadata
from alembic.config import Config
from alembic.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import Connection, text

from esplanade.server.store.location import Location
from esplanade.server.store.sql_store import SqlStore, open_store
from esplanade.server.store.store import StoreError
from esplanade.server.store.tables import METADATA, REVISION
from esplanade.server.store.upgrading import revision_of, upgrade


async def test_migrations_make_the_tables(store: SqlStore) -> None:
    def differences(connection: Connection) -> list[object]:
        context = MigrationContext.configure(connection, opts={"compare_type": True})
        return list(compare_metadata(context, METADATA))

    assert await store.write(differences) == []


def test_the_newest_migration_is_the_one_that_the_tables_name() -> None:
    config = Config()
    config.set_main_option("script_location", "esplanade.server.store:migrations")
    config.set_main_option("path_separator", "os")
    scripts = ScriptDirectory.from_config(config)
    assert scripts.get_heads() == [REVISION]
    revisions = [script.revision for script in scripts.walk_revisions()]
    assert sorted(revisions, reverse=True) == revisions


def test_every_key_begins_with_the_zone() -> None:
    for table in METADATA.sorted_tables:
        first = next(iter(table.columns))
        keys = [tuple(column.name for column in table.primary_key)]
        keys += [
            tuple(column.name for column in constraint.columns)  # type: ignore[attr-defined]
            for constraint in table.constraints
            if type(constraint).__name__ == "UniqueConstraint"
        ]
        assert any(key[0] == "zone" for key in keys), table.name
        assert first.name in {"zone", "id"}


async def test_a_database_is_upgraded_only_when_asked(location: Location) -> None:
    if location.is_sqlite:
        async with open_store(location) as store:
            assert await store.read(revision_of) == REVISION
        return
    with pytest.raises(StoreError, match=r"has no tables yet.*run `esplanade data upgrade`"):
        async with open_store(location):
            pass
    async with open_store(location, upgrading=True):
        pass
    async with open_store(location) as store:
        assert await store.read(revision_of) == REVISION


async def test_two_that_start_at_once_make_the_tables_once(location: Location) -> None:
    async def start() -> str | None:
        async with open_store(location, upgrading=True) as store:
            return await store.read(revision_of)

    assert await asyncio.gather(*(start() for _ in range(4))) == [REVISION] * 4


async def test_an_upgrade_says_what_was_there(location: Location) -> None:
    store = SqlStore(location)
    try:
        assert upgrade(store.engine, location) is None
        assert upgrade(store.engine, location) == REVISION
    finally:
        await store.close()


async def test_a_store_of_a_newer_program_is_refused(location: Location) -> None:
    async with open_store(location, upgrading=True) as store:
        newer = text("UPDATE alembic_version SET version_num = '9999'")
        await store.write(lambda connection: connection.execute(newer).rowcount)
    for upgrading in (True, False):
        with pytest.raises(StoreError, match=r"revision 9999, which is newer than .*newer program"):
            async with open_store(location, upgrading=upgrading):
                pass

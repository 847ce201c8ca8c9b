"""Stores for tests, as fixtures that several folders share."""

from collections.abc import AsyncIterator, Iterator
from pathlib import Path

import pytest

from esplanade.server.store.location import Location
from esplanade.server.store.sql_store import SqlStore, open_store
from tests.server.databases import new_database, postgresql

KINDS = ("sqlite", "postgresql")


@pytest.fixture(scope="session")
def database_server() -> Iterator[str]:
    """The address of a PostgreSQL that this run has started."""
    with postgresql() as address:
        yield address


@pytest.fixture(params=KINDS)
def location(request: pytest.FixtureRequest, tmp_path: Path) -> Location:
    """A new place for a store, of both kinds in turn."""
    if request.param == "sqlite":
        return Location.of(tmp_path / "data")
    return Location.of(None, new_database(request.getfixturevalue("database_server")))


@pytest.fixture
async def store(location: Location) -> AsyncIterator[SqlStore]:
    """A store with all tables and no rows."""
    async with open_store(location, upgrading=True) as opened:
        yield opened


class Clock:
    """A clock that stands until it is moved; microseconds."""

    def __init__(self) -> None:
        self.now_us = 1_800_000_000_000_000

    def __call__(self) -> int:
        return self.now_us

    def go_on(self, seconds: float) -> None:
        self.now_us += int(seconds * 1e6)

"""Fixtures of the console's tests."""

from collections.abc import AsyncIterator, Iterator

import pytest

from esplanade.server.store.location import Location
from esplanade.server.store.sql_store import SqlStore, open_store
from tests.server.populated import Populated, spec


@pytest.fixture
def world() -> Iterator[Populated]:
    """Three actors; the first has the tag `fast`."""
    populated = Populated([spec(1, tags=["fast"]), spec(2), spec(3)])
    populated.frame()
    yield populated
    populated.population.close()


@pytest.fixture
async def memory() -> AsyncIterator[SqlStore]:
    """A store that ends with the test."""
    async with open_store(Location.of(None)) as opened:
        yield opened

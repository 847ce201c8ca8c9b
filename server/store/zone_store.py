"""The tables of one zone, in the store of a world of several."""

from collections.abc import Callable

from sqlalchemy import Column, ColumnElement, Connection, or_

from esplanade.server.store.location import Location
from esplanade.server.store.store import Result, Store


class ZoneStore:
    """A `Store` whose keys name a zone of a world; it is open as long as that of the world is."""

    def __init__(self, whole: Store, name: str) -> None:
        self.zone = f"{whole.zone}/{name}"
        self._whole = whole

    @property
    def location(self) -> Location:
        """The place where the tables are."""
        return self._whole.location

    @property
    def world(self) -> str:
        """The zone that keys name of what all zones share."""
        return self._whole.zone

    async def read(self, query: Callable[[Connection], Result]) -> Result:
        """Return the result of a query; see `Store.read`."""
        return await self._whole.read(query)

    async def write(self, change: Callable[[Connection], Result]) -> Result:
        """Return the result of a change once it is committed; see `Store.write`."""
        return await self._whole.write(change)


def anywhere_in(zones: Column[str], world: str) -> ColumnElement[bool]:
    """Whether a column names a world or one of its zones."""
    return or_(zones == world, zones.startswith(f"{world}/", autoescape=True))

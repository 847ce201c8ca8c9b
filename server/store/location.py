"""Places of stores: a folder with an SQLite file, a PostgreSQL database, or memory."""

from dataclasses import dataclass
from pathlib import Path
from typing import Final, Self

from sqlalchemy import URL, make_url
from sqlalchemy.exc import ArgumentError

from esplanade.server.store.store import StoreError

FILE: Final = "esplanade.sqlite"
"""The SQLite file in the folder of data."""
_POSTGRESQL: Final = frozenset({"postgres", "postgresql", "postgresql+psycopg"})


@dataclass(frozen=True)
class Location:
    """The place of the tables; neither `str` nor `repr` shows a password."""

    url: URL

    @classmethod
    def of(cls, data: Path | None, store: str = "") -> Self:
        """The database that is named, else the file in the folder, else memory.

        Raises
        ------
        StoreError
            The name is not one of a PostgreSQL database.
        """
        if store:
            return cls(_database(store))
        if data is None:
            return cls(URL.create("sqlite+pysqlite"))
        return cls(URL.create("sqlite+pysqlite", database=str(data / FILE)))

    @property
    def is_sqlite(self) -> bool:
        return self.url.get_backend_name() == "sqlite"

    @property
    def file(self) -> Path | None:
        """The SQLite file; None for what is elsewhere."""
        return Path(self.url.database) if self.is_sqlite and self.url.database else None

    @property
    def in_memory(self) -> bool:
        """Whether the store ends with the process."""
        return self.is_sqlite and self.file is None

    def __str__(self) -> str:
        if self.is_sqlite:
            return str(self.file or "memory")
        return self.url.set(drivername="postgresql").render_as_string(hide_password=True)


def _database(store: str) -> URL:
    try:
        url = make_url(store)
    except (ArgumentError, ValueError):  # the message of the library may hold the password
        raise StoreError(f"store: this is no address such as {_EXAMPLE}") from None
    if url.drivername not in _POSTGRESQL or not url.database:
        shown = url.render_as_string(hide_password=True)
        raise StoreError(f"store: {shown} is no address such as {_EXAMPLE}")
    return url.set(drivername="postgresql+psycopg")


_EXAMPLE: Final = "postgresql://user:password@host/database"

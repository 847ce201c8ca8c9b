"""The interface of stores for the rest of the server."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Final, Protocol, TypeVar

from sqlalchemy import Connection

if TYPE_CHECKING:
    from esplanade.server.store.location import Location

Result = TypeVar("Result")

ZONE: Final = "main"
"""The zone that keys name where there is one, and for all that the zones of a world share."""


class StoreError(Exception):
    """The store cannot be used; the message says which and why, and holds no password."""


class StoreBusyError(StoreError):
    """Too much waits for the store already; nothing was done, and one may try again later."""


class Store(Protocol):
    """Transactions on the tables of one zone.

    `read` and `write` take a function of a connection and run it in a thread of the store, within
    one transaction. The function names tables of `esplanade.server.store.tables` in SQLAlchemy's
    words, so that it means the same to SQLite and PostgreSQL. It may be cancelled before it begins,
    and is finished once it has begun. Any event loop may call both, and the loop never waits.

    - A function that raises leaves no trace, and its exception is raised to the caller.
    - What `write` returns is committed: it survives the death of the process.
    - All writes of a zone happen one after the other, also those of other processes. So a write may
      look first and change then.
    - A read sees all that was committed before it began, and none of what is committed during it.
      It is to be short: whoever reads many rows reads them page by page.
    - What waits is bounded; beyond it `StoreBusyError` is raised at once.

    To add a table: declare it in `tables.py` with `zone` as the first column of its key, add a
    revision to `migrations/versions/` and name it in `tables.REVISION`, and write the module that
    uses it beside `esplanade.server.audit`, as functions of a connection. Copies of the store take
    in every table by themselves (`backup.py`). If the table says something of people, add to
    `FORGETTERS` of `esplanade.server.operating.forgetting` what forgets a person in it.
    """

    @property
    def location(self) -> "Location":
        """The place where the tables are."""
        ...

    @property
    def zone(self) -> str:
        """The zone that keys name."""
        ...

    @property
    def world(self) -> str:
        """The zone that keys name of what all zones of a world share, such as accounts."""
        ...

    async def read(self, query: Callable[[Connection], Result]) -> Result:
        """Return the result of a query.

        Raises
        ------
        StoreBusyError
            Too many reads wait.
        StoreError
            The store cannot be reached, or is closed.
        """
        ...

    async def write(self, change: Callable[[Connection], Result]) -> Result:
        """Return the result of a change once it is committed.

        Raises
        ------
        StoreBusyError
            Too many writes wait.
        StoreError
            The store cannot be reached, is closed, or could not commit.
        """
        ...

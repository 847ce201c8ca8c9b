"""The clock of the database, in SQL: of all clocks of a cluster it is the only one that counts."""

from typing import Any, Final

from sqlalchemy import BigInteger, ColumnElement
from sqlalchemy.ext.compiler import compiles
from sqlalchemy.sql.functions import FunctionElement


class _Now(FunctionElement[int]):
    """Microseconds since 1970, as they go on within a transaction."""

    type = BigInteger()
    inherit_cache = True


class _Started(FunctionElement[int]):
    """The moment at which the database server began; 0 where there is none."""

    type = BigInteger()
    inherit_cache = True


NOW_US: Final[ColumnElement[int]] = _Now()
STARTED_US: Final[ColumnElement[int]] = _Started()


@compiles(_Now, "postgresql")
def _now_of_postgresql(*_: Any, **__: Any) -> str:
    return "CAST(extract(epoch FROM clock_timestamp()) * 1000000 AS bigint)"


@compiles(_Now, "sqlite")
def _now_of_sqlite(*_: Any, **__: Any) -> str:
    return "CAST((julianday('now') - 2440587.5) * 86400000000 AS INTEGER)"


@compiles(_Started, "postgresql")
def _started_of_postgresql(*_: Any, **__: Any) -> str:
    return "CAST(extract(epoch FROM pg_postmaster_start_time()) * 1000000 AS bigint)"


@compiles(_Started, "sqlite")
def _started_of_sqlite(*_: Any, **__: Any) -> str:
    return "0"

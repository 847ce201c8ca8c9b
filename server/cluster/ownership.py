"""Owners of zones, as the database has them: each function is part of one transaction.

An ownership is a lease with an epoch. A host that claims a zone gets an epoch above all before it,
and everything that it writes for the zone asks first whether that epoch is still the newest
(`assert_owned`): a host that was frozen while another took its zone changes nothing when it wakes.
"""

from collections.abc import Collection
from dataclasses import dataclass
from typing import Any, Final

from sqlalchemy import (
    BigInteger,
    ColumnElement,
    Connection,
    Row,
    case,
    insert,
    literal,
    or_,
    select,
    update,
)
from sqlalchemy.exc import IntegrityError

from esplanade.server.cluster.database_time import NOW_US, STARTED_US
from esplanade.server.cluster.tenure import LEASE_S, Claim
from esplanade.server.store.store import StoreError
from esplanade.server.store.tables import OWNERSHIPS

Moment = ColumnElement[int] | int
"""Microseconds since 1970 by the clock of the database; tests give numbers."""

LEASE_US: Final = round(LEASE_S * 1e6)
STARTING_US: Final = LEASE_US + 1_000_000
"""For so long after the database has started nothing is claimed: owners that could not renew while
it was down come first."""

_MILLISECONDS: Final = 1000


class NotOwnerError(StoreError):
    """The zone is another host's by now; nothing was written."""


@dataclass(frozen=True)
class Ownership:
    """A zone as the database has it."""

    zone: str
    epoch: int
    host: str | None
    until_us: int
    wanted_host: str | None


def add_zone(connection: Connection, zone: str) -> bool:
    """Let a zone be claimed; returns False if it could be already."""
    row = {"zone": zone, "epoch": 0, "until_us": 0}
    savepoint = connection.begin_nested()
    try:
        connection.execute(insert(OWNERSHIPS).values(row))
    except IntegrityError:
        savepoint.rollback()
        return False
    savepoint.commit()
    return True


def claim(
    connection: Connection, host: str, zones: Collection[str] | None = None, *, now: Moment = NOW_US
) -> Claim | None:
    """Claim the zone that has been without an owner for longest; None if there is none.

    Claimers at once get different zones. Epochs follow the database's clock where that is above
    them, so that they go on growing even when the database is restored from a copy.
    """
    table, at = OWNERSHIPS.c, _moment(now)
    free = [
        table.until_us < at,
        at - STARTED_US > STARTING_US,
        or_(table.wanted_host.is_(None), table.wanted_host == host),
    ]
    if zones is not None:
        free.append(table.zone.in_(zones))
    chosen = (
        select(table.zone)
        .where(*free)
        .order_by(table.until_us, table.zone)
        .limit(1)
        .with_for_update(skip_locked=True)
        .scalar_subquery()
    )
    by_clock = at // _MILLISECONDS
    taken = (
        update(OWNERSHIPS)
        .where(table.zone == chosen)
        .values(
            epoch=case((table.epoch >= by_clock, table.epoch + 1), else_=by_clock),
            host=host,
            until_us=at + LEASE_US,
        )
        .returning(table.zone, table.epoch)
    )
    row = connection.execute(taken).one_or_none()
    return None if row is None else Claim(row.zone, host, row.epoch)


def renew(connection: Connection, claimed: Claim, *, now: Moment = NOW_US) -> bool:
    """Lengthen a lease, also one that has run out if nobody else took the zone.

    Returns False where the zone is another's, or was taken away: its host stands down.
    """
    changed = update(OWNERSHIPS).where(*_owned(claimed)).values(until_us=_moment(now) + LEASE_US)
    return connection.execute(changed).rowcount == 1


def release(connection: Connection, claimed: Claim) -> bool:
    """Give a zone up, so that another host may claim it at once."""
    changed = update(OWNERSHIPS).where(*_owned(claimed)).values(host=None, until_us=0)
    return connection.execute(changed).rowcount == 1


def fence(connection: Connection, zone: str) -> bool:
    """Take a zone away from its owner, whatever that does; returns False if there is no such zone.

    The epoch grows, so that nothing of the owner's has an effect any more.
    """
    changed = (
        update(OWNERSHIPS)
        .where(OWNERSHIPS.c.zone == zone)
        .values(epoch=OWNERSHIPS.c.epoch + 1, host=None, until_us=0)
    )
    return connection.execute(changed).rowcount == 1


def want(connection: Connection, zone: str, host: str | None) -> bool:
    """Say which host is the only one that may claim a zone; None: any host.

    Its owner keeps it until it releases it or is fenced. Returns False if there is no such zone.
    """
    changed = update(OWNERSHIPS).where(OWNERSHIPS.c.zone == zone).values(wanted_host=host)
    return connection.execute(changed).rowcount == 1


def ownerships(connection: Connection) -> list[Ownership]:
    """All zones, by name."""
    rows = connection.execute(select(OWNERSHIPS).order_by(OWNERSHIPS.c.zone)).all()
    return [_ownership(row) for row in rows]


def assert_owned(connection: Connection, claimed: Claim) -> None:
    """Make sure that a transaction is the owner's, and that nobody claims the zone before its end.

    Raises
    ------
    NotOwnerError
        The zone has another owner, or a newer epoch.
    """
    held = select(OWNERSHIPS.c.zone).where(*_owned(claimed)).with_for_update(read=True)
    if connection.execute(held).one_or_none() is None:
        raise NotOwnerError(
            f"{claimed.host} does not own {claimed.zone} any more: epoch {claimed.epoch} is over"
        )


def _owned(claimed: Claim) -> list[ColumnElement[bool]]:
    table = OWNERSHIPS.c
    return [
        table.zone == claimed.zone,
        table.host == claimed.host,
        table.epoch == claimed.epoch,
    ]


def _moment(now: Moment) -> ColumnElement[int]:
    return literal(now, BigInteger) if isinstance(now, int) else now


def _ownership(row: Row[Any]) -> Ownership:
    return Ownership(row.zone, row.epoch, row.host, row.until_us, row.wanted_host)

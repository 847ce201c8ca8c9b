"""Copies of a zone in the database: which one somebody enters, and which ones hosts may claim.

Each function is part of one transaction. A copy is open while it has an owner. The people of a copy
are the seats in it, so that hosts and gateways go by the same numbers.
"""

from collections.abc import Collection, Iterable

from sqlalchemy import Connection, select

from esplanade.server.cluster import ownership
from esplanade.server.cluster.database_time import NOW_US
from esplanade.server.cluster.ownership import Moment
from esplanade.server.cluster.seats import people_by_zone
from esplanade.server.cluster.tenure import Claim
from esplanade.server.copies import Copies
from esplanade.server.store.tables import OWNERSHIPS


def entered(
    connection: Connection, copies: Copies, wished: str | None = None, *, now: Moment = NOW_US
) -> str | None:
    """The copy that somebody enters, as `Copies.entered` says; None if all are full.

    While no copy has an owner it is the first, which is the one to have an owner next.
    """
    table = OWNERSHIPS.c
    owned = select(table.zone).where(table.zone.in_(copies.names), table.until_us > now)
    is_open = connection.execute(owned).scalars().all() or copies.names[:1]
    people = people_by_zone(connection)
    return copies.entered({name: people.get(name, 0) for name in is_open}, wished)


def claim(
    connection: Connection,
    host: str,
    zones: Collection[str],
    copied: Iterable[Copies],
    *,
    now: Moment = NOW_US,
) -> Claim | None:
    """Claim one of some zones that is to be open; None if there is none without an owner.

    A zone where people belong comes before a copy that nobody has entered yet.
    """
    unwanted, empty = _shut(connection, copied)
    wanted = [zone for zone in zones if zone not in unwanted]
    first = [zone for zone in wanted if zone not in empty]
    claimed = ownership.claim(connection, host, first, now=now)
    if claimed is None and len(first) < len(wanted):
        claimed = ownership.claim(connection, host, wanted, now=now)
    return claimed


def is_wanted(connection: Connection, copies: Copies, zone: str) -> bool:
    """Whether a copy is to be open."""
    return zone in copies.wanted(people_by_zone(connection))


def _shut(connection: Connection, copied: Iterable[Copies]) -> tuple[set[str], set[str]]:
    """The copies that are to be shut, and those that are to be open for people to come."""
    copied = list(copied)
    people = people_by_zone(connection) if copied else {}
    unwanted: set[str] = set()
    empty: set[str] = set()
    for copies in copied:
        wanted = copies.wanted(people)
        unwanted.update(name for name in copies.names if name not in wanted)
        empty.update(name for name in copies.names[1:] if not people.get(name, 0))
    return unwanted, empty

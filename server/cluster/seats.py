"""Where each person's one seat in the cluster is: each function is part of one transaction.

A seat is in one zone. Each time somebody takes it, with a token, its generation grows; each time it
goes to another zone, its number of hops does. Whoever names an older number changes nothing.
"""

import secrets
from collections.abc import Collection, Iterable
from dataclasses import dataclass, field
from itertools import islice
from typing import Any, Final

from sqlalchemy import (
    ColumnElement,
    Connection,
    Row,
    delete,
    func,
    insert,
    or_,
    select,
    tuple_,
    update,
)
from sqlalchemy.exc import IntegrityError

from esplanade.server.accounts.identity import digest_of
from esplanade.server.cluster.database_time import NOW_US
from esplanade.server.cluster.ownership import Moment, assert_owned
from esplanade.server.cluster.tenure import Claim
from esplanade.server.store.tables import CLUSTER_SEATS

NAMES_TOGETHER: Final = 64
"""The number of names that are looked up at once."""
_TOKEN_BYTES: Final = 24

Held = tuple[int, int]
"""A person, and the generation of the seat."""


@dataclass(frozen=True)
class ClusterSeat:
    """A person's seat as the database has it."""

    person: int
    zone: str
    name: str
    generation: int
    hops: int
    gateway: str | None
    vacated_us: int | None
    """The moment since which nobody steers; None while somebody does."""
    state: bytes = field(repr=False)
    """The record of the person, as it was written last."""
    digests: tuple[bytes, ...] = field(default=(), repr=False, compare=False)
    """SHA-256 of the tokens that take the seat, the newest last."""


def take(
    connection: Connection,
    zone: str,
    name: str,
    gateway: str,
    state: bytes,
    skeleton: str | None = None,
) -> tuple[ClusterSeat, str]:
    """Make a seat for a new person; returns it with the token that takes it again.

    No two people have the same `skeleton`, the form that names which look alike have in common.
    """
    token = _new_token()
    row = {
        "zone": zone,
        "name": name,
        "skeleton": skeleton,
        "newest": digest_of(token),
        "hops": 0,
        "generation": 1,
        "gateway": gateway,
        "state": state,
    }
    made = connection.execute(insert(CLUSTER_SEATS).values(row).returning(CLUSTER_SEATS)).one()
    return _seat(made), token


def take_named(
    connection: Connection, zone: str, names: Iterable[tuple[str, str]], gateway: str, state: bytes
) -> tuple[ClusterSeat, str]:
    """Make a seat for a new person under the first of some names that nobody has.

    `names` go on for ever, each with its skeleton.
    """
    endless = iter(names)
    while True:
        tried = list(islice(endless, NAMES_TOGETHER))
        chosen = select(CLUSTER_SEATS.c.skeleton)
        skeletons = [skeleton for _, skeleton in tried]
        taken = set(
            connection.execute(chosen.where(CLUSTER_SEATS.c.skeleton.in_(skeletons))).scalars()
        )
        for name, skeleton in tried:
            if skeleton in taken:
                continue
            savepoint = connection.begin_nested()
            try:
                made = take(connection, zone, name, gateway, state, skeleton)
            except IntegrityError:  # another gateway was quicker
                savepoint.rollback()
                continue
            savepoint.commit()
            return made


def resume(
    connection: Connection, token: str, gateway: str, keep_us: int, *, now: Moment = NOW_US
) -> tuple[ClusterSeat, str] | None:
    """Take a seat again, at any gateway; returns it with its next token, or None if it is gone.

    The token that was used remains valid beside the new one until `confirm`: an answer that is lost
    loses no seat. A seat that has been vacant for longer than `keep_us` is gone.
    """
    table, used, renewed = CLUSTER_SEATS.c, digest_of(token), _new_token()
    changed = (
        update(CLUSTER_SEATS)
        .where(*_taken_by(used, keep_us, now))
        .values(
            generation=table.generation + 1,
            gateway=gateway,
            vacated_us=None,
            used=used,
            newest=digest_of(renewed),
        )
        .returning(CLUSTER_SEATS)
    )
    row = connection.execute(changed).one_or_none()
    return None if row is None else (_seat(row), renewed)


def has(connection: Connection, token: str, keep_us: int, *, now: Moment = NOW_US) -> bool:
    """Whether a token takes a seat."""
    chosen = select(CLUSTER_SEATS.c.person).where(*_taken_by(digest_of(token), keep_us, now))
    return connection.execute(chosen).one_or_none() is not None


def confirm(connection: Connection, held: Collection[Held]) -> int:
    """Note that the newest tokens have arrived: those before take these seats no more. Returns of
    how many it was noted."""
    changed = update(CLUSTER_SEATS).where(_among(held)).values(used=None)
    return connection.execute(changed).rowcount


def vacate(connection: Connection, held: Collection[Held], *, now: Moment = NOW_US) -> int:
    """Note that nobody steers these any more, unless somebody has taken the seat since.

    One statement for all of them, as of those below: when a gateway ends, its crowd is lost at
    once. Returns of how many it was noted.
    """
    changed = update(CLUSTER_SEATS).where(_among(held)).values(vacated_us=now, gateway=None)
    return connection.execute(changed).rowcount


def reoccupy(connection: Connection, held: Collection[Held], gateway: str) -> int:
    """Note that clients of a gateway that were thought lost steer after all, if nobody took their
    seats; returns of how many it was noted."""
    changed = update(CLUSTER_SEATS).where(_among(held)).values(vacated_us=None, gateway=gateway)
    return connection.execute(changed).rowcount


def leave(connection: Connection, held: Collection[Held]) -> int:
    """Remove the seats of people who go for good; returns their number."""
    return connection.execute(delete(CLUSTER_SEATS).where(_among(held))).rowcount


def expel(connection: Connection, owner: Claim, person: int) -> bool:
    """Remove the seat of a person whom operators send out, whoever has taken it last.

    Raises
    ------
    NotOwnerError
        The zone is another host's.
    """
    assert_owned(connection, owner)
    table = CLUSTER_SEATS.c
    gone = delete(CLUSTER_SEATS).where(table.person == person, table.zone == owner.zone)
    return connection.execute(gone).rowcount == 1


def remove_vacant(
    connection: Connection, owner: Claim, keep_us: int, *, now: Moment = NOW_US
) -> list[int]:
    """Remove the seats of a zone that have been vacant for too long; returns their persons.

    Raises
    ------
    NotOwnerError
        The zone is another host's.
    """
    assert_owned(connection, owner)
    table = CLUSTER_SEATS.c
    gone = (
        delete(CLUSTER_SEATS)
        .where(table.zone == owner.zone, table.vacated_us <= now - keep_us)
        .returning(table.person)
    )
    return sorted(connection.execute(gone).scalars())


def hop(
    connection: Connection, owner: Claim, person: int, hops: int, destination: str, state: bytes
) -> bool:
    """Move a seat to another zone: the only moment of a hop that counts.

    Returns False if the person has hopped already, or is not in the owner's zone.

    Raises
    ------
    NotOwnerError
        The zone that the person leaves is another host's.
    """
    assert_owned(connection, owner)
    table = CLUSTER_SEATS.c
    moved = (
        update(CLUSTER_SEATS)
        .where(table.person == person, table.hops == hops, table.zone == owner.zone)
        .values(zone=destination, hops=table.hops + 1, state=state)
    )
    return connection.execute(moved).rowcount == 1


def keep_states(connection: Connection, owner: Claim, states: Collection[tuple[int, bytes]]) -> int:
    """Write the records of persons in a zone; returns of how many, leaving out who has gone on.

    Raises
    ------
    NotOwnerError
        The zone is another host's.
    """
    assert_owned(connection, owner)
    table, written = CLUSTER_SEATS.c, 0
    for person, state in states:
        chosen = update(CLUSTER_SEATS).where(table.person == person, table.zone == owner.zone)
        written += connection.execute(chosen.values(state=state)).rowcount
    return written


def seat_of(connection: Connection, person: int) -> ClusterSeat | None:
    """The seat of a person; None if there is none."""
    chosen = select(CLUSTER_SEATS).where(CLUSTER_SEATS.c.person == person)
    row = connection.execute(chosen).one_or_none()
    return None if row is None else _seat(row)


def seats_of(connection: Connection, persons: Collection[int]) -> list[ClusterSeat]:
    """The seats of those of some persons who have one, in whatever zone."""
    chosen = select(CLUSTER_SEATS).where(CLUSTER_SEATS.c.person.in_(persons))
    return [_seat(row) for row in connection.execute(chosen.order_by(CLUSTER_SEATS.c.person))]


def people_by_zone(connection: Connection) -> dict[str, int]:
    """The number of seats of each zone that has any."""
    zone = CLUSTER_SEATS.c.zone
    rows = connection.execute(select(zone, func.count()).group_by(zone))
    return {row[0]: int(row[1]) for row in rows}


def seats_in(connection: Connection, zone: str) -> list[ClusterSeat]:
    """The seats of everyone who belongs in a zone, by their numbers.

    A host that has claimed a zone begins with these.
    """
    chosen = select(CLUSTER_SEATS).where(CLUSTER_SEATS.c.zone == zone)
    return [_seat(row) for row in connection.execute(chosen.order_by(CLUSTER_SEATS.c.person))]


def _among(held: Collection[Held]) -> ColumnElement[bool]:
    table = CLUSTER_SEATS.c
    return tuple_(table.person, table.generation).in_(list(held))


def _taken_by(
    digest: str, keep_us: int, now: Moment
) -> tuple[ColumnElement[bool], ColumnElement[bool]]:
    """The seat that a token of this digest takes."""
    table = CLUSTER_SEATS.c
    return (
        or_(table.newest == digest, table.used == digest),
        or_(table.vacated_us.is_(None), table.vacated_us > now - keep_us),
    )


def _new_token() -> str:
    return secrets.token_urlsafe(_TOKEN_BYTES)


def _seat(row: Row[Any]) -> ClusterSeat:
    return ClusterSeat(
        person=row.person,
        zone=row.zone,
        name=row.name,
        generation=row.generation,
        hops=row.hops,
        gateway=row.gateway,
        vacated_us=row.vacated_us,
        state=row.state,
        digests=tuple(bytes.fromhex(each) for each in (row.used, row.newest) if each is not None),
    )

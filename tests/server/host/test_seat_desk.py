"""The seats of a crowd whose gateway has ended: all of them are written in few statements."""

import time
from collections.abc import Iterator
from contextlib import contextmanager

from sqlalchemy import Connection, Engine, event

from esplanade.server.cluster import ownership, seats
from esplanade.server.cluster.tenure import Claim
from esplanade.server.host.seat_desk import SeatDesk
from esplanade.server.store.sql_store import SqlStore

CROWD = 600
HOUR_US = 3_600_000_000
FEW = 10


@contextmanager
def counted() -> Iterator[list[str]]:
    """The statements that are carried out meanwhile."""
    statements: list[str] = []

    def note(_connection: object, _cursor: object, statement: str, *_: object) -> None:
        statements.append(statement)

    event.listen(Engine, "before_cursor_execute", note)
    try:
        yield statements
    finally:
        event.remove(Engine, "before_cursor_execute", note)


def begun(connection: Connection) -> tuple[Claim, list[int]]:
    """A claim of the hall, and the persons of a crowd there."""
    ownership.add_zone(connection, "hall")
    later_us = round(1e6 * time.time()) + 60_000_000
    claim = ownership.claim(connection, "oak", now=later_us)
    assert claim is not None
    names = [f"Member {k}" for k in range(CROWD)]
    taken = [seats.take(connection, "hall", name, "east", b"", name) for name in names]
    return claim, [seat.person for seat, _ in taken]


async def test_a_crowd_is_vacated_reoccupied_and_removed_in_few_statements(store: SqlStore) -> None:
    claim, crowd = await store.write(begun)
    desk = SeatDesk(store, claim, HOUR_US)
    for person in crowd:
        desk.vacate(person, 1)
    with counted() as statements:
        await desk.flush()
    assert len(statements) < FEW
    kept = await store.read(lambda to: seats.seats_in(to, "hall"))
    assert all(seat.vacated_us is not None and seat.gateway is None for seat in kept)

    for person in crowd[:400]:
        desk.reoccupy(person, 1, "west")
    for person in crowd[400:]:
        desk.leave(person, 1)
    with counted() as statements:
        await desk.flush()
    assert len(statements) < FEW
    kept = await store.read(lambda to: seats.seats_in(to, "hall"))
    assert [(seat.person, seat.gateway, seat.vacated_us) for seat in kept] == [
        (person, "west", None) for person in crowd[:400]
    ]

"""Rows of checkpoints and seats, as functions of a connection."""

from collections.abc import Iterable
from dataclasses import dataclass

from sqlalchemy import Connection, delete, insert, select, update

from esplanade.server.store.tables import CHECKPOINTS, SEATS

Point = tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class KeptCheckpoint:
    """A checkpoint as it stands in the store."""

    made_us: int
    tick: int
    scene: str
    scene_name: str
    format: str
    digest: str
    payload: bytes


@dataclass(frozen=True, slots=True)
class KeptSeat:
    """A seat as it stands in the store; of its tokens it has the digests only."""

    avatar: int
    name: str
    address: str
    digests: tuple[bytes, ...]
    place: Point
    """Where the avatar came into the world."""


def write_checkpoint(connection: Connection, zone: str, kept: KeptCheckpoint) -> None:
    """Put a checkpoint in the place of the one before."""
    values = {name: getattr(kept, name) for name in KeptCheckpoint.__dataclass_fields__}
    done = connection.execute(update(CHECKPOINTS).where(CHECKPOINTS.c.zone == zone).values(values))
    if done.rowcount == 0:
        connection.execute(insert(CHECKPOINTS).values(zone=zone, **values))


def read_checkpoint(connection: Connection, zone: str) -> KeptCheckpoint | None:
    """The newest checkpoint, None where there is none."""
    columns = [CHECKPOINTS.c[name] for name in KeptCheckpoint.__dataclass_fields__]
    row = connection.execute(select(*columns).where(CHECKPOINTS.c.zone == zone)).first()
    if row is None:
        return None
    values = dict(row._mapping)  # noqa: SLF001 (it is SQLAlchemy's public name)
    return KeptCheckpoint(**{**values, "payload": bytes(values["payload"])})


def add_seat(connection: Connection, zone: str, seat: KeptSeat) -> None:
    """Write a new seat."""
    x, y, z = seat.place
    connection.execute(
        insert(SEATS).values(
            zone=zone,
            avatar=seat.avatar,
            name=seat.name,
            address=seat.address,
            digests=_text(seat.digests),
            x=x,
            y=y,
            z=z,
        )
    )


def change_seat(
    connection: Connection, zone: str, avatar: int, address: str, digests: Iterable[bytes]
) -> bool:
    """Write other tokens of a seat; whether it is still there."""
    done = connection.execute(
        update(SEATS)
        .where(SEATS.c.zone == zone, SEATS.c.avatar == avatar)
        .values(address=address, digests=_text(digests))
    )
    return done.rowcount > 0


def remove_seat(connection: Connection, zone: str, avatar: int) -> None:
    """Take a seat away, if it is there."""
    connection.execute(delete(SEATS).where(SEATS.c.zone == zone, SEATS.c.avatar == avatar))


def read_seats(connection: Connection, zone: str) -> list[KeptSeat]:
    """All seats, the oldest first.

    Raises
    ------
    ValueError
        Digests of one are not hexadecimal.
    """
    rows = connection.execute(select(SEATS).where(SEATS.c.zone == zone).order_by(SEATS.c.avatar))
    return [
        KeptSeat(
            row.avatar,
            row.name,
            row.address,
            tuple(bytes.fromhex(each) for each in row.digests.split()),
            (row.x, row.y, row.z),
        )
        for row in rows
    ]


def begin_anew(connection: Connection, zone: str) -> None:
    """Take the checkpoint and all seats away; numbers stay reserved."""
    connection.execute(delete(CHECKPOINTS).where(CHECKPOINTS.c.zone == zone))
    connection.execute(delete(SEATS).where(SEATS.c.zone == zone))


def _text(digests: Iterable[bytes]) -> str:
    return " ".join(each.hex() for each in digests)

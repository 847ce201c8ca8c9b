"""Numbers that are given away once: reserved durably in blocks, before any of a block is used."""

from typing import Final, NamedTuple

from sqlalchemy import Connection, insert, select, update

from esplanade.server.store.tables import RESERVED

BLOCK: Final = 4096
AVATARS: Final = "avatars"


class Block(NamedTuple):
    """Numbers from `first` up to and without `end`."""

    first: int
    end: int


def reserve(connection: Connection, zone: str, name: str = AVATARS, count: int = BLOCK) -> Block:
    """Reserve the next numbers within a write of the store; they are ours once it is committed."""
    chosen = (RESERVED.c.zone == zone, RESERVED.c.name == name)
    until = connection.execute(select(RESERVED.c.until).where(*chosen)).scalar()
    first = 1 if until is None else int(until)
    values = {"zone": zone, "name": name, "until": first + count}
    if until is None:
        connection.execute(insert(RESERVED).values(values))
    else:
        connection.execute(update(RESERVED).where(*chosen).values(until=first + count))
    return Block(first, first + count)

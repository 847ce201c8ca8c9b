"""Numbers that are given away once: reserved durably in blocks, before any of a block is used."""

from collections import deque
from typing import Final, NamedTuple

from sqlalchemy import Connection, insert, select, update

from esplanade.server.store.tables import RESERVED

BLOCK: Final = 4096
AVATARS: Final = "avatars"


class Block(NamedTuple):
    """Numbers from `first` up to and without `end`."""

    first: int
    end: int


class Numbers:
    """Numbers of blocks that were reserved, each of which is given once."""

    def __init__(self) -> None:
        self._blocks: deque[Block] = deque()

    @property
    def left(self) -> int:
        """Count of the numbers that were not given yet."""
        return sum(block.end - block.first for block in self._blocks)

    def add(self, block: Block) -> None:
        """Take in a block once its reservation is committed."""
        self._blocks.append(block)

    def take(self) -> int | None:
        """The next number; None if all were given."""
        if not self._blocks:
            return None
        first, end = self._blocks.popleft()
        if first + 1 < end:
            self._blocks.appendleft(Block(first + 1, end))
        return first


def reserve(
    connection: Connection, zone: str, name: str = AVATARS, count: int = BLOCK, above: int = 0
) -> Block:
    """Reserve the next numbers within a write of the store; they are ours once it is committed.

    All of them are greater than `above`, the greatest that is in use already.
    """
    chosen = (RESERVED.c.zone == zone, RESERVED.c.name == name)
    until = connection.execute(select(RESERVED.c.until).where(*chosen)).scalar()
    first = max(1 if until is None else int(until), above + 1)
    values = {"zone": zone, "name": name, "until": first + count}
    if until is None:
        connection.execute(insert(RESERVED).values(values))
    else:
        connection.execute(update(RESERVED).where(*chosen).values(until=first + count))
    return Block(first, first + count)

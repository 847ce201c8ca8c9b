"""Surroundings of a zone in a world of several: what it shares with the others, and its exits."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

from esplanade.planning import Portal
from esplanade.server.checkpoint.ids import Block
from esplanade.server.net.departures import Go
from esplanade.server.net.names import Names

IDS_OF_A_ZONE: Final = 2**22
"""Avatars that can come into being in one zone of a world."""
MOST_NUMBERS: Final = 2**32 // IDS_OF_A_ZONE - 1
"""Zones that can be made while a server runs, those that take the place of others included."""
LINES_OF_A_ZONE: Final = 2**42
"""Numbers of lines of a zone, counted from the milliseconds of the start: enough for a century."""


@dataclass(frozen=True)
class Surroundings:
    """The surroundings of a zone in a world of several."""

    number: int
    """The number of the zone among all that were made for its world, from 0 on."""
    names: Names
    """The names of people, of whom no two in the world look alike."""
    portals: Sequence[Portal]
    go: Go

    @property
    def ids(self) -> Block:
        """Ids of avatars that come into being here. They are other ones in each zone, so that
        people keep theirs wherever they go."""
        first = self.number * IDS_OF_A_ZONE + 1
        return Block(first, first + IDS_OF_A_ZONE)

    @property
    def first_line(self) -> int:
        """Added to the number of the first line of chat, so that no two zones have the same."""
        return self.number * LINES_OF_A_ZONE

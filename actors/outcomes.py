"""The outcomes of trips: how each ended, and who or what is in the way."""

from __future__ import annotations

from collections.abc import Hashable
from enum import IntEnum
from typing import Literal, NamedTuple


class Outcome(IntEnum):
    """How a trip ended."""

    ARRIVED = 1
    """The actor is at its goal."""
    NEAR = 2
    """Somebody is at the goal; the actor is beside it, or in a queue for it."""
    BLOCKED = 3
    """A way leads there, but somebody stood in it for longer than the actor's patience."""
    NO_WAY = 4
    """No way leads there."""


Kind = Literal["person", "actor", "door", "wall"]


class InTheWay(NamedTuple):
    """The person, actor, door or wall for which a trip did not end at its goal."""

    kind: Kind
    id: Hashable = None
    """The id of the person or the actor, or the name of the door."""

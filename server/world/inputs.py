"""Inputs are everything that may happen to a world from outside; a list per tick replays it."""

from dataclasses import dataclass

from esplanade.actors.potential_pool import RenewedPotential
from esplanade.planning.grid.door_change import DoorChange
from esplanade.server.world.routes import Point, Route


@dataclass(frozen=True, slots=True)
class Join:
    """A new person joins. `ticket` is the caller's mark, and comes back with the avatar's id."""

    ticket: int
    name: str
    at: Point | None
    """The wished place x, y and height, metres; None for any spawn point."""
    anywhere: bool = True
    """Whether the wished place itself is given; otherwise the spawn point nearest to it is."""


@dataclass(frozen=True, slots=True)
class Attach:
    """Somebody looks through this person's eyes again, knowing nothing of the world.

    `ticket` is the caller's mark, and comes back in the frame.
    """

    id: int
    ticket: int = 0


@dataclass(frozen=True, slots=True)
class Detach:
    """The client of this person looks no more; the avatar stands still where it is."""

    id: int


@dataclass(frozen=True, slots=True)
class Leave:
    """The avatar goes out of the world."""

    id: int


@dataclass(frozen=True, slots=True)
class Stand:
    """The avatar stands still where it is: its client has fallen silent."""

    id: int


@dataclass(frozen=True, slots=True)
class Steer:
    """Walk in a direction (radians from +x) until told otherwise."""

    id: int
    seq: int
    direction_rad: float
    speed_mps: float


@dataclass(frozen=True, slots=True)
class Follow:
    """Walk along a route that was found, to its end."""

    id: int
    seq: int
    route: Route


@dataclass(frozen=True, slots=True)
class MoveDoor:
    """Open or close a door, once nobody stands in its way."""

    name: str
    is_open: bool


@dataclass(frozen=True, slots=True)
class Say:
    """A person says a line."""

    id: int
    text: str


@dataclass(frozen=True, slots=True)
class Watch:
    """A person wants the plans of an actor from now on, or of none."""

    id: int
    actor_id: int | None


@dataclass(frozen=True, slots=True)
class DoorDerived:
    """The changes that a door makes to the ground are derived: it moves, if it still may."""

    change: DoorChange


@dataclass(frozen=True, slots=True)
class PotentialDerived:
    """The potential of a goal is derived anew, since the ground has changed."""

    potential: RenewedPotential


Movement = Steer | Follow
OfPerson = Attach | Detach | Leave | Stand | Steer | Follow | Say | Watch
"""Inputs of one avatar, by its `id`."""
GroundInput = DoorDerived | PotentialDerived
Input = Join | MoveDoor | OfPerson | GroundInput

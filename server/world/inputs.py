"""What may happen to a world from outside. A recorded list of these per tick replays the world."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Join:
    """A new person. `ticket` is the caller's mark, it comes back with the avatar's id."""

    ticket: int
    name: str
    at: tuple[float, float, int] | None
    """Wished place x, y (metres) and layer; None for a spawn point."""


@dataclass(frozen=True, slots=True)
class Attach:
    """Somebody looks through this person's eyes again, knowing nothing of the world."""

    id: int


@dataclass(frozen=True, slots=True)
class Detach:
    """Nobody looks any more; the avatar stands still where it is."""

    id: int


@dataclass(frozen=True, slots=True)
class Leave:
    """The avatar goes out of the world."""

    id: int


@dataclass(frozen=True, slots=True)
class Steer:
    """Walk in a direction (radians from +x) until told otherwise."""

    id: int
    seq: int
    direction_rad: float
    speed_mps: float


@dataclass(frozen=True, slots=True)
class Seek:
    """Walk to a point around what stands in the way."""

    id: int
    seq: int
    goal: tuple[float, float]
    layer: int


Movement = Steer | Seek
Input = Join | Attach | Detach | Leave | Steer | Seek

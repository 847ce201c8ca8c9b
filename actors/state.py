"""The state of one actor after a tick, for those who ask about one."""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.outcomes import InTheWay, Outcome


class Reason(IntEnum):
    """Why an actor does what it does."""

    NONE = 0
    MOVING = 1
    GIVING_WAY = 2
    WAITING = 3
    REPLANNING = 4
    NO_PATH = 5
    ARRIVED = 6


class ActorState(NamedTuple):
    """One actor after a tick: metres, metres a second, radians from +x."""

    position: tuple[float, float]
    layer: int
    z_m: float
    """Height of the floor it stands on."""
    velocity: tuple[float, float]
    heading: float
    reason: Reason
    goal: tuple[float, float, float] | None
    slice_s: float
    way: NDArray[np.float64]
    """(K, 3): planned positions and heights, `slice_s` apart, the first at the beginning of the
    tick."""
    points_at: tuple[float, float, float] | None = None
    """The place that it shows to people, if it explains something."""
    outcome: Outcome | None = None
    """How its trip ended; None while it goes on, and without a goal."""
    in_the_way: InTheWay | None = None
    """The person, actor, door or wall for which the trip did not end at the goal."""

    @property
    def path(self) -> NDArray[np.float64]:
        """The plan as float64 (K, 4): x, y, z, seconds from the beginning of the tick."""
        out = np.empty((len(self.way), 4))
        out[:, :3] = self.way
        out[:, 3] = np.arange(len(self.way)) * self.slice_s
        return out

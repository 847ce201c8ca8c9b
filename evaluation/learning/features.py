"""The numbers that a learner sees, and the velocity that its action means.

Both are in the frame of a robot whose x axis points at its waypoint, so that what is learned holds
for every direction. A policy of one's own makes them of its observation by `features_of`.
"""

from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

OWN: Final = 6
"""Numbers about the robot itself."""
EACH: Final = 5
"""Numbers about each person."""
REACH_M: Final = 10.0
"""Greater distances count as this."""
SPEED_MPS: Final = 3.0
"""Greater parts of velocities count as this."""


@dataclass(frozen=True)
class Frame:
    """The axes of a robot: `ahead` (2,) is the unit vector to its waypoint."""

    ahead: Floats

    @classmethod
    def of(cls, position: Floats, waypoint: Floats) -> "Frame":
        """The frame at a position (2,); at the waypoint itself it is that of the world."""
        offset = waypoint - position
        length_m = float(np.hypot(*offset))
        return cls(offset / length_m if length_m > 1e-9 else np.array([1.0, 0.0]))

    def inward(self, vectors: Floats) -> Floats:
        """Vectors (..., 2) of the world in this frame."""
        x, y = self.ahead
        return np.asarray(vectors @ np.array([[x, -y], [y, x]]))

    def outward(self, vectors: Floats) -> Floats:
        """Vectors (..., 2) of this frame in the world."""
        x, y = self.ahead
        return np.asarray(vectors @ np.array([[x, y], [-y, x]]))


def size_of(nearest: int) -> int:
    """The length of the features with so many people."""
    return OWN + EACH * nearest


def features(
    position: Floats,
    velocity: Floats,
    waypoint: Floats,
    goal: Floats,
    walls: Floats,
    places: Floats,
    velocities: Floats,
    nearest: int,
) -> NDArray[np.float32]:
    """The numbers that a robot sees, float32 (6 + 5 × `nearest`,), each from -1 to 1.

    Parameters
    ----------
    position, velocity, waypoint, goal : (2,), metres and m/s
    walls : (M, 2, 2), metres
        From end to end.
    places, velocities : (P, 2), metres and m/s
        Those of people.

    Notes
    -----
    They are the distances to the goal and to the waypoint, the own velocity (2), the offset of the
    nearest point of a wall (2); then of each of the `nearest` people, the nearest first, 1, the
    offset (2) and the velocity (2); zeros where there are fewer. Distances are parts of `REACH_M`,
    velocities of `SPEED_MPS`.
    """
    frame = Frame.of(position, waypoint)
    found = np.zeros(size_of(nearest))
    found[0] = np.hypot(*(goal - position)) / REACH_M
    found[1] = np.hypot(*(waypoint - position)) / REACH_M
    found[2:4] = frame.inward(velocity) / SPEED_MPS
    found[4:6] = frame.inward(_to_wall(position, walls)) / REACH_M
    offsets = places - position
    away = np.einsum("ij,ij->i", offsets, offsets)
    chosen = np.argsort(away, kind="stable")[:nearest]
    chosen = chosen[away[chosen] < REACH_M**2]
    rows = found[OWN:].reshape(nearest, EACH)[: len(chosen)]
    rows[:, 0] = 1.0
    rows[:, 1:3] = frame.inward(offsets[chosen]) / REACH_M
    rows[:, 3:5] = frame.inward(velocities[chosen]) / SPEED_MPS
    return np.clip(found, -1.0, 1.0).astype(np.float32)


def features_of(observation: Any, walls: Floats, nearest: int) -> NDArray[np.float32]:
    """The features of an observation, as `--policy` gives it, among the walls of its task."""
    people = observation.people
    return features(
        observation.position,
        observation.velocity,
        observation.waypoint,
        observation.goal,
        walls,
        np.array([person.position for person in people]).reshape(-1, 2),
        np.array([person.velocity for person in people]).reshape(-1, 2),
        nearest,
    )


def velocity_of(
    action: NDArray[np.floating[Any]], position: Floats, waypoint: Floats, most_mps: float
) -> Floats:
    """The velocity (2,) of the world that an action (2,) means: parts of the greatest speed."""
    return Frame.of(position, waypoint).outward(np.asarray(action, dtype=np.float64)) * most_mps


def _to_wall(position: Floats, walls: Floats) -> Floats:
    """The offset (2,) of the nearest point of a wall; `REACH_M` each way if there is none."""
    if not len(walls):
        return np.full(2, REACH_M)
    along = walls[:, 1] - walls[:, 0]
    offsets = walls[:, 0] - position
    squares = np.maximum(np.einsum("ij,ij->i", along, along), 1e-12)
    parts = np.clip(-np.einsum("ij,ij->i", offsets, along) / squares, 0.0, 1.0)
    nearest = offsets + parts[:, None] * along
    return np.asarray(nearest[np.einsum("ij,ij->i", nearest, nearest).argmin()])

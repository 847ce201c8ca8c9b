"""Where people who follow routes will be: places along the next corners, not straight on."""

from collections.abc import Sequence
from typing import Any, Final

import numpy as np

from esplanade.actors.locomotion.footsteps.course import AHEAD, AHEAD_S
from esplanade.server.world.routes import Point
from esplanade.server.world.state import Floats, Slots

CORNERS: Final = 16
"""Around an obstacle legs are some 0.2 m long, and people look 1.2 s ahead."""


class RouteAhead:
    """The next corners of everyone's route, by slot.

    Feet land where the body will be. If a course led straight on past a corner, every corner would
    aim the step under way anew; around an obstacle it would never land.
    """

    def __init__(self, capacity: int) -> None:
        self._corners = np.zeros((capacity, CORNERS, 2))

    def set(self, slot: int, corners: Sequence[Point]) -> None:
        """Take the corners that are left of a route, of which there is one at least."""
        row = self._corners[slot]
        row[:] = corners[-1][:2]
        nearest = corners[:CORNERS]
        row[: len(nearest)] = [corner[:2] for corner in nearest]

    def save(self, slots: Sequence[int]) -> np.ndarray[Any, Any]:
        """The next corners of these slots, (N, CORNERS, 2); a copy."""
        return self._corners[list(slots)]

    def load(self, slots: Sequence[int], corners: Any) -> None:
        """Take the corners that were saved, in the order of slots.

        Raises
        ------
        ValueError
            They are of another shape, or not finite.
        """
        rows = np.asarray(corners, dtype=np.float64)
        if rows.shape != (len(slots), CORNERS, 2) or not np.isfinite(rows).all():
            raise ValueError(f"{len(slots)} routes cannot have such corners")
        self._corners[list(slots)] = rows

    def places(self, slots: Slots, here: Floats, speeds_mps: Floats) -> Floats:
        """Places (N, AHEAD, 2) of people at `here` (N, 2), from now on, AHEAD_S apart, metres."""
        points = np.concatenate([here[:, None], self._corners[slots]], axis=1)
        ways = np.diff(points, axis=1)
        legs_m = np.hypot(ways[..., 0], ways[..., 1])
        ends_m = np.cumsum(legs_m, axis=1)
        along_m = AHEAD_S * np.arange(AHEAD) * speeds_mps[:, None]
        leg = (ends_m[:, None, :] < along_m[:, :, None]).sum(axis=2)
        leg = np.minimum(leg, CORNERS - 1)
        rows = np.arange(len(slots))[:, None]
        length_m = legs_m[rows, leg]
        gone_m = along_m - (ends_m[rows, leg] - length_m)
        share = np.clip(gone_m / np.maximum(length_m, 1e-9), 0.0, 1.0)
        found: Floats = points[rows, leg] + share[..., None] * ways[rows, leg]
        return found

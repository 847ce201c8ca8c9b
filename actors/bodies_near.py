"""Everybody's bodies at a tick, people and actors alike, for rules that look at all of them."""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from typing import Final, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.scene.heights import SAME_FLOOR_M

ASIDE_M: Final = 0.3
"""A body that is beside the way by no more than this and both radii stands in it."""


class Bodies(NamedTuple):
    """N bodies, first the people and then the actors in the order of their table."""

    places: NDArray[np.float64]
    """(N, 3): where the feet are, metres."""
    radii: NDArray[np.float64]
    """(N,), metres."""
    people: Sequence[Hashable]
    """The ids of the people."""
    actors: Sequence[Hashable]

    def who(self, k: int) -> tuple[Literal["person", "actor"], Hashable]:
        """The kind and the id of one of them."""
        people = len(self.people)
        return ("person", self.people[k]) if k < people else ("actor", self.actors[k - people])


def nearest_on_way(
    bodies: Bodies, own: int, ahead: NDArray[np.float64] | None, within_m: float
) -> tuple[int, float] | None:
    """The nearest body on the way of one of them, and the metres between the two; None if none is.

    The way is a line `ahead`, (2,) from where that one is; without one everybody around counts.
    """
    here = bodies.places[own]
    offsets = bodies.places[:, :2] - here[:2]
    reach_m = bodies.radii + bodies.radii[own]
    away_m = np.hypot(offsets[:, 0], offsets[:, 1]) - reach_m
    away_m[own] = np.inf
    near = (away_m <= within_m) & (np.abs(bodies.places[:, 2] - here[2]) < SAME_FLOOR_M)
    if ahead is not None and (length := float(np.hypot(*ahead))):
        along = offsets @ ahead / length
        aside = np.abs(offsets[:, 0] * ahead[1] - offsets[:, 1] * ahead[0]) / length
        near &= (along > -reach_m) & (aside <= reach_m + ASIDE_M)
    if not near.any():
        return None
    first = int(np.where(near, away_m, np.inf).argmin())
    return first, float(away_m[first])

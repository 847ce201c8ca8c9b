"""Contacts of actors with people as one client sees them, and by whose doing they come about."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.scene.heights import BODIES_OVERLAP_M

Floats = NDArray[np.float64]

BEFORE_S: Final = 1.0
"""A contact is judged by what the two did for so long before."""
ROUNDING_M: Final = 0.01
"""Bodies touch that are nearer by this than they may be, and part when further by this: places are
rounded to a centimetre."""


class SeenBody(NamedTuple):
    """A body that a client has seen come into view."""

    is_actor: bool
    radius_m: float


@dataclass(frozen=True)
class ContactCauses:
    """The contacts of actors with people that were seen, by what would have been without a move.

    A contact may count twice, where either alone would have brought it about, and not at all, where
    it took both.
    """

    seen: int = 0
    actor_stood: int = 0
    """The actor stood or moved away from the person all the time before."""
    by_person_alone: int = 0
    """It would have come about if the actor had stood all the time before."""
    by_actor_alone: int = 0
    """It would have come about if the person had stood all the time before."""
    mostly_by_person: int = 0
    """The person's moves brought the two nearer to each other than the actor's."""

    def figures(self) -> dict[str, int]:
        """The figures by their names."""
        return {
            "contacts_seen": self.seen,
            "contacts_actor_stood": self.actor_stood,
            "contacts_by_person_alone": self.by_person_alone,
            "contacts_by_actor_alone": self.by_actor_alone,
            "contacts_mostly_by_person": self.mostly_by_person,
        }


def contact_causes(seen: Floats, bodies: Mapping[int, SeenBody], tick_s: float) -> ContactCauses:
    """Judge the contacts in what a client was sent.

    Parameters
    ----------
    seen : float64 (N, 5)
        Rows of tick, id, x, y and z, metres, of the avatars that moved in each tick.
    bodies : by id
        Whoever is not in it is left out.
    tick_s : seconds

    Notes
    -----
    Contacts of less than a centimetre are not seen. Others are seen by the client alone, which is
    told of some moves a tick late. Cost O(ticks) for each pair of an actor and a person.
    """
    ids = [int(one) for one in np.unique(seen[:, 1]) if int(one) in bodies]
    first, last = int(seen[:, 0].min()), int(seen[:, 0].max())
    tracks = {one: _track(seen[seen[:, 1] == one], first, last) for one in ids}
    before = max(1, round(BEFORE_S / tick_s))
    found = np.zeros(5, dtype=np.int64)
    for actor in (one for one in ids if bodies[one].is_actor):
        for person in (one for one in ids if not bodies[one].is_actor):
            reach_m = bodies[actor].radius_m + bodies[person].radius_m
            found += _judged(tracks[actor], tracks[person], reach_m, before)
    return ContactCauses(*found.tolist())


def _track(rows: Floats, first: int, last: int) -> Floats:
    """The places (T, 3) of an avatar in all ticks; nan before it was first seen."""
    track = np.full((last - first + 1, 3), np.nan)
    rows = rows[np.argsort(rows[:, 0], kind="stable")]
    ticks = rows[:, 0].astype(np.int64) - first
    latest = np.searchsorted(ticks, np.arange(len(track)), side="right") - 1
    known = latest >= 0
    track[known] = rows[latest[known], 2:]
    return track


def _judged(actor: Floats, person: Floats, reach_m: float, before: int) -> NDArray[np.int64]:
    """The counts of `ContactCauses` for two tracks (T, 3), int64 (5,)."""
    found = np.zeros(5, dtype=np.int64)
    apart = np.hypot(*(actor - person)[:, :2].T)
    apart[np.abs(actor[:, 2] - person[:, 2]) >= BODIES_OVERLAP_M] = np.inf
    for tick in _begins(apart, reach_m):
        begin = max(0, tick - before)
        while np.isnan(apart[begin]) or apart[begin] < reach_m:
            begin += 1
        a, p = actor[begin : tick + 1, :2], person[begin : tick + 1, :2]
        by_actor_m, by_person_m = _approach_m(a, p), _approach_m(p, a)
        found += (
            1,
            by_actor_m <= 0.0,
            np.hypot(*(p - a[0]).T).min() < reach_m,
            np.hypot(*(a - p[0]).T).min() < reach_m,
            by_person_m > by_actor_m,
        )
    return found


def _begins(apart: Floats, reach_m: float) -> list[int]:
    """The ticks in which two begin to touch that are so far apart (T,); not the first one seen."""
    begins, touch = [], True
    for tick in np.flatnonzero(np.isfinite(apart)).tolist():
        if touch and apart[tick] > reach_m + ROUNDING_M:
            touch = False
        elif not touch and apart[tick] < reach_m - ROUNDING_M:
            touch = True
            begins.append(tick)
    return begins


def _approach_m(one: Floats, other: Floats) -> float:
    """Metres that one came nearer to the other by moves of its own, along tracks (K, 2)."""
    toward = other[:-1] - one[:-1]
    toward /= np.maximum(np.hypot(*toward.T), 1e-9)[:, None]
    return float((np.diff(one, axis=0) * toward).sum())

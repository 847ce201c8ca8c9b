"""Limits of the distances of feet and bodies, so that legs reach and do not cross."""

from __future__ import annotations

from typing import Final

import numpy as np

from esplanade.actors.locomotion.body.skeleton import TRACK_HALF_WIDTH
from esplanade.actors.locomotion.planted.footprints import HEADING, ON_MAP
from esplanade.planning.compiled.arrays import Floats
from tests.naive.headings import forward_and_left

# Lengths in legs.
PAST_STANDING: Final = 0.5
"""A step takes the body no further from its standing foot."""
PAST_TOE: Final = 0.1
"""It may get further by this where the toe points, because the foot can rise on its toe."""
BEHIND_LANDING: Final = 0.54
"""A step leaves the body no further from the landing foot."""

LONGEST_WALK: Final = 0.68
"""Longest step that is walked."""

_FURTHEST_AHEAD: Final = 0.86
_FURTHEST_BACK: Final = 0.55
_FURTHEST_ASIDE: Final = 0.55
_NEAREST_ASIDE: Final = 1.1 * TRACK_HALF_WIDTH
"""A swing foot keeps this far to its own side of the standing foot as it passes."""


def longest_step(legs_a_second: Floats) -> Floats:
    """Longest steps at speeds, leg lengths: from that of a walk to that of a run."""
    faster = np.clip((legs_a_second - 2.2) / (2.9 - 2.2), 0.0, 1.0)
    return np.asarray(LONGEST_WALK + (1.15 - LONGEST_WALK) * faster)


def distance_and_limit(
    places: Floats, standing: Floats, legs_a_second: Floats
) -> tuple[Floats, Floats]:
    """Distances of bodies from their standing feet, and how large they may be.

    Parameters
    ----------
    places : float64 (N, 2), metres
    standing : float64 (N, 4), footprints
    legs_a_second : float64 (N,), speeds

    Returns
    -------
    float64 (N,), metres, and float64 (N,), leg lengths
    """
    apart = places - standing[:, ON_MAP]
    distance = np.hypot(apart[:, 0], apart[:, 1])
    toe = forward_and_left(standing[:, HEADING])[0]
    ahead = np.einsum("nd,nd->n", apart, toe) / np.maximum(distance, 1e-9)
    more = PAST_TOE + longest_step(legs_a_second) - LONGEST_WALK
    return distance, PAST_STANDING + more * np.maximum(ahead, 0.0)


def clamped_foot(
    points: Floats,
    standing: Floats,
    middle: Floats,
    side: Floats,
    longest: Floats,
    leg_m: Floats,
) -> Floats:
    """The nearest places for swing feet that are on their own side and within reach.

    Parameters
    ----------
    points : float64 (N, 2), metres
    standing : float64 (N, 4), footprints of the other feet
    middle : float64 (N,), radians
        Headings midway between both feet.
    side : float64 (N,)
        1 where the swing foot is the left one, else -1.
    longest : float64 (N,), longest steps, leg lengths
    leg_m : float64 (N,), metres

    Returns
    -------
    float64 (N, 2), metres
    """
    forward, left = forward_and_left(middle)
    apart = points - standing[:, ON_MAP]
    furthest = (_FURTHEST_AHEAD + longest - LONGEST_WALK) * leg_m
    ahead = np.clip(np.einsum("nd,nd->n", apart, forward), -_FURTHEST_BACK * leg_m, furthest)
    aside = np.clip(
        side * np.einsum("nd,nd->n", apart, left),
        _NEAREST_ASIDE * leg_m,
        _FURTHEST_ASIDE * leg_m,
    )
    return np.asarray(
        standing[:, ON_MAP] + ahead[:, None] * forward + (side * aside)[:, None] * left
    )


def clamped_distance(points: Floats, origin: Floats, limit_m: Floats) -> Floats:
    """Points (N, 2) moved towards origins (N, 2) until they are within limits (N,); metres."""
    apart = points - origin
    distance = np.maximum(np.hypot(apart[:, 0], apart[:, 1]), 1e-9)
    return np.asarray(origin + apart * (np.minimum(distance, limit_m) / distance)[:, None])

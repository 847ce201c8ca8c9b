"""Openings in recorded walls where recorded people walked through them.

The walls of public recordings were drawn by hand over the video. Therefore somebody sometimes
cuts a corner, leans into a facade or walks in at a door that was drawn shut. A replay of these
people among these walls needs openings there.
"""

from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from esplanade.recordings.crowd import Crowd, Floats
from esplanade.recordings.walls import Wall

MIN_REST_M: Final = 0.05
"""Pieces of wall between two openings are left out if they are shorter than this."""


def open_doorways(walls: Sequence[Wall], crowd: Crowd, width_m: float) -> list[Wall]:
    """Cut out the parts of walls that obstruct the paths of recorded pedestrians.

    A wall keeps every part that is at least half of `width_m` from all recorded paths, so that a
    disc of that diameter can follow each of them. Walls far from all paths do not change.

    Parameters
    ----------
    walls : straight walls, metres
    crowd : the recorded pedestrians; between samples their paths are straight
    width_m : the width of the corridor around each path, metres

    Returns
    -------
    The walls in their order, each replaced by its remaining pieces.

    Raises
    ------
    ValueError
        `width_m` is not positive and finite.

    Notes
    -----
    The corridor around one straight piece of a path is a capsule. It is convex, so it cuts at
    most one interval out of a wall. The cost is O(walls x samples).
    """
    if not (np.isfinite(width_m) and width_m > 0.0):
        raise ValueError(f"width_m is {width_m}, expected a positive number of metres")
    starts, ends = _pieces(crowd)
    opened: list[Wall] = []
    for wall in walls:
        opened.extend(_remaining_pieces(wall, starts, ends, width_m / 2.0))
    return opened


def _pieces(crowd: Crowd) -> tuple[Floats, Floats]:
    """The starts and ends, each (N, 2), metres, of the straight pieces of all paths.

    A track with a single sample gives a piece of length 0.
    """
    starts = [t.positions[:-1] if len(t.times) > 1 else t.positions for t in crowd.tracks]
    ends = [t.positions[1:] if len(t.times) > 1 else t.positions for t in crowd.tracks]
    return np.concatenate(starts), np.concatenate(ends)


def _remaining_pieces(wall: Wall, starts: Floats, ends: Floats, radius_m: float) -> Iterator[Wall]:
    """The pieces of a wall that are not near any piece of a path."""
    origin = np.array(wall[0])
    span = np.array(wall[1]) - origin
    length_m = float(np.hypot(*span))
    along = span / length_m
    near = _capsule_intervals(starts - origin, ends - origin, along, radius_m)
    near = near[(near[:, 1] > 0.0) & (near[:, 0] < length_m)]
    if not len(near):
        yield wall
        return
    reached_m = 0.0
    for low_m, high_m in [*sorted(near.tolist()), (length_m, length_m)]:
        if low_m - reached_m >= MIN_REST_M:
            yield _point(origin, along, reached_m), _point(origin, along, low_m)
        reached_m = max(reached_m, high_m)


def _point(origin: Floats, along: Floats, distance_m: float) -> tuple[float, float]:
    x, y = origin + distance_m * along
    return float(x), float(y)


def _capsule_intervals(starts: Floats, ends: Floats, along: Floats, radius_m: float) -> Floats:
    """The intervals of a line through the origin that are inside the capsules around N pieces.

    Parameters
    ----------
    starts, ends : float64 (N, 2), metres, relative to the origin of the line
    along : float64 (2,), the unit vector of the line
    radius_m : metres

    Returns
    -------
    float64 (M, 2), M <= N: the ends of the intervals, metres along the line, of the M capsules
    that the line meets.
    """
    low = np.full(len(starts), np.inf)
    high = np.full(len(starts), -np.inf)
    for centres in (starts, ends):
        middle = centres @ along
        aside = np.hypot(*(centres - middle[:, None] * along).T)
        half = np.sqrt(np.maximum(radius_m**2 - aside**2, 0.0))
        inside = aside < radius_m
        low = np.where(inside, np.minimum(low, middle - half), low)
        high = np.where(inside, np.maximum(high, middle + half), high)
    slab_low, slab_high = _rectangle_intervals(starts, ends, along, radius_m)
    inside = slab_low < slab_high
    low = np.where(inside, np.minimum(low, slab_low), low)
    high = np.where(inside, np.maximum(high, slab_high), high)
    met = low < high
    return np.stack([low[met], high[met]], axis=1)


def _rectangle_intervals(
    starts: Floats, ends: Floats, along: Floats, radius_m: float
) -> tuple[Floats, Floats]:
    """The ends of the intervals inside the rectangles of the capsules, each (N,).

    The first end is not less than the second one where the line misses a rectangle.
    """
    spans = ends - starts
    lengths = np.hypot(*spans.T)
    forward = spans / np.where(lengths > 0.0, lengths, 1.0)[:, None]
    sideward = np.stack([-forward[:, 1], forward[:, 0]], axis=1)
    low = np.full(len(starts), -np.inf)
    high = np.full(len(starts), np.inf)
    for axis, least, most in ((forward, 0.0, lengths), (sideward, -radius_m, radius_m)):
        offset = -np.einsum("ij,ij->i", starts, axis)
        slope = axis @ along
        parallel = np.abs(slope) < 1e-12
        safe = np.where(parallel, 1.0, slope)
        one, other = (least - offset) / safe, (most - offset) / safe
        outside = parallel & ((offset < least) | (offset > most))
        low = np.maximum(low, np.where(parallel, -np.inf, np.minimum(one, other)))
        high = np.minimum(high, np.where(parallel, np.inf, np.maximum(one, other)))
        high = np.where(outside, -np.inf, high)
    # A piece of length 0 has no rectangle, and the discs at its ends cover its capsule.
    return low, np.where(lengths > 0.0, high, -np.inf)

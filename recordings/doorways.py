"""Openings in recorded walls where the recorded people went through them.

The walls of public recordings were drawn by hand over the video, so that now and then somebody
cuts a corner, leans into a facade or walks in at a door that was drawn shut. Who replays the
people among those walls needs the way free.
"""

from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from esplanade.recordings.crowd import Crowd, Floats
from esplanade.recordings.walls import Wall

MIN_REST_M: Final = 0.05
"""A piece of wall shorter than this, left over between two openings, is left out."""


def open_doorways(walls: Sequence[Wall], crowd: Crowd, width_m: float) -> list[Wall]:
    """Walls without the stretches that stand in some recorded pedestrian's way.

    A wall keeps every part that is at least half of `width_m` from all recorded paths, so that a
    disc of that diameter can follow each of them. A wall that nobody comes near is the same as
    before.

    Parameters
    ----------
    walls : straight walls, metres
    crowd : whose tracks stay free; between samples a track is straight
    width_m : diameter of the corridor around each track, metres

    Returns
    -------
    Walls in their order, each replaced by what is left of it.

    Raises
    ------
    ValueError
        `width_m` is not positive and finite.

    Notes
    -----
    The corridor around one straight piece of a path is a capsule, which is convex: it cuts at
    most one stretch out of a wall. Cost O(walls x samples).
    """
    if not (np.isfinite(width_m) and width_m > 0.0):
        raise ValueError(f"width_m is {width_m}, expected a positive number of metres")
    starts, ends = _pieces(crowd)
    opened: list[Wall] = []
    for wall in walls:
        opened.extend(_rest_of(wall, starts, ends, width_m / 2.0))
    return opened


def _pieces(crowd: Crowd) -> tuple[Floats, Floats]:
    """Starts and ends, each (N, 2), of the straight pieces of all paths.

    A track of a single sample is a piece without length.
    """
    starts = [t.positions[:-1] if len(t.times) > 1 else t.positions for t in crowd.tracks]
    ends = [t.positions[1:] if len(t.times) > 1 else t.positions for t in crowd.tracks]
    return np.concatenate(starts), np.concatenate(ends)


def _rest_of(wall: Wall, starts: Floats, ends: Floats, radius_m: float) -> Iterator[Wall]:
    """What is left of a wall once the stretches near any piece are out of it."""
    origin = np.array(wall[0])
    span = np.array(wall[1]) - origin
    length_m = float(np.hypot(*span))
    along = span / length_m
    near = _stretches(starts - origin, ends - origin, along, radius_m)
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


def _stretches(starts: Floats, ends: Floats, along: Floats, radius_m: float) -> Floats:
    """Where a line through the origin runs inside the capsules around N pieces.

    Parameters
    ----------
    starts, ends : float64 (N, 2), metres, relative to the line's origin
    along : float64 (2,), the line's unit direction
    radius_m : metres

    Returns
    -------
    float64 (M, 2), M <= N: from and to, metres along the line, of the capsules that it meets.
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
    slab_low, slab_high = _rectangle_stretches(starts, ends, along, radius_m)
    inside = slab_low < slab_high
    low = np.where(inside, np.minimum(low, slab_low), low)
    high = np.where(inside, np.maximum(high, slab_high), high)
    met = low < high
    return np.stack([low[met], high[met]], axis=1)


def _rectangle_stretches(
    starts: Floats, ends: Floats, along: Floats, radius_m: float
) -> tuple[Floats, Floats]:
    """From and to of the line inside the capsules' rectangles; from >= to where it misses."""
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
    # A piece without length has no rectangle: its two discs say it all.
    return low, np.where(lengths > 0.0, high, -np.inf)

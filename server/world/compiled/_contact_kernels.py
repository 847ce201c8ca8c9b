"""The bodies that touched during a tick: only those in neighbouring buckets are looked at."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.arrays import Floats, Ints
from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.scene.heights import BODIES_OVERLAP_M

_ID_BITS = 32
"""A pair is packed as the first id times 2 to the power of this, plus the second id."""
_FAST_M = 1.0
"""Bodies that move further than this in a tick are few; they are held against everyone."""
_BUCKETS_A_BODY = 2.0


class Bodies(NamedTuple):
    """Bodies by slot, as in `State`."""

    ids: Ints
    kinds: NDArray[np.uint8]
    positions: Floats
    before: Floats
    heights: Floats
    radii: Floats


class Buckets(NamedTuple):
    """N bodies by their places on the map."""

    first: Ints
    """(nx * ny + 1,): the place of the first member of each bucket, row by row."""
    members: Ints
    """(N,): slots."""
    columns: Ints
    """(N,): the column of each of the bodies, in the order they were given in."""
    rows: Ints
    nx: int
    ny: int


class Touching(NamedTuple):
    """The pairs that touched in a tick."""

    pairs: Ints
    """(P,): packed, ascending."""
    new_with_people: int
    """The number of pairs of an actor and a person who did not touch in the tick before."""
    new_among_actors: int


@inlined
def _approach(bodies: Bodies, one: int, other: int) -> float:
    """Least distance of two bodies during the tick, both moving straight and evenly, metres."""
    start_x = bodies.before[one, 0] - bodies.before[other, 0]
    start_y = bodies.before[one, 1] - bodies.before[other, 1]
    change_x = bodies.positions[one, 0] - bodies.positions[other, 0] - start_x
    change_y = bodies.positions[one, 1] - bodies.positions[other, 1] - start_y
    square = change_x * change_x + change_y * change_y
    along = -(start_x * change_x + start_y * change_y) / (square if square > 0.0 else 1.0)
    share = min(max(along, 0.0), 1.0)
    return math.hypot(start_x + share * change_x, start_y + share * change_y)


@inlined
def _moved_m(bodies: Bodies, slot: int) -> float:
    return math.hypot(
        bodies.positions[slot, 0] - bodies.before[slot, 0],
        bodies.positions[slot, 1] - bodies.before[slot, 1],
    )


@kernel
def _in_buckets(bodies: Bodies, slots: Ints, reach_m: float) -> Buckets:
    """Bodies in buckets at least `reach_m` wide, of which there are not many more than bodies."""
    count = len(slots)
    x0, y0, x1, y1 = np.inf, np.inf, -np.inf, -np.inf
    for slot in slots:
        x0, x1 = min(x0, bodies.positions[slot, 0]), max(x1, bodies.positions[slot, 0])
        y0, y1 = min(y0, bodies.positions[slot, 1]), max(y1, bodies.positions[slot, 1])
    most = _BUCKETS_A_BODY * count
    width_m = max(reach_m, math.sqrt((x1 - x0) * (y1 - y0) / most), max(x1 - x0, y1 - y0) / most)
    nx, ny = int((x1 - x0) / width_m) + 1, int((y1 - y0) / width_m) + 1
    columns, rows = np.empty(count, np.int64), np.empty(count, np.int64)
    first, members = np.zeros(nx * ny + 1, np.int64), np.empty(count, np.int64)
    for k in range(count):
        columns[k] = min(int((bodies.positions[slots[k], 0] - x0) / width_m), nx - 1)
        rows[k] = min(int((bodies.positions[slots[k], 1] - y0) / width_m), ny - 1)
        first[rows[k] * nx + columns[k] + 1] += 1
    for bucket in range(nx * ny):
        first[bucket + 1] += first[bucket]
    place = first.copy()
    for k in range(count):
        bucket = rows[k] * nx + columns[k]
        members[place[bucket]] = slots[k]
        place[bucket] += 1
    return Buckets(first, members, columns, rows, nx, ny)


@inlined
def _touch(bodies: Bodies, actor: int, other: int) -> bool:
    """Whether two bodies on one level touch during the tick."""
    if abs(bodies.heights[actor] - bodies.heights[other]) >= BODIES_OVERLAP_M:
        return False
    return bool(_approach(bodies, actor, other) < bodies.radii[actor] + bodies.radii[other])


class Found(NamedTuple):
    """The pairs that were found so far, in no order."""

    pairs: Ints
    """(R,): packed; the first `count` of them are valid."""
    counts: Ints
    """(3,): pairs, and of those that did not touch in the tick before the number with people, and
    that among actors."""


@kernel
def _add(found: Found, bodies: Bodies, actor: int, other: int, among: bool, known: Ints) -> Found:
    """Take in one more pair; `known` are those of the tick before."""
    pairs, counts = found
    if counts[0] == len(pairs):
        pairs = np.empty(2 * counts[0], np.int64)
        pairs[: counts[0]] = found.pairs
    pair = (bodies.ids[actor] << _ID_BITS) + bodies.ids[other]
    pairs[counts[0]] = pair
    counts[0] += 1
    place = np.searchsorted(known, pair)
    if place == len(known) or known[place] != pair:
        counts[2 if among else 1] += 1
    return Found(pairs, counts)


@kernel
def _among_slow(
    bodies: Bodies, slots: Ints, buckets: Buckets, kind_actor: int, known: Ints, found: Found
) -> Found:
    """Pairs of which nobody moves far: those in neighbouring buckets."""
    for k in range(len(slots)):
        one = slots[k]
        if bodies.kinds[one] != kind_actor or _moved_m(bodies, one) > _FAST_M:
            continue
        column, row = buckets.columns[k], buckets.rows[k]
        for beside in range(max(row - 1, 0), min(row + 2, buckets.ny)):
            left = beside * buckets.nx + max(column - 1, 0)
            right = beside * buckets.nx + min(column + 1, buckets.nx - 1)
            for m in range(buckets.first[left], buckets.first[right + 1]):
                other = buckets.members[m]
                among = bodies.kinds[other] == kind_actor
                if other == one or (among and other < one):
                    continue
                if _touch(bodies, one, other) and _moved_m(bodies, other) <= _FAST_M:
                    found = _add(found, bodies, one, other, among, known)
    return found


@kernel
def _with_fast(
    bodies: Bodies, slots: Ints, fast: Ints, kind_actor: int, known: Ints, found: Found
) -> Found:
    """Pairs of somebody who moves far and anyone else."""
    for mover in fast:
        for slot in slots:
            if slot == mover or (slot < mover and _moved_m(bodies, slot) > _FAST_M):
                continue
            one, other = min(mover, slot), max(mover, slot)
            if bodies.kinds[one] != kind_actor:
                one, other = other, one
            if bodies.kinds[one] == kind_actor and _touch(bodies, one, other):
                among = bodies.kinds[other] == kind_actor
                found = _add(found, bodies, one, other, among, known)
    return found


@kernel
def find_touching(bodies: Bodies, slots: Ints, kind_actor: int, known: Ints) -> Touching:
    """The pairs of an actor and another body, of those in slots (N,), that touched in this tick.

    `known` are the pairs of the tick before, packed and ascending. Of two actors the one in the
    lower slot comes first. Bodies that move far are held against everyone, all others against
    those in neighbouring buckets.
    """
    widest_m, furthest_m, actors, movers = 0.0, 0.0, 0, 0
    fast = np.empty(len(slots), np.int64)
    for slot in slots:
        widest_m = max(widest_m, bodies.radii[slot])
        if bodies.kinds[slot] == kind_actor:
            actors += 1
        moved_m = _moved_m(bodies, slot)
        if moved_m > _FAST_M:
            fast[movers] = slot
            movers += 1
        else:
            furthest_m = max(furthest_m, moved_m)
    found = Found(np.empty(len(slots) + 1, np.int64), np.zeros(3, np.int64))
    if actors > 0:
        buckets = _in_buckets(bodies, slots, 2.0 * (widest_m + furthest_m))
        found = _among_slow(bodies, slots, buckets, kind_actor, known, found)
        found = _with_fast(bodies, slots, fast[:movers], kind_actor, known, found)
    pairs, counts = found
    return Touching(np.sort(pairs[: counts[0]]), counts[1], counts[2])

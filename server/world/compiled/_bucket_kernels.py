"""Everyone sorted into square buckets of the map, and the nearest found in them."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel

ORDER_BITS = 20
"""An avatar's place in the order of age takes the low bits of a key; the rest is its distance."""

Ints = NDArray[np.int64]


class Buckets(NamedTuple):
    """Everyone's place in this tick.

    The bucket of column u and line v holds `items[starts[b]:starts[b + 1]]`, b = v * wide + u,
    which are places in `in_order`.
    """

    places: Ints
    """(R, 3), cm: x, y and the weighted height, by row."""
    in_order: Ints
    """(N,): the rows of everyone, the oldest first."""
    edge: int
    x0: int
    y0: int
    wide: int
    high: int
    starts: Ints
    items: Ints


@kernel
def fill_buckets(buckets: Buckets) -> None:
    """Write `starts` and `items`: in each bucket the oldest first."""
    b = buckets
    b.starts[:] = 0
    of = np.empty(len(b.in_order), np.int64)
    for k in range(len(b.in_order)):
        x, y = b.places[b.in_order[k], 0], b.places[b.in_order[k], 1]
        of[k] = (y - b.y0) // b.edge * b.wide + (x - b.x0) // b.edge
        b.starts[of[k] + 1] += 1
    for bucket in range(b.wide * b.high):
        b.starts[bucket + 1] += b.starts[bucket]
    used = np.zeros(b.wide * b.high, np.int64)
    for k in range(len(b.in_order)):
        b.items[b.starts[of[k]] + used[of[k]]] = k
        used[of[k]] += 1


@inlined
def collect_bucket(b: Buckets, bucket: int, here: int, most2: int, keys: Ints, count: int) -> int:
    """Append the keys of those in a bucket who are no further from row `here` than `most2`, cm2."""
    for i in range(b.starts[bucket], b.starts[bucket + 1]):
        row = b.in_order[b.items[i]]
        dx = b.places[row, 0] - b.places[here, 0]
        dy = b.places[row, 1] - b.places[here, 1]
        dz = b.places[row, 2] - b.places[here, 2]
        apart2 = dx * dx + dy * dy + dz * dz
        if apart2 <= most2:
            keys[count] = (apart2 << ORDER_BITS) | b.items[i]
            count += 1
    return count


@kernel
def find_nearest(b: Buckets, here: int, wanted: int, reach: float, keys: Ints) -> int:
    """The nearest `wanted` of everyone to the avatar in row `here`, itself among them.

    Rings of buckets are searched from the middle outwards, until those further off can hold nobody
    nearer. `reach` is the greatest distance, cm; `keys` int64 (N,) takes the keys, sorted:
    squared distance, cm2, above ORDER_BITS bits with the place in `in_order`. Of equally near
    avatars the older comes first. Returns the number of those found.
    """
    x, y = b.places[here, 0] - b.x0, b.places[here, 1] - b.y0
    column, line = x // b.edge, y // b.edge
    inside_x = min(x - column * b.edge, (column + 1) * b.edge - x)
    inside_y = min(y - line * b.edge, (line + 1) * b.edge - y)
    inside = min(inside_x, inside_y)
    most2 = int(reach * reach)
    count = 0
    for ring in range(max(b.wide, b.high)):
        for v in range(max(line - ring, 0), min(line + ring, b.high - 1) + 1):
            # Of the lines between the first and the last, only both ends are new.
            pace = 1 if ring == 0 or v == line - ring or v == line + ring else 2 * ring
            for u in range(column - ring, column + ring + 1, pace):
                if 0 <= u < b.wide:
                    count = collect_bucket(b, v * b.wide + u, here, most2, keys, count)
        # Everyone nearer than this has been met.
        sure = ring * b.edge + inside
        if sure > reach:
            break
        if count >= wanted:
            limit = (sure * sure) << ORDER_BITS
            near = 0
            for i in range(count):
                near += keys[i] < limit
            if near >= wanted:
                near = 0
                for i in range(count):
                    if keys[i] < limit:
                        keys[near] = keys[i]
                        near += 1
                count = near
                break
    keys[:count].sort()
    return min(count, wanted)

"""Everyone is sorted into square buckets once in a tick, to find the nearest of anybody."""

from typing import Final

import numpy as np

from esplanade.server.world.avatars import Avatars
from esplanade.server.world.compiled._bucket_kernels import ORDER_BITS, Buckets, fill_buckets

MAX_AVATARS: Final = 1 << ORDER_BITS
PER_BUCKET: Final = 4
"""The buckets are as large as to hold about so many, were all spread evenly."""
LEAST_EDGE_CM: Final = 50


def sort_into_buckets(avatars: Avatars) -> Buckets:
    """The buckets of a tick; they hold until somebody moves, comes or goes."""
    places, rows = avatars.places, avatars.in_order
    here = places[rows, :2] if len(rows) else np.zeros((1, 2), dtype=np.int64)
    (x0, y0), (x1, y1) = here.min(axis=0).tolist(), here.max(axis=0).tolist()
    width, height = x1 - x0 + 1, y1 - y0 + 1
    even = (width * height * PER_BUCKET / len(here)) ** 0.5
    # Where all stand in a row the area says little; the second bound keeps the buckets few.
    edge = int(max(even, max(width, height) / len(here), LEAST_EDGE_CM))
    wide, high = width // edge + 1, height // edge + 1
    starts, items = np.empty(wide * high + 1, dtype=np.int64), np.empty(len(rows), dtype=np.int64)
    buckets = Buckets(places, rows, edge, x0, y0, wide, high, starts, items)
    fill_buckets(buckets)
    return buckets

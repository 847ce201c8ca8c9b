"""Lists the barriers of a zone by square buckets, so that those near a point are found at once."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from esplanade.planning.ground import _geometry_kernels as geometry
from esplanade.planning.ground._geometry_kernels import BarrierIndex
from esplanade.planning.ground.barriers import Barriers

_BUCKET_M: Final = 1.0
_BUCKET_REACH_M: Final = 1.5


def index_barriers(barriers: Barriers, bounds: tuple[float, float, float, float]) -> BarrierIndex:
    """List barriers (S,), which are shared, not copied, within bounds x0, y0, x1, y1 in metres."""
    x0, y0, x1, y1 = bounds
    nx = max(1, math.ceil((x1 - x0) / _BUCKET_M))
    ny = max(1, math.ceil((y1 - y0) / _BUCKET_M))
    reach = _BUCKET_REACH_M + _BUCKET_M * math.sqrt(0.5)
    starts = np.zeros(nx * ny + 1, dtype=np.int64)
    place = (x0, y0, _BUCKET_M, nx, ny)
    geometry.list_by_bucket(barriers, place, reach, starts, np.empty(0, dtype=np.int64))
    starts[1:] = np.cumsum(starts[1:])
    members = np.empty(starts[-1], dtype=np.int64)
    geometry.list_by_bucket(barriers, place, reach, starts, members)
    return BarrierIndex(barriers, starts, members, *place[:3], _BUCKET_REACH_M, nx, ny)

"""Barriers on bare arrays: outlines of solids, and what ledges and lintels are written with."""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.ground._surface_kernels import (
    SolidArrays,
    top_at,
)
from esplanade.planning.ground.layered import LINK_M

LEAST_STEP_M = 0.1
"""Floors that differ by less count as level, since everybody steps that high."""
PIECE_RISE_M = 0.25
"""The side of a ramp is cut into pieces whose tops rise by no more than this."""
_BELOW_M = 0.05
"""The barrier of a ledge begins this far below its upper floor."""
_ABOVE_M = 2.0
"""The barrier of a ledge ends this far above its upper floor, or at the ceiling."""
_SAME_M = 1e-4
"""Heights that differ by less are equal."""

FACE = np.dtype(
    [
        ("x0", "f8"),
        ("y0", "f8"),
        ("x1", "f8"),
        ("y1", "f8"),
        ("bottom_m", "f8"),
        ("top_m", "f8"),
        ("column", "i8"),
    ]
)
"""A piece of a steep face of a mesh within one column of the grid, seen from above as a segment
from (x0, y0) to (x1, y1), in metres."""


@kernel
def outlines(solids: SolidArrays, out: NDArray[np.void]) -> int:
    """Write the sides of solids, up to their tops, as barriers into `out`, (S,) of `BARRIER`.

    The sides of solids that carry nobody reach higher than anyone steps. Returns the number of
    barriers; those beyond the room in `out` are not written.
    """
    count = 0
    for k in range(len(solids.bottoms)):
        least = 0.0 if solids.standable[k] else solids.bottoms[k] + LINK_M
        first, last = solids.starts[k], solids.starts[k + 1]
        for a in range(first, last):
            b = a + 1 if a + 1 < last else first
            ax, ay = solids.points[a]
            ux, uy = solids.points[b, 0] - ax, solids.points[b, 1] - ay
            rise = abs(top_at(solids, k, ax + ux, ay + uy) - top_at(solids, k, ax, ay))
            pieces = max(1, int(np.ceil(rise / PIECE_RISE_M - 1e-9)))
            for piece in range(pieces):
                u, v = piece / pieces, (piece + 1) / pieces
                px, py, qx, qy = ax + u * ux, ay + u * uy, ax + v * ux, ay + v * uy
                top = max(least, top_at(solids, k, px, py), top_at(solids, k, qx, qy))
                if count < len(out):
                    write_barrier(out[count], (px, py, qx, qy), (solids.bottoms[k], top, np.inf))
                count += 1
    return count


@inlined
def write_barrier(
    barrier: np.void,
    line: tuple[float, float, float, float],
    heights: tuple[float, float, float],
) -> None:
    """Fill a barrier with its line (x0, y0, x1, y1) and its heights (bottom, top, climb)."""
    barrier["x0"], barrier["y0"], barrier["x1"], barrier["y1"] = line
    barrier["bottom_m"], barrier["top_m"], barrier["climb_m"] = heights


@inlined
def append_barrier(
    out: NDArray[np.void],
    count: int,
    line: tuple[float, float, float, float],
    heights: tuple[float, float, float],
) -> int:
    """Append a barrier, or lengthen the last one if it goes straight on; returns the new count.

    `line` and `heights` are those of `write_barrier`. Barriers beyond the room in `out` are
    counted, not written.
    """
    x0, y0, x1, y1 = line
    bottom, top, climb = heights
    if 0 < count <= len(out):
        last = out[count - 1]
        ux, uy = last["x1"] - last["x0"], last["y1"] - last["y0"]
        vx, vy = x1 - x0, y1 - y0
        if (
            abs(last["x1"] - x0) + abs(last["y1"] - y0) < 1e-9
            and abs(last["bottom_m"] - bottom) + abs(last["top_m"] - top) < _SAME_M
            and (last["climb_m"] == climb or abs(last["climb_m"] - climb) < _SAME_M)
            and abs(ux * vy - uy * vx) < 1e-9
            and ux * vx + uy * vy > 0.0
        ):
            last["x1"], last["y1"] = x1, y1
            return count
    if count < len(out):
        write_barrier(out[count], line, heights)
    return count + 1


@inlined
def ledge_heights(floor: float, ceiling: float, climb: float) -> tuple[float, float, float]:
    """The heights of a ledge's barrier (bottom, top, climb), for its upper floor.

    It ends at the ceiling, since above it would concern nobody.
    """
    return floor - _BELOW_M, min(floor + _ABOVE_M, ceiling), climb

"""The floors of a mesh that are no inside of a wall: those that an adult reaches, to the walls."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Flags = NDArray[np.bool_]

_ROUNDS = 4
"""Cells between where an adult's middle can be and a wall, at most."""


def grown_to_walls(
    reached: Flags, floors: Floats, walls: Floats, corner: tuple[float, float], cell_m: float
) -> Flags:
    """The cells that are reached, (rows, columns), and those between them and the walls.

    `walls` are x0, y0, x1, y1, float64 (S, 4), metres. A wall lies between two cells if it crosses
    the line from the middle of one to that of the other.
    """
    beside = _crossed(walls, corner, cell_m, reached.shape)
    below = _crossed(walls[:, [1, 0, 3, 2]], corner[::-1], cell_m, reached.T.shape).T
    found, known = reached.copy(), np.isfinite(floors)
    for _ in range(_ROUNDS):
        grown = found.copy()
        grown[:, 1:] |= found[:, :-1] & ~beside
        grown[:, :-1] |= found[:, 1:] & ~beside
        grown[1:] |= found[:-1] & ~below
        grown[:-1] |= found[1:] & ~below
        found = grown & known
    return found


def _crossed(
    walls: Floats, corner: tuple[float, float], cell_m: float, shape: tuple[int, ...]
) -> Flags:
    """Whether a wall lies between a cell and the next one of its row, (rows, columns - 1)."""
    rows, columns = shape
    found = np.zeros((rows, columns - 1), dtype=np.bool_)
    for ax, ay, bx, by in walls.tolist():
        low, high = sorted(((y - corner[1]) / cell_m - 0.5) for y in (ay, by))
        through = np.arange(max(0, int(np.ceil(low))), min(rows - 1, int(np.floor(high))) + 1)
        if ay != by and len(through):
            y = corner[1] + (through + 0.5) * cell_m
            x = ax + (y - ay) / (by - ay) * (bx - ax)
            column = np.floor((x - corner[0]) / cell_m - 0.5).astype(int)
            inside = (column >= 0) & (column < columns - 1)
            found[through[inside], column[inside]] = True
    return found

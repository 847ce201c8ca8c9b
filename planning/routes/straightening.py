"""Straightening of a path of cells, and its headings (Huang & Li, sec. 4.4)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.routes import _straightening_kernels as kernels
from esplanade.planning.routes._straightening_kernels import Line
from esplanade.planning.traversal.traversability import Traversability


def line_of_cells(
    traversability: Traversability,
    cells: NDArray[np.int32],
    counts: NDArray[np.int32],
    start: tuple[float, float],
    goal: tuple[float, float],
) -> Line:
    """The line over the anchors of cells (K,), from a start in the first to a goal in the last.

    `counts` (K,) are those of the cells; `start` and `goal` are x, y in metres.
    """
    room = 2 * len(cells)
    line = Line(np.empty((room, 2)), np.empty(room, dtype=np.int32), np.empty(room, dtype=np.int32))
    used = kernels.over_anchors(traversability, cells, counts, line)
    return Line(
        np.concatenate([[start], line.xy[:used], [goal]]),
        np.concatenate([cells[:1], line.cells[:used], cells[-1:]]),
        np.concatenate([counts[:1], line.counts[:used], counts[-1:]]),
    )


def straighten(traversability: Traversability, line: Line) -> Line:
    """Shorten a line by straight stretches that are legal for the body, M included.

    Straight stretches are checked on the floors, from cell to cell, with the body's exact distance
    to walls. This is done from the start, then from the goal, since the two directions find
    different corners. The result has a point in every cell that it crosses, so that it follows the
    floor up and down. Cost O(points x log points).
    """
    line = _from_start(traversability, line)
    back = _reversed(line)
    if not kernels.recount(traversability, back):
        return line
    shorter = _reversed(_from_start(traversability, back))
    return shorter if kernels.recount(traversability, shorter) else line


def _from_start(traversability: Traversability, line: Line) -> Line:
    room = 3 * len(line.cells) + 8
    out = Line(np.empty((room, 2)), np.empty(room, dtype=np.int32), np.empty(room, dtype=np.int32))
    used = kernels.straighten(traversability, line, out)
    return Line(out.xy[:used], out.cells[:used], out.counts[:used])


def _reversed(line: Line) -> Line:
    return Line(line.xy[::-1].copy(), line.cells[::-1].copy(), line.counts[::-1].copy())


def headings(xy: NDArray[np.float64]) -> NDArray[np.float64]:
    """Headings of a body that walks along points (N, 2): radians from east toward north, (N,).

    The heading at a point is the direction of the line between its neighbours.
    """
    if len(xy) < 2:
        return np.zeros(len(xy))
    along = np.empty_like(xy)
    along[1:-1] = xy[2:] - xy[:-2]
    along[0], along[-1] = xy[1] - xy[0], xy[-1] - xy[-2]
    return np.arctan2(along[:, 1], along[:, 0])

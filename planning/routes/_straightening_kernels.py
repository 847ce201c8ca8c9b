"""Straight stretches over floors, on bare arrays: Huang & Li, sec. 4.4."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.ground._geometry_kernels import TOLERANCE_M
from esplanade.planning.ground.layered import LayeredArrays
from esplanade.planning.traversal._anchor_kernels import anchor_of
from esplanade.planning.traversal._stability_kernels import STABLE
from esplanade.planning.traversal._way_kernels import bend_between, is_way_clear
from esplanade.planning.traversal.traversability import Traversability

_CORNER_M = 1e-9


class Line(NamedTuple):
    """A path as N points, at least one in every cell that it crosses."""

    xy: NDArray[np.float64]
    """(N, 2): positions, metres."""
    cells: NDArray[np.int32]
    """(N,): the cell of each point."""
    counts: NDArray[np.int32]
    """(N,): cells on edges in a row, up to and with that of each point."""


@inlined
def is_clear(
    traversability: Traversability, cell: int, ax: float, ay: float, bx: float, by: float
) -> bool:
    """Whether a body keeps clear of barriers on the segment ab within one cell."""
    floor = float(traversability.arrays.floors[cell])
    near, body = traversability.near, traversability.body
    return is_way_clear(near, body, cell, floor, floor, ax, ay, bx, by)


@inlined
def _heights_allow(traversability: Traversability, cell: int, other: int) -> bool:
    """Whether floors and ceilings let a body go from one cell to the next, whatever barriers do."""
    arrays, body = traversability.arrays, traversability.body
    a, b = arrays.floors[cell], arrays.floors[other]
    room = min(arrays.ceilings[cell], arrays.ceilings[other]) - max(a, b)
    return bool(abs(a - b) <= body.step_on_m + TOLERANCE_M and room >= body.height_m - TOLERANCE_M)


@inlined
def _is_clear_between(
    traversability: Traversability,
    cell: int,
    other: int,
    ax: float,
    ay: float,
    bx: float,
    by: float,
) -> bool:
    """`is_clear` of a segment in `cell`, also where a ledge is seen from the floor of `other`."""
    floors = traversability.arrays.floors
    floor = float(floors[cell])
    lowest = min(floor, float(floors[other]))
    near, body = traversability.near, traversability.body
    return is_way_clear(near, body, cell, lowest, floor, ax, ay, bx, by)


@inlined
def _until(a: float, b: float, cell: int, last: int, origin: float, cell_m: float) -> float:
    """The part of the coordinates from a to b at which they leave a row (or column) of cells."""
    if cell == last:
        return np.inf
    side = cell + 1 if last > cell else cell
    return (origin + side * cell_m - a) / (b - a) if b != a else 0.0


@inlined
def trace(
    traversability: Traversability, line: Line, a: int, b: int, count: int, out: Line, used: int
) -> int:
    """Walk straight from point a of a line to point b, with a count of `count` at a.

    Writes the points after a, one in every cell in between, into `out` from `used` on. Returns the
    number of points in `out`, or -1 if the body may not walk there.
    """
    arrays = traversability.arrays
    ax, ay = line.xy[a]
    bx, by = line.xy[b]
    cell, last = line.cells[a], line.cells[b]
    j, i = arrays.places[cell]["row"], arrays.places[cell]["column"]
    last_j, last_i = arrays.places[last]["row"], arrays.places[last]["column"]
    x, y, done = ax, ay, 0.0
    before = cell
    while True:
        u = _until(ax, bx, i, last_i, arrays.x0, arrays.cell_m)
        v = _until(ay, by, j, last_j, arrays.y0, arrays.cell_m)
        part = min(1.0, max(done, min(u, v)))
        then_x, then_y = ax + part * (bx - ax), ay + part * (by - ay)
        if not _is_clear_between(traversability, cell, before, x, y, then_x, then_y):
            return -1
        if j == last_j and i == last_i:
            if cell != last:
                return -1
            out.xy[used] = (bx, by)
            out.cells[used] = cell
            out.counts[used] = count
            return used + 1
        if cell != line.cells[a]:
            out.xy[used] = (0.5 * (x + then_x), 0.5 * (y + then_y))
            out.cells[used] = cell
            out.counts[used] = count
            used += 1
        di = 0 if u > v + _CORNER_M else (1 if last_i > i else -1)
        dj = 0 if v > u + _CORNER_M else (1 if last_j > j else -1)
        d = _link_toward(dj, di)
        other = arrays.links[cell, d]
        if other < 0:
            return -1
        before = cell
        if not traversability.steps[cell] >> d & 1:
            # The anchors are barred from each other, but the way may lead beside them.
            if not (
                _heights_allow(traversability, cell, other)
                and _is_clear_between(traversability, cell, other, x, y, then_x, then_y)
            ):
                return -1
        else:
            before = other
        x, y, done = then_x, then_y, part
        cell = other
        count = 0 if traversability.classes[cell] == STABLE else count + 1
        if count >= traversability.edge_cells:
            return -1
        j += dj
        i += di


@inlined
def _link_toward(dj: int, di: int) -> int:
    """The link that leads one row and column on, by -1, 0 or 1 each."""
    if dj == 0:
        return 0 if di > 0 else 4
    if dj > 0:
        return 2 - di
    return 6 + di


@kernel
def straighten(traversability: Traversability, line: Line, out: Line) -> int:
    """Replace stretches of a line by straight ones as long as possible; the points in `out`.

    A straight stretch is legal if the body may walk it and the cells on edges up to its end and
    from there on are fewer than M together, so that the rest of the line stays legal. Its end is
    sought by halving, from the far end of the line on.
    """
    n = len(line.cells)
    ahead = np.zeros(n, dtype=np.int32)
    for k in range(n - 2, -1, -1):
        if line.cells[k + 1] == line.cells[k]:
            ahead[k] = ahead[k + 1]
        elif line.counts[k + 1] > 0:
            ahead[k] = ahead[k + 1] + 1
    out.xy[0] = line.xy[0]
    out.cells[0] = line.cells[0]
    out.counts[0] = line.counts[0]
    used = 1
    anchor = 0
    while anchor < n - 1:
        count = out.counts[used - 1]
        good, bad, to = anchor, n, n - 1
        while bad - good > 1:
            end = trace(traversability, line, anchor, to, count, out, used)
            if end > 0 and out.counts[end - 1] + ahead[to] < traversability.edge_cells:
                good = to
            else:
                bad = to
            to = (good + bad) // 2
        if good == anchor:
            good = anchor + 1
            if line.cells[good] != line.cells[anchor]:
                count = 0 if line.counts[good] == 0 else count + 1
            out.xy[used] = line.xy[good]
            out.cells[used] = line.cells[good]
            out.counts[used] = count
            used += 1
        else:
            used = trace(traversability, line, anchor, good, count, out, used)
        anchor = good
    return used


@kernel
def over_anchors(
    traversability: Traversability, cells: NDArray[np.int32], counts: NDArray[np.int32], out: Line
) -> int:
    """Write the line over the anchors of cells (K,), and where links bend; its number of points."""
    used = 0
    for k in range(len(cells)):
        if k > 0:
            kind, x, y = bend_between(
                traversability.arrays,
                traversability.near,
                traversability.body,
                traversability.offsets,
                cells[k - 1],
                cells[k],
            )
            if kind == 2:
                own = _has_inside(traversability.arrays, cells[k - 1], x, y)
                out.xy[used] = (x, y)
                out.cells[used] = cells[k - 1] if own else cells[k]
                out.counts[used] = counts[k - 1] if own else counts[k]
                used += 1
        first, offsets = traversability.near.first, traversability.offsets
        x, y = anchor_of(traversability.arrays, first, offsets, cells[k])
        out.xy[used] = (x, y)
        out.cells[used] = cells[k]
        out.counts[used] = counts[k]
        used += 1
    return used


@inlined
def _has_inside(arrays: LayeredArrays, cell: int, x: float, y: float) -> bool:
    """Whether a point lies in a cell, seen from above."""
    j, i = arrays.places[cell]["row"], arrays.places[cell]["column"]
    return bool(
        0.0 <= x - arrays.x0 - i * arrays.cell_m <= arrays.cell_m
        and 0.0 <= y - arrays.y0 - j * arrays.cell_m <= arrays.cell_m
    )


@kernel
def recount(traversability: Traversability, line: Line) -> bool:
    """Count cells on edges again, from the first point on; returns whether M allows the line."""
    line.counts[0] = 0
    for k in range(1, len(line.cells)):
        count = line.counts[k - 1]
        if line.cells[k] != line.cells[k - 1]:
            count = 0 if traversability.classes[line.cells[k]] == STABLE else count + 1
        line.counts[k] = count
        if count >= traversability.edge_cells:
            return False
    return True

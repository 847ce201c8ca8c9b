"""The grid of one zone on bare arrays: cells, their neighbours and clearances, lines of sight.

A point is known by its *cell*, the number of a standing surface, which tells layer, row and column.
From there `follow` finds the cell of a point nearby, up and down stairs and ramps.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.ground._barrier_kernels import height_to_climb, point_barrier_distance
from esplanade.planning.ground._geometry_kernels import LOW_ROOM_M, TOLERANCE_M, crosses
from esplanade.planning.ground.layered import TILE, LayeredArrays, cell_index
from esplanade.planning.traversal._anchor_kernels import PARTS, SLACK_M

HALF_DIAGONAL = 0.7072
"""Of a cell, in cells."""
FOLLOW_M = 1.0
"""`follow` goes to no surface further away in height than this, from one point to the next."""


class KindArrays(NamedTuple):
    """Where bodies of B kinds fit and can go from cell to cell, exactly."""

    offsets: NDArray[np.int8]
    """(E, 2): `Traversability.offsets` of each kind, one after the other as `entries` are;
    `anchor_at` has the points."""
    steps: NDArray[np.uint8]
    """(B, N): `Traversability.steps` of each kind."""
    first: NDArray[np.int32]
    """(B, N): the first entry of each cell's list of barriers, among those of the kind of body; -1
    without any."""
    entries: NDArray[np.void]
    """(E,) of `LISTED`."""
    barriers: NDArray[np.void]
    """(S,) of `BARRIER`."""
    measures: NDArray[np.void]
    """(B,) of `MEASURES`."""


MEASURES = np.dtype(
    [
        ("radius_m", "f8"),
        ("height_m", "f8"),
        ("step_on_m", "f8"),
        ("leg_length_m", "f8"),
        ("reach_m", "f8"),
        ("entries", "i8"),
    ]
)
"""Measures of a kind of body, how far from a cell's centre the barriers in its list pass, and where
the entries of its lists begin."""


class GridArrays(NamedTuple):
    """The floors of a zone, with the clearances and edges of each kind of body."""

    layered: LayeredArrays
    clearance: NDArray[np.float32]
    """(B, N): for each kind of body the distance from a cell's centre to the barriers that stop it,
    metres, at most `CLEARANCE_CAP_M`."""
    edges: NDArray[np.bool_]
    """(B, N): whether a step or an edge lies within the radius of a kind of body."""
    flat: bool
    """Whether there is only one layer, all of it at height 0, so that heights can be ignored. Cells
    inside obstacles then count as ground, with negative clearance."""
    kinds: KindArrays


@inlined
def length(x: float, y: float) -> float:
    """Length of a vector; faster than `np.hypot`, which guards against overflow."""
    return float(np.sqrt(x * x + y * y))


@inlined
def row_and_column(grid: GridArrays, x: float, y: float) -> tuple[int, int]:
    """Row and column that hold a point, clamped to the grid."""
    per_m = 1.0 / grid.layered.cell_m  # the compiler divides only once for all points
    j = min(grid.layered.ny - 1, max(0, int((y - grid.layered.y0) * per_m)))
    i = min(grid.layered.nx - 1, max(0, int((x - grid.layered.x0) * per_m)))
    return j, i


@inlined
def _inside(grid: GridArrays, x: float, y: float) -> bool:
    """Whether a point lies inside the bounds, or on them."""
    ground = grid.layered
    return bool(ground.x0 <= x <= ground.x1 and ground.y0 <= y <= ground.y1)


@inlined
def follow(grid: GridArrays, cell: int, x: float, y: float) -> int:
    """Cell of a point near a cell: the surface nearest in height, on any layer; -1 if none.

    The point must be no further away than anyone gets in a time slice, since the cells in between
    are not looked at.
    """
    if not _inside(grid, x, y):
        return -1
    j, i = row_and_column(grid, x, y)
    if grid.flat:
        page = grid.layered.pages[0, j >> 3, i >> 3]
        return page + ((j & 7) << 3) + (i & 7) if page >= 0 else -1
    if cell < 0:
        return -1
    floor = grid.layered.floors[cell]
    best = -1
    least = FOLLOW_M
    for layer in range(len(grid.layered.pages)):
        other = cell_index(grid.layered, layer, j, i)
        if other >= 0:
            apart = abs(float(grid.layered.floors[other] - floor))
            if apart < least:
                least = apart
                best = other
    return best


@inlined
def floor_of(grid: GridArrays, cell: int) -> float:
    """Height of a cell's floor; 0 on flat ground, and where nobody can stand."""
    if grid.flat or cell < 0:
        return 0.0
    return float(grid.layered.floors[cell])


@kernel
def follow_path(
    grid: GridArrays,
    path: NDArray[np.float64],
    cells: NDArray[np.int64],
    first: int,
    last: int,
) -> None:
    """Fill the cells (K,) of a path (K, 2) after slice `first` up to slice `last`."""
    for k in range(first + 1, last + 1):
        cells[k] = follow(grid, cells[k - 1], path[k, 0], path[k, 1])


@kernel
def surface_at(grid: GridArrays, x: float, y: float, z: float) -> int:
    """Cell of the standing surface nearest in height at a point, else up to two cells aside.

    A surface aside counts as well where that at the point is a metre or more above or below, as a
    roof is over a gap in the floor. It is -1 where nobody can stand there either.
    """
    j, i = row_and_column(grid, x, y)
    found = -1
    for ring in range(3):
        best = -1
        least = np.inf
        for nj in range(max(0, j - ring), min(grid.layered.ny, j + ring + 1)):
            for ni in range(max(0, i - ring), min(grid.layered.nx, i + ring + 1)):
                for layer in range(len(grid.layered.pages)):
                    cell = cell_index(grid.layered, layer, nj, ni)
                    if cell >= 0:
                        aside = length(float(nj - j), float(ni - i))
                        apart = (
                            abs(float(grid.layered.floors[cell] - z)) + aside * grid.layered.cell_m
                        )
                        if apart < least:
                            least = apart
                            best = cell
        if best >= 0 and least < FOLLOW_M:
            return best
        if found >= 0:
            break
        found = best
    return found


@inlined
def neighbour(grid: GridArrays, cell: int, dj: int, di: int) -> int:
    """The cell next to a cell, on any layer; the cell itself where there is none."""
    if grid.flat:  # within a tile a neighbour can be computed
        j = ((cell >> 3) & 7) + dj
        i = (cell & 7) + di
        if 0 <= j < TILE and 0 <= i < TILE:
            return cell + (dj << 3) + di
    if dj == 0:
        direction = 0 if di > 0 else 4
    elif dj > 0:
        direction = 2 - di
    else:
        direction = 6 + di
    link = grid.layered.links[cell, direction]
    return link if link >= 0 else cell


@inlined
def corners(grid: GridArrays, cell: int, x: float, y: float) -> tuple[int, int, int, float, float]:
    """The three cells around a point besides its own, and its distances from the own centre.

    (beside, above or below, across, u, v), with u and v in [0, 0.5] cells.
    """
    j, i = row_and_column(grid, x, y)
    per_m = 1.0 / grid.layered.cell_m
    u = (x - grid.layered.x0) * per_m - (i + 0.5)
    v = (y - grid.layered.y0) * per_m - (j + 0.5)
    di = 1 if u >= 0.0 else -1
    dj = 1 if v >= 0.0 else -1
    if grid.flat:  # a tile may reach beyond the bounds
        if not 0 <= i + di < grid.layered.nx:
            di = 0
        if not 0 <= j + dj < grid.layered.ny:
            dj = 0
    return (
        neighbour(grid, cell, 0, di),
        neighbour(grid, cell, dj, 0),
        neighbour(grid, cell, dj, di),
        abs(u),
        abs(v),
    )


@inlined
def clearance_at(grid: GridArrays, body: int, cell: int, x: float, y: float) -> float:
    """Clearance of a body at a point, metres; -inf without a cell.

    Near barriers, where it decides whether a body of that kind fits, it is exact; elsewhere it is
    interpolated between cells.
    """
    if cell < 0:
        return -np.inf
    c = grid.clearance[body]
    own = c[cell]
    half_m = HALF_DIAGONAL * grid.layered.cell_m
    beside, over, across, u, v = corners(grid, cell, x, y)
    away = length(u, v) * grid.layered.cell_m
    least = own - away
    if 0.0 <= own < grid.kinds.measures[body]["radius_m"] + away:
        exact_m = grid.kinds.measures[body]["reach_m"] - half_m
        low_m = max(0.0, grid.kinds.measures[body]["radius_m"] - LOW_ROOM_M)
        exact = _exact_clearance(grid, body, cell, x, y, own < half_m + low_m)
        if exact < exact_m:
            return exact
        least = exact_m
    lower = (1.0 - u) * own + u * c[beside]
    upper = (1.0 - u) * c[over] + u * c[across]
    room = float((1.0 - v) * lower + v * upper)
    if own < 0.0:  # the centre is inside an obstacle: nobody fits in half a cell around it
        return min(room, half_m)
    return float(max(room, least))


@inlined
def anchor_at(grid: GridArrays, body: int, cell: int) -> tuple[float, float]:
    """The point of a cell that paths of a kind of body go through, metres."""
    layered, kinds = grid.layered, grid.kinds
    u = layered.places[cell]["column"] + 0.5
    v = layered.places[cell]["row"] + 0.5
    entry = kinds.first[body, cell]
    if entry >= 0:  # `anchor_of` without slices of arrays
        entry += kinds.measures[body]["entries"]
        u += kinds.offsets[entry, 0] / PARTS
        v += kinds.offsets[entry, 1] / PARTS
    return layered.x0 + u * layered.cell_m, layered.y0 + v * layered.cell_m


@inlined
def _exact_clearance(
    grid: GridArrays, body: int, cell: int, x: float, y: float, divided: bool
) -> float:
    """Distance from a point to the nearest barrier in the list of its cell; inf without any.

    Low obstacles count as further away (`room_at`). If the cell is divided by a barrier, the
    distance is negative on the side where the body does not fit.
    """
    kinds = grid.kinds
    m = kinds.measures[body]
    floor = floor_of(grid, cell)
    ax, ay = anchor_at(grid, body, cell)
    best = np.inf
    behind = False
    entry = kinds.first[body, cell]
    while entry >= 0:
        listed = kinds.entries[m["entries"] + entry]
        barrier = kinds.barriers[listed["barrier"]]
        entry = listed["next"]
        climb = height_to_climb(barrier, floor, floor, m["height_m"])
        if climb <= m["step_on_m"] + TOLERANCE_M:
            continue
        d = point_barrier_distance(barrier, x, y)
        if climb <= m["leg_length_m"] + TOLERANCE_M:
            d += max(0.0, m["radius_m"] - LOW_ROOM_M)
        best = min(best, d)
        if divided and not behind:
            behind = crosses(barrier, ax, ay, x, y)
    return -best if behind else best


@inlined
def fits_at_anchor(grid: GridArrays, body: int, cell: int, radius: float) -> bool:
    """Whether a disc fits at the anchor of a cell."""
    x, y = anchor_at(grid, body, cell)
    return clearance_at(grid, body, cell, x, y) >= radius - SLACK_M


@inlined
def clearance_bound(grid: GridArrays, body: int, cell: int, x: float, y: float) -> float:
    """`clearance_at` where it decides whether a body of that kind fits; elsewhere no more than the
    distance to the barriers, which an interpolation may be."""
    if cell < 0:
        return -np.inf
    own = grid.clearance[body, cell]
    if own < 0.0:
        return clearance_at(grid, body, cell, x, y)
    place = grid.layered.places[cell]
    dx = x - (grid.layered.x0 + (place["column"] + 0.5) * grid.layered.cell_m)
    dy = y - (grid.layered.y0 + (place["row"] + 0.5) * grid.layered.cell_m)
    away = length(dx, dy)
    measures = grid.kinds.measures[body]
    if own >= measures["radius_m"] + away:
        return float(own - away)
    half_m = HALF_DIAGONAL * grid.layered.cell_m
    low_m = max(0.0, measures["radius_m"] - LOW_ROOM_M)
    exact = _exact_clearance(grid, body, cell, x, y, own < half_m + low_m)
    return min(exact, float(measures["reach_m"]) - half_m)


@inlined
def spread_allowed(
    grid: GridArrays,
    body: int,
    cell: int,
    ax: float,
    ay: float,
    bx: float,
    by: float,
    radius: float,
) -> float:
    """The metres by which a disc may leave the straight line from a to b, for each metre from b.

    The line begins in `cell`. Where the disc may not move on it at all, the answer is negative. On
    flat ground the line is sphere-traced; elsewhere each piece is a cell long at most.
    """
    way = length(bx - ax, by - ay)
    shortest = 0.5 * grid.layered.cell_m
    s = 0.0
    step = 0.0
    before = 0.0
    least = 1.0
    while True:
        u = s / way if way > 0.0 else 0.0
        x = ax + u * (bx - ax)
        y = ay + u * (by - ay)
        there = follow(grid, cell, x, y)
        room = clearance_bound(grid, body, there, x, y) - radius
        if room < 0.0:
            return -1.0
        rise = abs(floor_of(grid, there) - floor_of(grid, cell))
        if rise > grid.kinds.measures[body]["step_on_m"] + TOLERANCE_M:
            return -1.0
        if s > 0.0 and before < step + (way - s):
            # Room falls by no more than the distance from either end of a piece, so that there is
            # least of it, for each metre from b, where both say the same.
            at = 0.5 * (room + (way - s) + step + (way - s) - before)
            least = min(least, 0.5 * (before + room - step) / at)
        if s >= way:
            return max(0.0, least)
        cell = there
        before = room
        step = max(room, shortest) if grid.flat else min(max(room, shortest), grid.layered.cell_m)
        step = min(step, way - s)
        s = s + step if step < way - s else way


@kernel
def line_is_clear(
    grid: GridArrays,
    body: int,
    cell: int,
    ax: float,
    ay: float,
    bx: float,
    by: float,
    radius: float,
) -> bool:
    """Whether a disc may move straight from a, in `cell`, to b; cheap in the open."""
    return spread_allowed(grid, body, cell, ax, ay, bx, by, radius) >= 0.0


@kernel
def clearance_many(
    grid: GridArrays,
    body: int,
    cells: NDArray[np.int64],
    positions: NDArray[np.float64],
    out: NDArray[np.float64],
) -> None:
    """Fill `out` (N,) with `clearance_at` of cells (N,), positions (N, 2); -inf out of bounds."""
    for k in range(len(positions)):
        x = positions[k, 0]
        y = positions[k, 1]
        out[k] = -np.inf
        if _inside(grid, x, y):
            out[k] = clearance_at(grid, body, cells[k], x, y)


@kernel
def surfaces_at(
    grid: GridArrays,
    positions: NDArray[np.float64],
    heights: NDArray[np.float64],
    out: NDArray[np.int64],
) -> None:
    """Fill `out` (N,) with `surface_at` of positions (N, 2) and heights (N,)."""
    for k in range(len(positions)):
        out[k] = surface_at(grid, positions[k, 0], positions[k, 1], heights[k])


@kernel
def heights_along(grid: GridArrays, cells: NDArray[np.int64], paths: NDArray[np.float64]) -> None:
    """Write the heights of A paths (A, K, 3) that begin in cells (A,), following them."""
    for a in range(len(cells)):
        cell = cells[a]
        for k in range(paths.shape[1]):
            on = follow(grid, cell, paths[a, k, 0], paths[a, k, 1])
            cell = on if on >= 0 else cell
            paths[a, k, 2] = floor_of(grid, cell)

"""Standing surfaces on bare arrays: columns of solids, links between columns, grouping.

Columns are numbered row by row. Surfaces and solids are listed by column in CSR form: the entries
of column c are starts[c] .. starts[c + 1], surfaces in order of height.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.ground.layered import LINK_COLUMNS, LINK_M, LINK_ROOM_M, LINK_ROWS

LEAST_HEADROOM_M = 1.0
"""A floor with less headroom than this is no surface, since nobody is that small."""
_SAME_M = 1e-4
"""Heights that differ by less are equal."""
_NEAREST_M = np.float32(0.5 * LEAST_HEADROOM_M - 0.01)
"""Two surfaces that differ by less are nearest to each other, as those of a column lie further
apart."""
_ROOM_M = np.float32(LINK_ROOM_M)
_MOST_AT_ONCE = 64
"""Greatest number of columns that are linked at once."""

TOP = np.dtype(
    [
        ("height", "f8"),
        ("slope_x", "f8"),
        ("slope_y", "f8"),
        ("lowest", "f8"),
        ("highest", "f8"),
    ]
)
"""The top of a solid: at (x, y) its height is height + slope_x * x + slope_y * y, but no lower than
`lowest` and no higher than `highest`; metres."""

RUN = np.dtype([("solid", "i4"), ("row", "i4"), ("first", "i4"), ("end", "i4")])
"""Cells of a row whose centres lie in a solid: the columns from `first` up to before `end`."""


class SolidArrays(NamedTuple):
    """K solids: prisms over rings of points, with a level or evenly rising top."""

    points: NDArray[np.float64]
    """(P, 2): corners, ring after ring, metres."""
    starts: NDArray[np.int64]
    """(K + 1,): where each ring begins."""
    bottoms: NDArray[np.float64]
    """(K,): height of the underside, metres."""
    tops: NDArray[np.void]
    """(K,) of `TOP`."""
    standable: NDArray[np.bool_]
    """(K,): whether the top carries anyone."""
    groups: NDArray[np.int16]
    """(K,): number of the solid's offset, counted upward from the ground, which is 0."""


class SolidColumns(NamedTuple):
    """The solids of a scene, and which of them each column goes through (CSR)."""

    solids: SolidArrays
    starts: NDArray[np.int32]
    """(columns + 1,): where the solids of each column begin."""
    members: NDArray[np.int32]
    """Numbers of solids, column after column."""


class Raster(NamedTuple):
    """The columns of a grid: its south-west corner and edge of a cell in metres, rows, columns."""

    x0: float
    y0: float
    cell_m: float
    ny: int
    nx: int


@inlined
def top_at(solids: SolidArrays, k: int, x: float, y: float) -> float:
    """Height of a solid's top at a point, metres."""
    t = solids.tops[k]
    height = t["height"] + t["slope_x"] * x + t["slope_y"] * y
    return float(min(t["highest"], max(t["lowest"], height)))


@kernel
def _crossings(ring: NDArray[np.float64], y: float, out: NDArray[np.float64]) -> int:
    """Write the x where a closed ring (P, 2) crosses the line of a y, ascending; their number."""
    count = 0
    b = len(ring) - 1
    for a in range(len(ring)):
        if (ring[a, 1] > y) != (ring[b, 1] > y):
            x = ring[a, 0] + (y - ring[a, 1]) * (ring[b, 0] - ring[a, 0]) / (
                ring[b, 1] - ring[a, 1]
            )
            k = count
            while k > 0 and out[k - 1] > x:
                out[k] = out[k - 1]
                k -= 1
            out[k] = x
            count += 1
        b = a
    return count


@kernel
def runs_of_solids(
    raster: Raster, solids: SolidArrays, runs: NDArray[np.void], counts: NDArray[np.int32]
) -> int:
    """Find the cells of each row whose centres lie in each solid.

    `runs` (R,) of `RUN` is filled as far as there is room; `counts` (columns + 1,), preset to 0,
    receives the number of solids of column c at c + 1. Returns the number of runs; if it is more
    than R, counts are incomplete and the call has to be repeated with more room.
    """
    used = 0
    for k in range(len(solids.bottoms)):
        ring = solids.points[solids.starts[k] : solids.starts[k + 1]]
        crossings = np.empty(len(ring))
        j0 = max(0, int(np.ceil((ring[:, 1].min() - raster.y0) / raster.cell_m - 0.5)))
        j1 = min(raster.ny, int(np.ceil((ring[:, 1].max() - raster.y0) / raster.cell_m - 0.5)))
        for j in range(j0, j1):
            found = _crossings(ring, raster.y0 + (j + 0.5) * raster.cell_m, crossings)
            for c in range(0, found - 1, 2):
                i0 = max(0, int(np.ceil((crossings[c] - raster.x0) / raster.cell_m - 0.5)))
                i1 = int(np.ceil((crossings[c + 1] - raster.x0) / raster.cell_m - 0.5))
                i1 = min(raster.nx, i1)
                if i0 >= i1:
                    continue
                if used < len(runs):
                    runs[used]["solid"] = k
                    runs[used]["row"] = j
                    runs[used]["first"] = i0
                    runs[used]["end"] = i1
                    for i in range(i0, i1):
                        counts[j * raster.nx + i + 1] += 1
                used += 1
    return used


@kernel
def fill_columns(
    nx: int,
    runs: NDArray[np.void],
    starts: NDArray[np.int32],
    members: NDArray[np.int32],
) -> None:
    """Fill `members` with the solids of each column; `starts` (columns + 1,) is summed already."""
    ends = starts[:-1].copy()
    for r in range(len(runs)):
        run = runs[r]
        row = run["row"] * nx
        for c in range(row + run["first"], row + run["end"]):
            members[ends[c]] = run["solid"]
            ends[c] += 1


@kernel
def surfaces_of_columns(
    raster: Raster,
    columns: SolidColumns,
    ground: bool,
    heights: tuple[NDArray[np.float32], NDArray[np.float32]],
    places: tuple[NDArray[np.int32], NDArray[np.int32]],
    groups: NDArray[np.int16],
    surface_starts: NDArray[np.int32],
) -> int:
    """Find the standing surfaces of every column, lowest first.

    Writes `heights` (floors, ceilings), `places` (rows, columns), `groups` and where each column
    begins. Candidates are the ground, at height 0, and the tops that carry; those that lie in
    another solid or have too little headroom are dropped. Returns the number of surfaces.
    """
    floors, ceilings = heights
    rows, cols = places
    solids, starts, members = columns
    used = 0
    for c in range(raster.ny * raster.nx):
        surface_starts[c] = used
        j, i = c // raster.nx, c % raster.nx
        first, last = starts[c], starts[c + 1]
        if first == last:
            if ground:
                floors[used] = 0.0
                ceilings[used] = np.inf
                rows[used], cols[used] = j, i
                groups[used] = 0
                used += 1
            continue
        x = raster.x0 + (i + 0.5) * raster.cell_m
        y = raster.y0 + (j + 0.5) * raster.cell_m
        for candidate in range(first - 1 if ground else first, last):
            z = 0.0
            group = np.int16(0)
            if candidate >= first:
                k = members[candidate]
                if not solids.standable[k]:
                    continue
                z = top_at(solids, k, x, y)
                group = solids.groups[k]
            ceiling = np.inf
            for m in range(first, last):
                if top_at(solids, members[m], x, y) > z + _SAME_M:
                    ceiling = min(ceiling, solids.bottoms[members[m]])
            if ceiling - z < LEAST_HEADROOM_M - _SAME_M:
                continue
            k = used
            while k > surface_starts[c] and floors[k - 1] > z:
                k -= 1
            if k > surface_starts[c] and z - floors[k - 1] < _SAME_M:
                continue
            for m in range(used, k, -1):
                floors[m] = floors[m - 1]
                ceilings[m] = ceilings[m - 1]
                groups[m] = groups[m - 1]
            floors[k] = z
            ceilings[k] = ceiling
            groups[k] = group
            rows[used], cols[used] = j, i
            used += 1
    surface_starts[raster.ny * raster.nx] = used
    return used


@inlined
def _apart(floors: NDArray[np.float32], ceilings: NDArray[np.float32], a: int, b: int) -> float:
    """Difference in height of two neighbouring floors; inf if too little headroom joins them."""
    room = min(ceilings[a], ceilings[b]) - max(floors[a], floors[b])
    return abs(floors[a] - floors[b]) - _SAME_M if room >= LINK_ROOM_M else np.inf


@inlined
def _match(
    floors: NDArray[np.float32], ceilings: NDArray[np.float32], a: int, q0: int, q1: int
) -> int:
    """The surface among q0 .. q1 nearest in height to a that a can be linked to; -1 if none."""
    best = -1
    least = LINK_M
    for q in range(q0, q1):
        away = _apart(floors, ceilings, a, q)
        if away <= least and (best < 0 or away < least):
            least = away
            best = q
    return best


@inlined
def _level_count(
    floors: NDArray[np.float32], ceilings: NDArray[np.float32], a: int, b: int, count: int
) -> int:
    """Number of surfaces from a on that are nearly level with those from b on, one by one."""
    floors_a, floors_b = floors[a : a + count], floors[b : b + count]
    ceilings_a, ceilings_b = ceilings[a : a + count], ceilings[b : b + count]
    apart = 0
    for k in range(count):  # without a break, so that the compiler vectorises it
        room = min(ceilings_a[k], ceilings_b[k]) - max(floors_a[k], floors_b[k])
        apart += (abs(floors_a[k] - floors_b[k]) >= _NEAREST_M) | (room < _ROOM_M)
    if apart == 0:
        return count
    level = 0
    while level < count and _apart(floors, ceilings, a + level, b + level) < _NEAREST_M - _SAME_M:
        level += 1
    return level


@inlined
def _link_level(
    starts: NDArray[np.int32],
    floors: NDArray[np.float32],
    ceilings: NDArray[np.float32],
    run: tuple[int, int, int],
    d: int,
    links: NDArray[np.int32],
) -> int:
    """Link a run (first column, its neighbour, columns) as far as all floors are nearly level.

    In most columns there are as many surfaces as in the neighbour, each level with its
    counterpart. Returns the number of columns that were linked.
    """
    c, other, count = run
    a, b = starts[c], starts[other]
    done = 0
    while done < count and starts[other + done + 1] - b == starts[c + done + 1] - a:
        done += 1
    level = _level_count(floors, ceilings, a, b, starts[c + done] - a)
    for k in range(level):
        links[a + k, d] = b + k
    for k in range(level):
        links[b + k, d + 4] = a + k
    while starts[c + done] > a + level:
        done -= 1
    return done


@kernel
def link_columns(
    ny: int,
    nx: int,
    starts: NDArray[np.int32],
    floors: NDArray[np.float32],
    ceilings: NDArray[np.float32],
    links: NDArray[np.int32],
) -> None:
    """Fill `links` (S, 8): surfaces of neighbouring columns that are nearest to one another."""
    for j in range(ny):
        for d in range(4):
            if j + LINK_ROWS[d] == ny:
                continue
            i, last = max(0, -LINK_COLUMNS[d]), min(nx, nx - LINK_COLUMNS[d])
            while i < last:
                c = j * nx + i
                other = c + LINK_ROWS[d] * nx + LINK_COLUMNS[d]
                run = c, other, min(last - i, _MOST_AT_ONCE)
                done = _link_level(starts, floors, ceilings, run, d, links)
                i += done
                if done == run[2]:
                    continue
                i += 1
                p0, p1 = starts[c + done], starts[c + done + 1]
                q0, q1 = starts[other + done], starts[other + done + 1]
                for a in range(p0, p1):
                    b = _match(floors, ceilings, a, q0, q1)
                    if b >= 0 and _match(floors, ceilings, b, p0, p1) == a:
                        links[a, d] = b
                        links[b, d + 4] = a


@kernel
def flood(links: NDArray[np.int32], seeds: NDArray[np.int64], reached: NDArray[np.bool_]) -> None:
    """Mark in `reached` (S,) every surface that links lead to from the seeds."""
    stack = np.empty(len(links), dtype=np.int32)
    size = 0
    for seed in seeds:
        if not reached[seed]:
            reached[seed] = True
            stack[size] = seed
            size += 1
    while size > 0:
        size -= 1
        s = stack[size]
        for d in range(8):
            t = links[s, d]
            if t >= 0 and not reached[t]:
                reached[t] = True
                stack[size] = t
                size += 1


@kernel
def keep_surfaces(
    kept: NDArray[np.bool_], links: NDArray[np.int32], renumbered: NDArray[np.int32]
) -> int:
    """Move the links (S, 8) of surfaces that are kept to the front, in place; their number."""
    count = 0
    for s in range(len(kept)):
        renumbered[s] = -1
        if kept[s]:
            renumbered[s] = count
            count += 1
    for s in range(len(kept)):
        if kept[s]:
            for d in range(8):
                t = links[s, d]
                links[renumbered[s], d] = renumbered[t] if t >= 0 else -1
    return count


@kernel
def relate_groups(
    rows: NDArray[np.int32],
    columns: NDArray[np.int32],
    groups: NDArray[np.int16],
    links: NDArray[np.int32],
    overlap: NDArray[np.bool_],
    joined: NDArray[np.bool_],
) -> None:
    """Mark which groups lie above one another anywhere, and which are linked anywhere.

    `overlap` and `joined` are (G, G). A group that has any surface is joined to itself. The
    surfaces of a column follow one another.
    """
    for s in range(len(groups)):
        group = groups[s]
        joined[group, group] = True
        t = s + 1
        while t < len(groups) and columns[t] == columns[s] and rows[t] == rows[s]:
            overlap[group, groups[t]] = True
            overlap[groups[t], group] = True
            t += 1
        for d in range(4):
            t = links[s, d]
            if t >= 0 and groups[t] != group:
                joined[group, groups[t]] = True
                joined[groups[t], group] = True

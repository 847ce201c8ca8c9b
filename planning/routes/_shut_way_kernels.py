"""Looks along a route for bodies that stand in it and leave no room beside them, on bare arrays."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled._heap_kernels import heap_pop, heap_push
from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.grid._grid_kernels import GridArrays, anchor_at, floor_of, follow, length
from esplanade.planning.routes._potential_kernels import PotentialValues, direction_at
from esplanade.planning.scene.heights import BODIES_OVERLAP_M

SAMPLE_M = 0.25
"""The route is looked at every so many metres."""
AHEAD_M = 30.0
"""Bodies further ahead than this are no concern yet."""
BESIDE_M = 2.0
"""A way around bodies leaves the route, and comes back to it, this far from them."""
TOUCH_M = 1e-3
"""A body that nobody is to touch is smaller by this than one that they just touch."""
AROUND_M = 4.5
"""A way around bodies is looked for within this distance of them."""


class LookingSpace(NamedTuple):
    """Memory for one look at a time; `left` (N,) m and `seen` (N,) are of cells."""

    samples: NDArray[np.float64]
    """(S, 2) m: the route."""
    cells: NDArray[np.int64]
    """(S,): the cell of each sample, and (S,) whether it is `taken` by somebody."""
    taken: NDArray[np.bool_]
    left: NDArray[np.float32]
    seen: NDArray[np.int64]
    stamp: NDArray[np.int64]
    keys: NDArray[np.float64]
    items: NDArray[np.int64]


@inlined
def _taken_by(
    bodies: NDArray[np.float64], room_m: float, x: float, y: float, floor_m: float
) -> int:
    """The first of bodies (K, 4), x, y, z and radius, that a centre at a point would touch; -1."""
    for k in range(len(bodies)):
        dx = bodies[k, 0] - x
        dy = bodies[k, 1] - y
        reach = bodies[k, 3] + room_m
        if dx * dx + dy * dy < reach * reach and abs(bodies[k, 2] - floor_m) < BODIES_OVERLAP_M:
            return k
    return -1


@inlined
def _gap(bodies: NDArray[np.float64], room_m: float, x: float, y: float) -> float:
    """Distance from a centre at a point to where it would touch the nearest body, on any floor."""
    least = np.inf
    for k in range(len(bodies)):
        least = min(least, length(bodies[k, 0] - x, bodies[k, 1] - y) - bodies[k, 3])
    return least - room_m


@kernel
def _sample_route(
    grid: GridArrays,
    potential: PotentialValues,
    cell: int,
    x: float,
    y: float,
    bodies: NDArray[np.float64],
    room_m: float,
    space: LookingSpace,
) -> int:
    """Fill the route from a point down a potential; returns the number of its samples.

    Samples that nobody can touch, since the nearest body was further from one before, are free.
    """
    count = 0
    clear = 0  # the number of samples up to which nobody can be touched
    while count < len(space.samples) and cell >= 0:
        space.samples[count, 0] = x
        space.samples[count, 1] = y
        space.cells[count] = cell
        space.taken[count] = False
        if count >= clear:
            gap = _gap(bodies, room_m, x, y)
            if gap > SAMPLE_M:
                clear = count + int(min(gap / SAMPLE_M, 1e6))
            else:
                space.taken[count] = _taken_by(bodies, room_m, x, y, floor_of(grid, cell)) >= 0
        count += 1
        ux, uy, leg = direction_at(grid, potential, cell, x, y)
        if leg <= 1e-4:
            break
        way = min(leg, SAMPLE_M)
        x += way * ux
        y += way * uy
        cell = follow(grid, cell, x, y)
    return count


@kernel
def _leaving_free(
    grid: GridArrays,
    sample: int,
    removes: bool,
    count: int,
    bodies: NDArray[np.float64],
    room_m: float,
    space: LookingSpace,
) -> NDArray[np.float64]:
    """The bodies, changed so that none takes a sample of the route; all samples are told anew.

    Those that take it have no room if this `removes` them: somebody at the goal shuts no way.
    Otherwise they are just so small that they do not take it: who touches them can still leave.
    """
    others = bodies.copy()
    x, y = space.samples[sample]
    floor_m = floor_of(grid, space.cells[sample])
    taker = _taken_by(others, room_m, x, y, floor_m)
    while taker >= 0:
        away_m = length(others[taker, 0] - x, others[taker, 1] - y)
        left_m = 0.0 if removes else max(away_m - TOUCH_M, 0.0)
        others[taker, 3] = left_m - room_m
        taker = _taken_by(others, room_m, x, y, floor_m)
    for k in range(count):
        x, y = space.samples[k]
        floor_m = floor_of(grid, space.cells[k])
        space.taken[k] = _taken_by(others, room_m, x, y, floor_m) >= 0
    return others


@kernel
def _leads_around(
    grid: GridArrays,
    body: int,
    start: int,
    end: int,
    most_m: float,
    bodies: NDArray[np.float64],
    room_m: float,
    space: LookingSpace,
    bumped: NDArray[np.bool_],
) -> bool:
    """Whether a way of at most so many metres leads from cell to cell clear of all bodies.

    The bodies that stand in its way are marked in `bumped` (K,). Ways whose cells lie nearest to
    the end are looked at first (A*): where there is room, few cells are.
    """
    space.stamp[0] += 1
    stamp = space.stamp[0]
    ax, ay = anchor_at(grid, body, start)
    bx, by = anchor_at(grid, body, end)
    steps, links = grid.kinds.steps[body], grid.layered.links
    space.seen[start] = stamp
    space.left[start] = 0.0
    size = heap_push(space.keys, space.items, 0, length(bx - ax, by - ay), start)
    while size > 0:
        key = space.keys[0]
        cell = space.items[0]
        size = heap_pop(space.keys, space.items, size)
        if cell == end:
            return True
        x, y = anchor_at(grid, body, cell)
        way = key - length(bx - x, by - y)
        if way > space.left[cell] + 1e-4:
            continue
        for direction in range(8):
            other = links[cell, direction]
            if other < 0 or not steps[cell] >> direction & 1:
                continue
            ox, oy = anchor_at(grid, body, other)
            further = way + length(ox - x, oy - y)
            if further > most_m or length(ox - ax, oy - ay) > 2.0 * AROUND_M:
                continue
            if space.seen[other] == stamp and space.left[other] <= further + 1e-4:
                continue
            if other != end:
                taker = _taken_by(bodies, room_m, ox, oy, floor_of(grid, other))
                if taker >= 0:
                    bumped[taker] = True
                    continue
            if size + 1 >= len(space.keys):
                return True  # it is wide open
            space.seen[other] = stamp
            space.left[other] = further
            key = further + length(bx - ox, by - oy)
            size = heap_push(space.keys, space.items, size, key, other)
    return False


@kernel
def look_along(
    grid: GridArrays,
    body: int,
    potential: PotentialValues,
    cell: int,
    x: float,
    y: float,
    bodies: NDArray[np.float64],
    room_m: float,
    detour_m: float,
    space: LookingSpace,
    shut_by: NDArray[np.bool_],
) -> None:
    """Mark the standing bodies that shut the route from a point, in a cell, down a potential.

    They do where no way around them, longer than the route by at most `detour_m`, leads back to
    it: `shut_by` (K,) marks them among `bodies` (K, 4), x, y, z and radius in metres. The goal
    itself being taken shuts no way. `room_m` is the radius of the body that goes there, with the
    room that it keeps.
    """
    shut_by[:] = False
    if cell < 0:
        return
    count = _sample_route(grid, potential, cell, x, y, bodies, room_m, space)
    if space.taken[0]:
        bodies = _leaving_free(grid, 0, False, count, bodies, room_m, space)
    if count < len(space.samples) and space.taken[count - 1]:
        bodies = _leaving_free(grid, count - 1, True, count, bodies, room_m, space)
    beside = int(BESIDE_M / SAMPLE_M)
    bumped = np.zeros(len(bodies), dtype=np.bool_)
    k = 0
    while k < count:
        if not space.taken[k]:
            k += 1
            continue
        first = k
        while k < count and space.taken[k]:
            k += 1
        if k >= count:  # up to the goal, or to where nobody looks yet
            break
        start = max(0, first - beside)
        while space.taken[start]:  # by those of the last look
            start += 1
        end = min(count - 1, k + beside)
        while space.taken[end] and end > k:
            end -= 1
        bumped[:] = False
        way_m = (end - start) * SAMPLE_M + detour_m
        if not _leads_around(
            grid, body, space.cells[start], space.cells[end], way_m, bodies, room_m, space, bumped
        ):
            shut_by |= bumped
        k = end
        if space.taken[k]:
            k += 1


@kernel
def look_along_each(
    grid: GridArrays,
    rows: NDArray[np.int64],
    potentials: NDArray[np.float32],
    slots: NDArray[np.int64],
    cells: NDArray[np.int64],
    places: NDArray[np.float64],
    bodies: NDArray[np.float64],
    rooms_m: NDArray[np.float64],
    reach_m: float,
    detour_m: float,
    space: LookingSpace,
    shut: NDArray[np.bool_],
) -> None:
    """Tell in `shut` (N,) whether any body shuts the route of each of N that look, as `look_along`.

    Those further away than `reach_m` are not looked at.
    """
    near = np.empty_like(bodies)
    marks = np.empty(len(bodies), dtype=np.bool_)
    for n in range(len(shut)):
        x, y = places[n]
        count = 0
        for k in range(len(bodies)):
            if length(bodies[k, 0] - x, bodies[k, 1] - y) <= reach_m:
                near[count] = bodies[k]
                count += 1
        shut[n] = False
        if count > 0:
            look_along(
                grid,
                rows[n],
                potentials[slots[n]],
                cells[n],
                x,
                y,
                near[:count],
                rooms_m[n],
                detour_m,
                space,
                marks[:count],
            )
            shut[n] = marks[:count].any()

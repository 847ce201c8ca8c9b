"""Narrow places on the way ahead, found from the ground alone, on bare arrays."""

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.grid._grid_kernels import GridArrays, clearance_at, floor_of, follow, length
from esplanade.planning.routes._potential_kernels import Guide, direction_at

MIDDLE_X, MIDDLE_Y, THROUGH_X, THROUGH_Y, HALF_M, FEET_M = range(6)
FOUND = 6
"""So many numbers tell of a passage: its middle, the unit vector through it (zeros if there is
none), half the width that middles of bodies have in it, and the height of its floor."""
LOOK_IN_S, NEAREST_M, WAITED_S = range(FOUND, FOUND + 3)
PASSAGE = FOUND + 3
"""With those that tell of an actor on its way there: seconds until it looks again, how near to the
middle it has come, and seconds since."""
NARROW_M = 2.2
"""No passage is wider, between where less than `WALL_PART` of the radius is free."""
BEFORE_M = 20.0
"""So far ahead passages are looked for."""
STRAIGHT = 0.9
"""Part of the way to a passage that the straight line there has to be: what lies around a corner
leads nobody to one side of it yet."""
WALL_PART = 0.8
"""What leaves less room than this part of the radius is a side of a passage."""
DEEP_M = 1.0
"""Of so much of a passage, from where the way comes in, the narrowest place counts."""
RAYS = 8
"""Lines along which its width is looked for, before the best is refined."""


@inlined
def _free_way(
    grid: GridArrays,
    body: int,
    cell: int,
    x: float,
    y: float,
    ux: float,
    uy: float,
    room_m: float,
    here_m: float,
    most_m: float,
) -> float:
    """How far a point may go that needs `room_m` and has `here_m` more than that where it is.

    What is further than `most_m` or `NARROW_M` is not looked for: then it is `NARROW_M`.
    """
    shortest = 0.5 * grid.layered.cell_m
    last = min(NARROW_M, most_m + shortest)  # a side is noticed up to a shortest step beyond it
    room = here_m
    way = 0.0
    while True:
        way += max(room, shortest) if grid.flat else min(max(room, shortest), 2.0 * shortest)
        if way >= last:
            return NARROW_M
        cell = follow(grid, cell, x + way * ux, y + way * uy)
        room = clearance_at(grid, body, cell, x + way * ux, y + way * uy) - room_m
        if room < 0.0:
            return max(0.0, way + max(room, -shortest))


@inlined
def _narrowest(
    grid: GridArrays,
    body: int,
    cell: int,
    x: float,
    y: float,
    room_m: float,
    first: float,
    apart: float,
    lines: int,
) -> tuple[float, float, float]:
    """Of lines through a point, at angles first, first + apart, ..., the one that is the shortest
    from side to side: its length, its angle, and how far along it its middle is.

    Only lines shorter than `NARROW_M` count: without one its length is that.
    """
    best = NARROW_M
    turn = 0.0
    aside = 0.0
    here_m = clearance_at(grid, body, cell, x, y) - room_m
    if here_m < 0.0:
        return 0.0, first, 0.0
    for n in range(lines):
        angle = first + n * apart
        ux = np.cos(angle)
        uy = np.sin(angle)
        ahead = _free_way(grid, body, cell, x, y, ux, uy, room_m, here_m, best)
        behind = _free_way(grid, body, cell, x, y, -ux, -uy, room_m, here_m, best - ahead)
        if ahead + behind < best:
            best = ahead + behind
            turn = angle
            aside = 0.5 * (ahead - behind)
    return best, turn, aside


@kernel
def measure_passage(
    grid: GridArrays,
    body: int,
    radius: float,
    cell: int,
    x: float,
    y: float,
    out: NDArray[np.float64],
) -> bool:
    """Whether a point is in a passage; fills `out` (FOUND,).

    The shortest line through the point from side to side, then the shortest through its middle.
    """
    room_m = WALL_PART * radius
    if clearance_at(grid, body, cell, x, y) < room_m:
        return False
    apart = np.pi / RAYS
    width, turn, aside = _narrowest(grid, body, cell, x, y, room_m, 0.0, apart, RAYS)
    if width >= NARROW_M:
        return False
    x += aside * np.cos(turn)
    y += aside * np.sin(turn)
    cell = follow(grid, cell, x, y)
    width, turn, aside = _narrowest(
        grid, body, cell, x, y, room_m, turn - 0.5 * apart, 0.25 * apart, 5
    )
    out[MIDDLE_X] = x + aside * np.cos(turn)
    out[MIDDLE_Y] = y + aside * np.sin(turn)
    out[THROUGH_X] = -np.sin(turn)
    out[THROUGH_Y] = np.cos(turn)
    out[HALF_M] = max(0.0, 0.5 * width - (radius - room_m))
    out[FEET_M] = floor_of(grid, cell)
    return width < NARROW_M


@kernel
def find_passage(
    grid: GridArrays,
    potential: Guide,
    body: int,
    radius: float,
    cell: int,
    x: float,
    y: float,
    out: NDArray[np.float64],
) -> bool:
    """Fill `out` (FOUND,) with the first passage on the way, if one is about straight ahead.

    Its unit vector points the way that one goes through it.
    """
    wide = 0.5 * NARROW_M + radius
    start_x = x
    start_y = y
    way = 0.0
    last_dx = 0.0
    last_dy = 0.0
    most = BEFORE_M
    narrowest = np.inf
    here = np.empty(FOUND)
    while way < most and cell >= 0:
        dx, dy, leg = direction_at(grid, potential, cell, x, y)
        room = clearance_at(grid, body, cell, x, y)
        if room < wide and measure_passage(grid, body, radius, cell, x, y, here):
            if narrowest == np.inf:
                if length(x - start_x, y - start_y) < STRAIGHT * way - grid.layered.cell_m:
                    return False
                most = way + DEEP_M
            if here[HALF_M] < narrowest:
                narrowest = here[HALF_M]
                out[:] = here
                # Ways turn at its corners: both directions together lead through it.
                through = (dx + last_dx) * out[THROUGH_X] + (dy + last_dy) * out[THROUGH_Y]
                if through < 0.0:
                    out[THROUGH_X] *= -1.0
                    out[THROUGH_Y] *= -1.0
        elif narrowest < np.inf:
            break
        if leg == 0.0:
            break
        last_dx = dx
        last_dy = dy
        step = min(leg, max(grid.layered.cell_m, room - wide if grid.flat else 0.0))
        way += step
        x += step * dx
        y += step * dy
        cell = follow(grid, cell, x, y)
    return bool(narrowest < np.inf)

"""Narrow passages on the path ahead, found from the static ground alone, on bare arrays."""

from typing import NamedTuple

import numpy as np

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.grid._grid_kernels import GridArrays, clearance_at, floor_of, follow, length
from esplanade.planning.routes._potential_kernels import PotentialValues, direction_at

PASSAGE = np.dtype(
    [
        ("middle_x", "f8"),
        ("middle_y", "f8"),
        ("along_x", "f8"),
        ("along_y", "f8"),
        ("half_m", "f8"),
        ("floor_m", "f8"),
        ("look_in_s", "f8"),
        ("nearest_m", "f8"),
        ("waited_s", "f8"),
    ]
)
"""An agent's passage, its `PassageShape` in the first six fields, and the agent's progress.

The progress is the time until the agent looks for passages again (`look_in_s`), how near to the
middle it has come (`nearest_m`), and how long ago that was (`waited_s`); metres and seconds.
"""


class PassageShape(NamedTuple):
    """The geometry of a passage, in metres."""

    middle_x: float
    middle_y: float
    along_x: float
    """Unit vector through the passage; zeros where there is no passage."""
    along_y: float
    half_m: float
    """Half the width that centres of bodies have in the passage."""
    floor_m: float
    """Height of the floor."""


NO_PASSAGE = PassageShape(0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@inlined
def _free_distance(
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
    narrow_m: float,
) -> float:
    """Distance that a point with a clearance of at least `room_m` may move in a direction, metres.

    `here_m` is the clearance at its start beyond `room_m`. Distances of more than `most_m` are not
    measured; the result is then `narrow_m`.
    """
    shortest = 0.5 * grid.layered.cell_m
    last = min(narrow_m, most_m + shortest)  # a side is noticed up to a shortest step beyond it
    room = here_m
    way = 0.0
    while True:
        way += max(room, shortest) if grid.flat else min(max(room, shortest), 2.0 * shortest)
        if way >= last:
            return narrow_m
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
    narrow_m: float,
) -> tuple[float, float, float]:
    """The shortest line from side to side through a point: its length, angle and middle.

    Lines at the angles first, first + apart, ... are tried; the middle is given as a distance along
    the line. Only lines shorter than `narrow_m` count; without any the length is `narrow_m`.
    """
    best = narrow_m
    turn = 0.0
    aside = 0.0
    here_m = clearance_at(grid, body, cell, x, y) - room_m
    if here_m < 0.0:
        return 0.0, first, 0.0
    for n in range(lines):
        angle = first + n * apart
        ux = np.cos(angle)
        uy = np.sin(angle)
        ahead = _free_distance(grid, body, cell, x, y, ux, uy, room_m, here_m, best, narrow_m)
        behind = _free_distance(
            grid, body, cell, x, y, -ux, -uy, room_m, here_m, best - ahead, narrow_m
        )
        if ahead + behind < best:
            best = ahead + behind
            turn = angle
            aside = 0.5 * (ahead - behind)
    return best, turn, aside


@kernel
def measure_passage(
    grid: GridArrays,
    rules: np.void,
    body: int,
    radius: float,
    cell: int,
    x: float,
    y: float,
) -> tuple[bool, PassageShape]:
    """Whether a point is in a passage, and the shape of the passage.

    The shortest line through the point from side to side is found first, then the shortest line
    through the middle of that line.
    """
    narrow_m = rules["narrow_m"]
    rays = rules["rays"]
    room_m = rules["wall_part"] * radius
    if clearance_at(grid, body, cell, x, y) < room_m:
        return False, NO_PASSAGE
    apart = np.pi / rays
    width, turn, aside = _narrowest(grid, body, cell, x, y, room_m, 0.0, apart, rays, narrow_m)
    if width >= narrow_m:
        return False, NO_PASSAGE
    x += aside * np.cos(turn)
    y += aside * np.sin(turn)
    cell = follow(grid, cell, x, y)
    width, turn, aside = _narrowest(
        grid, body, cell, x, y, room_m, turn - 0.5 * apart, 0.25 * apart, 5, narrow_m
    )
    shape = PassageShape(
        x + aside * np.cos(turn),
        y + aside * np.sin(turn),
        -np.sin(turn),
        np.cos(turn),
        max(0.0, 0.5 * width - (radius - room_m)),
        floor_of(grid, cell),
    )
    return width < narrow_m, shape


@kernel
def find_passage(
    grid: GridArrays,
    potential: PotentialValues,
    rules: np.void,
    body: int,
    radius: float,
    cell: int,
    x: float,
    y: float,
) -> tuple[bool, PassageShape]:
    """Whether there is a passage about straight ahead on the path to the goal, and its shape.

    The unit vector of the shape points in the direction of the path.
    """
    wide = 0.5 * rules["narrow_m"] + radius
    start_x = x
    start_y = y
    way = 0.0
    last_dx = 0.0
    last_dy = 0.0
    most = rules["ahead_m"]
    narrowest = np.inf
    passage = NO_PASSAGE
    while way < most and cell >= 0:
        dx, dy, leg = direction_at(grid, potential, cell, x, y)
        room = clearance_at(grid, body, cell, x, y)
        narrow = False
        here = NO_PASSAGE
        if room < wide:
            narrow, here = measure_passage(grid, rules, body, radius, cell, x, y)
        if narrow:
            if narrowest == np.inf:
                straight_m = rules["straight_part"] * way
                if length(x - start_x, y - start_y) < straight_m - grid.layered.cell_m:
                    return False, NO_PASSAGE
                most = way + rules["deep_m"]
            if here.half_m < narrowest:
                narrowest = here.half_m
                # Paths turn at its corners: both directions together lead through the passage.
                through = (dx + last_dx) * here.along_x + (dy + last_dy) * here.along_y
                sign = -1.0 if through < 0.0 else 1.0
                passage = PassageShape(
                    here.middle_x,
                    here.middle_y,
                    sign * here.along_x,
                    sign * here.along_y,
                    here.half_m,
                    here.floor_m,
                )
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
    return bool(narrowest < np.inf), passage

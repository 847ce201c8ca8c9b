"""The nearest bodies of each, found in buckets of square cells."""

import math

import numpy as np

from esplanade.planning.compiled.arrays import Floats, Ints
from esplanade.planning.compiled.jit import kernel

NEAREST = 16
"""A person reacts to this many bodies at most, the nearest."""


@kernel
def _bucket(column: int, row: int, buckets: int) -> int:
    return ((column * 73856093) ^ (row * 19349663)) & (buckets - 1)


@kernel
def cells_of(places: Floats, cell_m: float) -> Ints:
    """Columns and rows (B, 2) of the square cells in which B bodies are."""
    cells = np.empty(places.shape, np.int64)
    for b in range(places.shape[0]):
        cells[b, 0] = math.floor(places[b, 0] / cell_m)
        cells[b, 1] = math.floor(places[b, 1] / cell_m)
    return cells


@kernel
def sort_into_buckets(cells: Ints) -> tuple[Ints, Ints]:
    """Bodies in the order of their buckets (B,), and where each bucket begins.

    Memory grows with bodies, however far apart they are: a bucket may hold several cells.
    """
    bodies = cells.shape[0]
    buckets = 4
    while buckets < 2 * bodies:
        buckets *= 2
    begins = np.zeros(buckets + 1, np.int64)
    for b in range(bodies):
        begins[_bucket(cells[b, 0], cells[b, 1], buckets) + 1] += 1
    for k in range(buckets):
        begins[k + 1] += begins[k]
    filled = begins[:-1].copy()
    order = np.empty(bodies, np.int64)
    for b in range(bodies):
        k = _bucket(cells[b, 0], cells[b, 1], buckets)
        order[filled[k]] = b
        filled[k] += 1
    return order, begins


@kernel
def find_nearest(
    body: int,
    places: Floats,
    cells: Ints,
    order: Ints,
    begins: Ints,
    range_m: float,
    found: Ints,
    squares: Floats,
) -> int:
    """Write the nearest bodies within range into `found` (NEAREST,), nearest first; their number.

    Of bodies at the same distance the one with the lower number is nearer. `squares` (NEAREST,)
    is memory for squared distances. Cells are as wide as the range.
    """
    count = 0
    limit = range_m * range_m
    buckets = begins.shape[0] - 1
    for column in range(cells[body, 0] - 1, cells[body, 0] + 2):
        for row in range(cells[body, 1] - 1, cells[body, 1] + 2):
            k = _bucket(column, row, buckets)
            for place in range(begins[k], begins[k + 1]):
                other = order[place]
                if other == body or cells[other, 0] != column or cells[other, 1] != row:
                    continue
                dx = places[other, 0] - places[body, 0]
                dy = places[other, 1] - places[body, 1]
                square = dx * dx + dy * dy
                if square >= limit:
                    continue
                at = count
                while at > 0 and (
                    square < squares[at - 1]
                    or (square == squares[at - 1] and other < found[at - 1])
                ):
                    at -= 1
                if at >= NEAREST:
                    continue
                count = min(NEAREST, count + 1)
                for later in range(count - 1, at, -1):
                    found[later] = found[later - 1]
                    squares[later] = squares[later - 1]
                found[at] = other
                squares[at] = square
    return count

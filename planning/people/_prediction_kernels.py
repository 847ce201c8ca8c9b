"""Prediction of people on bare arrays, Lei & Li, eqs. (1)-(3)."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.handle import Handle
from esplanade.planning.compiled.jit import kernel
from esplanade.planning.grid._grid_kernels import length, surface_at
from esplanade.planning.grid._walking_kernels import GroundArrays, walk
from esplanade.planning.ground._geometry_kernels import Placement, in_bounds, nearest_barrier

PERSON_HEIGHT_M = 1.8
PERSON_STEP_ON_M = 0.6
PERSON_LEG_LENGTH_M = 0.9
"""All people are taken to be adults."""
LIFT_M = 1.0
"""A person who is suddenly this much higher or lower was put there: the past does not count."""


class Prediction(NamedTuple):
    """Likely places of people, slice by slice; slice 0 is now.

    `means` (P, K, 2) m; `velocities` (P, K, 2) m/s; `sigmas` (P, K) m per axis; `heights` (P, K) m
    of the feet; `newest` (P, 2) m/s, the newest velocity alone: the mean of eq. (1) follows a
    turn with a delay.
    """

    means: NDArray[np.float64]
    velocities: NDArray[np.float64]
    sigmas: NDArray[np.float64]
    heights: NDArray[np.float64]
    newest: NDArray[np.float64]


class Tracks(NamedTuple):
    """The past of all people; each person has a row.

    `positions` (R, D, 2) m is a ring of the last D ticks, of which `counts` (R,) are known;
    `heights` (R,) m are those of the feet now; `expected` (R, L, 2) m is another ring, of L ticks:
    the places where people were expected to be L ticks later; `growths2` (R,) m²/s² are the
    squares of the growth of the deviations.
    """

    positions: NDArray[np.float64]
    counts: NDArray[np.int64]
    heights: NDArray[np.float64]
    expected: NDArray[np.float64]
    growths2: NDArray[np.float64]


@kernel
def mean_velocity(track: NDArray[np.float64], known: int, sample_s: float) -> tuple[float, float]:
    """Eq. (1) in the reading that holds on real people: an exponential mean of past velocities.

    `track` (n + 1, 2) holds positions `sample_s` apart, newest first, `known` of them valid.
    Weights are 1/2, 1/4, ... with the oldest velocity taking the rest.
    """
    vx = 0.0
    vy = 0.0
    weight = 1.0
    last = known - 2
    for k in range(known - 1):
        w = weight if k == last else 0.5 * weight
        vx += w * (track[k, 0] - track[k + 1, 0]) / sample_s
        vy += w * (track[k, 1] - track[k + 1, 1]) / sample_s
        weight -= w
    return vx, vy


@kernel
def printed_velocity(
    track: NDArray[np.float64], known: int, sample_s: float
) -> tuple[float, float]:
    """Eq. (1) as printed: v + sum of dv_i / 2**i, dv_i newer minus older."""
    if known < 2:
        return 0.0, 0.0
    vx = (track[0, 0] - track[1, 0]) / sample_s
    vy = (track[0, 1] - track[1, 1]) / sample_s
    scale = 1.0
    for k in range(known - 2):
        vx += scale * (track[k, 0] - 2.0 * track[k + 1, 0] + track[k + 2, 0]) / sample_s
        vy += scale * (track[k, 1] - 2.0 * track[k + 1, 1] + track[k + 2, 1]) / sample_s
        scale *= 0.5
    return vx, vy


@kernel
def note(
    held: Handle[Tracks],
    rows: NDArray[np.int64],
    given: NDArray[np.float64],
    tick: int,
    tick_s: float,
    stride: int,
    memory: float,
    printed: bool,
    places: NDArray[np.float64],
    velocities: NDArray[np.float64],
    newest: NDArray[np.float64],
) -> None:
    """Add where P people are at a tick, given (P, 2 or 3), and work out where they are going.

    Fills `places` (P, 3), the predicted velocities of eq. (1), with samples `stride` ticks apart,
    and the newest ones alone, (P, 2) each. The places expected `expected` ticks ago are
    compared with where people are now: the square of a person's growth is a running mean of their
    squared errors per axis over the squared time.
    """
    tracks = held.value
    depth = tracks.positions.shape[1]
    lag = tracks.expected.shape[1]
    lag_s = lag * tick_s
    now = tick % depth
    slot = tick % lag
    past = np.empty(((depth - 1) // stride + 1, 2))
    for p in range(len(rows)):
        row = rows[p]
        x = given[p, 0]
        y = given[p, 1]
        z = given[p, 2] if given.shape[1] > 2 else 0.0
        places[p, 0] = x
        places[p, 1] = y
        places[p, 2] = z
        if abs(tracks.heights[row] - z) > LIFT_M:
            tracks.counts[row] = 0
        tracks.heights[row] = z
        tracks.positions[row, now, 0] = x
        tracks.positions[row, now, 1] = y
        count = min(tracks.counts[row] + 1, depth)
        tracks.counts[row] = count
        ago = min(count - 1, stride)
        before = tracks.positions[row, (now - ago) % depth]
        newest[p, 0] = (x - before[0]) / (max(ago, 1) * tick_s)
        newest[p, 1] = (y - before[1]) / (max(ago, 1) * tick_s)
        known = (count - 1) // stride + 1
        vx = newest[p, 0]
        vy = newest[p, 1]
        if known > 1:
            for k in range(known):
                past[k] = tracks.positions[row, (now - k * stride) % depth]
            if printed:
                vx, vy = printed_velocity(past, known, stride * tick_s)
            else:
                vx, vy = mean_velocity(past, known, stride * tick_s)
        velocities[p, 0] = vx
        velocities[p, 1] = vy
        expected = tracks.expected[row, slot]
        if count > lag + stride:
            missed = (x - expected[0]) ** 2 + (y - expected[1]) ** 2
            tracks.growths2[row] += memory * (missed / (2.0 * lag_s**2) - tracks.growths2[row])
        expected[0] = x + vx * lag_s
        expected[1] = y + vy * lag_s


@kernel
def extrapolate(
    ground: Handle[GroundArrays],
    held: Handle[Tracks],
    rows: NDArray[np.int64],
    places: NDArray[np.float64],
    velocity: NDArray[np.float64],
    slice_s: float,
    sigma_0: float,
    least_growth: float,
    wall_clearance: float,
    prediction: Prediction,
) -> None:
    """Eqs. (2) and (3): means and deviations of every slice, bent along walls.

    `rows` (P,) are those of the tracks, `places` (P, 3) where everyone is. People do not walk
    through walls or off edges: a mean that runs into one slides along it, and its velocity becomes
    that of the slide. They leave a layer only where it is joined to another.
    """
    grid, index = ground.value
    bounds = (grid.layered.x0, grid.layered.y0, grid.layered.x1, grid.layered.y1)
    person = Placement(0.0, 0.0, PERSON_HEIGHT_M, PERSON_STEP_ON_M, PERSON_LEG_LENGTH_M)
    people, slices = prediction.sigmas.shape
    for p in range(people):
        x = places[p, 0]
        y = places[p, 1]
        z = places[p, 2]
        cell = -1 if grid.flat else surface_at(grid, x, y, z)
        vx = velocity[p, 0]
        vy = velocity[p, 1]
        dx = vx * slice_s
        dy = vy * slice_s
        step_m = length(dx, dy)
        free_m = 0.0
        growth = max(np.sqrt(held.value.growths2[rows[p]]), least_growth)
        for k in range(slices):
            if k > 0:
                nx = x
                ny = y
                if grid.flat and free_m <= step_m:
                    near_m = nearest_barrier(index, person, wall_clearance, x, y)[0]
                    free_m = min(near_m, index.reach_m) - wall_clearance
                if grid.flat and free_m > step_m and in_bounds(bounds, x + dx, y + dy):
                    nx = x + dx  # nothing can be met in this slice
                    ny = y + dy
                    free_m -= step_m
                elif cell >= 0 or grid.flat:
                    cell, nx, ny = walk(
                        grid,
                        index,
                        PERSON_HEIGHT_M,
                        PERSON_STEP_ON_M,
                        PERSON_LEG_LENGTH_M,
                        cell,
                        x,
                        y,
                        dx,
                        dy,
                        wall_clearance,
                    )
                    free_m = 0.0
                prediction.velocities[p, k, 0] = (nx - x) / slice_s
                prediction.velocities[p, k, 1] = (ny - y) / slice_s
                x = nx
                y = ny
            else:
                prediction.velocities[p, k, 0] = vx
                prediction.velocities[p, k, 1] = vy
            on_ground = cell >= 0 and not grid.flat
            prediction.heights[p, k] = grid.layered.floors[cell] if on_ground else z
            prediction.means[p, k, 0] = x
            prediction.means[p, k, 1] = y
            prediction.sigmas[p, k] = sigma_0 + growth * k * slice_s

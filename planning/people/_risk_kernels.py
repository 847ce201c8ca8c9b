"""Risk on bare arrays, Lei & Li, eq. (5)."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import inlined, kernel
from esplanade.planning.grid._grid_kernels import GridArrays, floor_of
from esplanade.planning.people._prediction_kernels import Prediction
from esplanade.planning.scene.heights import BODIES_OVERLAP_M


class RadialTables(NamedTuple):
    """Risk that one predicted person adds, by deviation (rows) and distance (columns).

    An agent of another radius is in contact at another distance, so that there is a table for each
    of B contact distances. `values` (B, S, C, 2) holds the proximity term and the factor of the
    closing speed over the distance, whose product with the offset is the factor times n. Both are
    means over the person's likely range. Columns are even in the squared distance, so that no root
    has to be drawn.
    `reaches` (S,) m tells for each row how far away a person matters, to any agent.
    """

    values: NDArray[np.float32]
    reaches: NDArray[np.float64]
    sigma_step_m: float
    squared_step_m2: float


class RiskArrays(NamedTuple):
    """The future of people as risk is made of it, and an index of people to ask, slice by slice.

    `people` (K, P, 6) are x, y m, vx, vy m/s, height of the feet m, and how far they matter m;
    `rows` (K, P) those of the tables. `starts` (K, buckets + 1) and `members` (K, M) list for each
    bucket the people who matter within `slack_m` of any place in it.
    """

    tables: RadialTables
    people: NDArray[np.float64]
    rows: NDArray[np.int64]
    starts: NDArray[np.int64]
    members: NDArray[np.int64]
    x0: float
    y0: float
    bucket_m: float
    slack_m: float
    nx: int
    ny: int


@inlined
def _column(risk: RiskArrays, x: float) -> int:
    return min(risk.nx - 1, max(0, int((x - risk.x0) * (1.0 / risk.bucket_m))))


@inlined
def _row(risk: RiskArrays, y: float) -> int:
    return min(risk.ny - 1, max(0, int((y - risk.y0) * (1.0 / risk.bucket_m))))


@kernel
def index_people(
    prediction: Prediction,
    last_wider: int,
    around: tuple[float, float, float, float],
    first: int,
    step: int,
    risk: RiskArrays,
) -> None:
    """Fill slices first, first + step, ... (a counting sort for each).

    After slice `last_wider` deviations grow no more. The agents that will ask are in the box
    `around` (x0, y0, x1, y1) now, and get `slack_m` further in two slices: people that they cannot
    come near are left out.
    """
    tables = risk.tables
    people = len(prediction.means)
    buckets = risk.nx * risk.ny
    box = np.empty((people, 4), dtype=np.int64)
    for k in range(first, len(risk.people), step):
        starts = risk.starts[k]
        members = risk.members[k]
        starts[:] = 0
        for p in range(people):
            sigma = prediction.sigmas[p, min(k, last_wider)]
            row = min(len(tables.reaches) - 1, int(sigma / tables.sigma_step_m + 0.5))
            x = prediction.means[p, k, 0]
            y = prediction.means[p, k, 1]
            room = tables.reaches[row] + risk.slack_m
            far = room + 0.5 * k * risk.slack_m
            box[p, 0] = 0
            box[p, 1] = -1
            if (
                x + far < around[0]
                or y + far < around[1]
                or x - far > around[2]
                or y - far > around[3]
            ):
                continue
            risk.rows[k, p] = row
            known = risk.people[k, p]
            known[0] = x
            known[1] = y
            known[2] = prediction.velocities[p, k, 0]
            known[3] = prediction.velocities[p, k, 1]
            known[4] = prediction.heights[p, k]
            known[5] = tables.reaches[row]
            box[p, 0] = _row(risk, y - room)
            box[p, 1] = _row(risk, y + room)
            box[p, 2] = _column(risk, x - room)
            box[p, 3] = _column(risk, x + room)
            for j in range(box[p, 0], box[p, 1] + 1):
                for b in range(j * risk.nx + box[p, 2], j * risk.nx + box[p, 3] + 1):
                    starts[b + 1] += 1
        for b in range(buckets):
            starts[b + 1] += starts[b]
        entries = starts[buckets]
        for p in range(people - 1, -1, -1):
            for j in range(box[p, 0], box[p, 1] + 1):
                for b in range(j * risk.nx + box[p, 2], j * risk.nx + box[p, 3] + 1):
                    starts[b + 1] -= 1
                    members[starts[b + 1]] = p
        for b in range(buckets):
            starts[b] = starts[b + 1]
        starts[buckets] = entries


@inlined
def people_near(
    risk: RiskArrays,
    flat: bool,
    feet_m: float,
    k: int,
    x: float,
    y: float,
    within_m: float,
    out: NDArray[np.int64],
) -> int:
    """List the people who matter at slice k within some metres of a place, and count them.

    People on the floor at `feet_m`, that of the node, count wherever its moves lead. `out` takes
    as many as it has room for.
    """
    count = 0
    b = _row(risk, y) * risk.nx + _column(risk, x)
    for m in range(risk.starts[k, b], risk.starts[k, b + 1]):
        p = risk.members[k, m]
        known = risk.people[k, p]
        rx = x - known[0]
        ry = y - known[1]
        most = known[5] + within_m
        if rx * rx + ry * ry < most * most and (flat or abs(known[4] - feet_m) < BODIES_OVERLAP_M):
            if count == len(out):
                break
            out[count] = p
            count += 1
    return count


@inlined
def _terms(
    risk: RiskArrays, contact: int, k: int, p: int, x: float, y: float
) -> tuple[float, float, float, float]:
    """Terms of a person at (x, y) in one table: proximity p, p·n (two numbers), p·(v_o·n)."""
    known = risk.people[k, p]
    rx = x - known[0]
    ry = y - known[1]
    squared = rx * rx + ry * ry
    if squared >= known[5] * known[5]:
        return 0.0, 0.0, 0.0, 0.0
    u = squared * (1.0 / risk.tables.squared_step_m2)
    c = int(u)
    w = u - c
    row = risk.tables.values[contact, risk.rows[k, p]]
    near = (1.0 - w) * row[c, 0] + w * row[c + 1, 0]
    toward = (1.0 - w) * row[c, 1] + w * row[c + 1, 1]
    return near, toward * rx, toward * ry, toward * (known[2] * rx + known[3] * ry)


@inlined
def risk_among(
    risk: RiskArrays,
    contact: int,
    listed: NDArray[np.int64],
    count: int,
    k: int,
    x: float,
    y: float,
    vx: float,
    vy: float,
    closing_weight: float,
) -> float:
    """Risk of being at (x, y) with velocity (vx, vy) at slice k, among the people listed.

    `contact` is the table of the contact distance that holds for the agent that asks.

    proximity + closing_weight * max(0, sum of p (v_o - v_r)·n), n from the person to here.
    """
    near = 0.0
    closing = 0.0
    for n in range(count):
        one, nx, ny, theirs = _terms(risk, contact, k, listed[n], x, y)
        near += one
        closing += theirs - vx * nx - vy * ny
    return float(near + closing_weight * max(0.0, closing))


@inlined
def risk_at(
    grid: GridArrays,
    risk: RiskArrays,
    contact: int,
    k: int,
    cell: int,
    x: float,
    y: float,
    vx: float,
    vy: float,
    closing_weight: float,
) -> float:
    """`risk_among` all people who matter there, on the floor of a cell."""
    feet_m = floor_of(grid, cell)
    near = 0.0
    closing = 0.0
    b = _row(risk, y) * risk.nx + _column(risk, x)
    for m in range(risk.starts[k, b], risk.starts[k, b + 1]):
        p = risk.members[k, m]
        if grid.flat or abs(risk.people[k, p, 4] - feet_m) < BODIES_OVERLAP_M:
            one, nx, ny, theirs = _terms(risk, contact, k, p, x, y)
            near += one
            closing += theirs - vx * nx - vy * ny
    return float(near + closing_weight * max(0.0, closing))


@kernel
def risk_many(
    grid: GridArrays,
    risk: RiskArrays,
    contact: int,
    k: int,
    cells: NDArray[np.int64],
    positions: NDArray[np.float64],
    velocities: NDArray[np.float64],
    closing_weight: float,
    out: NDArray[np.float64],
) -> None:
    """`risk_at` for (N,), (N, 2), (N, 2) -> out (N,); 0 where nobody can stand."""
    for n in range(len(positions)):
        out[n] = 0.0
        if cells[n] >= 0:
            out[n] = risk_at(
                grid,
                risk,
                contact,
                k,
                cells[n],
                positions[n, 0],
                positions[n, 1],
                velocities[n, 0],
                velocities[n, 1],
                closing_weight,
            )

"""A plain space-time A* among moving discs, on bare arrays."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.jit import kernel

CELL_M = 0.25
HEADINGS = 8
NO_NODE = -1


class Problem(NamedTuple):
    """The input of one decision with K steps ahead, in metres, seconds and m/s."""

    x: float
    y: float
    vx: float
    vy: float
    goal_x: float
    goal_y: float
    tolerance_m: float
    speed_mps: float
    acceleration_mps2: float
    step_s: float
    tracks: NDArray[np.float64]
    """(P, K + 1, 2): the positions of P people at each step; nan where a person is absent."""
    distances_m: NDArray[np.float64]
    """(K + 1,): the smallest allowed distance to people at each step."""
    walls: NDArray[np.float64]
    """(M, 2, 2): the two ends of each wall."""
    wall_m: float
    """The smallest allowed distance to walls."""


class Nodes(NamedTuple):
    """The memory of a search for N nodes: their data, a heap, and a hash table."""

    places: NDArray[np.float64]
    """(N, 4): x, y, vx, vy."""
    costs: NDArray[np.float64]
    steps: NDArray[np.int64]
    parents: NDArray[np.int64]
    wanted: NDArray[np.float64]
    """(N, 2): the velocity that the step to the node aims at."""
    keys: NDArray[np.float64]
    heap: NDArray[np.int64]
    table: NDArray[np.int64]
    """(4 N, 2): a hash table from the key of cell, step and heading to the best node."""


@kernel
def _swept(ox: float, oy: float, dx: float, dy: float) -> float:
    """Smallest length of o + u d for u from 0 to 1."""
    square = dx * dx + dy * dy
    u = 0.0
    if square > 1e-12:
        u = min(1.0, max(0.0, -(ox * dx + oy * dy) / square))
    return float(np.hypot(ox + u * dx, oy + u * dy))


@kernel
def _hits_person(p: Problem, k: int, x0: float, y0: float, x1: float, y1: float) -> bool:
    """Whether the motion from 0 to 1 in step k comes too near to a person.

    If the two are too near already, motions that move them apart are allowed.
    """
    for i in range(len(p.tracks)):
        bx = p.tracks[i, k + 1, 0]
        if np.isnan(p.tracks[i, k, 0]) or np.isnan(bx):
            continue
        ox = x0 - p.tracks[i, k, 0]
        oy = y0 - p.tracks[i, k, 1]
        ex = x1 - bx
        ey = y1 - p.tracks[i, k + 1, 1]
        near = _swept(ox, oy, ex - ox, ey - oy)
        if near < min(p.distances_m[k + 1], np.hypot(ox, oy) - 1e-9):
            return True
    return False


@kernel
def _hits_wall(p: Problem, x0: float, y0: float, x1: float, y1: float) -> bool:
    """Whether the line from 0 to 1 crosses a wall or ends too near one.

    If 0 is too near already, lines that lead away from the wall are allowed.
    """
    for m in range(len(p.walls)):
        ax = p.walls[m, 0, 0]
        ay = p.walls[m, 0, 1]
        dx = p.walls[m, 1, 0] - ax
        dy = p.walls[m, 1, 1] - ay
        side0 = dx * (y0 - ay) - dy * (x0 - ax)
        side1 = dx * (y1 - ay) - dy * (x1 - ax)
        if side0 * side1 < 0.0:
            sx = x1 - x0
            sy = y1 - y0
            if (sx * (ay - y0) - sy * (ax - x0)) * (
                sx * (ay + dy - y0) - sy * (ax + dx - x0)
            ) < 0.0:
                return True
        before = _swept(ax - x0, ay - y0, dx, dy)
        if _swept(ax - x1, ay - y1, dx, dy) < min(p.wall_m, before):
            return True
    return False


@kernel
def _push(nodes: Nodes, size: int, node: int) -> int:
    """Put a node on the heap of `size` nodes; returns the new size."""
    at = size
    nodes.heap[at] = node
    while at > 0:
        up = (at - 1) // 2
        if nodes.keys[nodes.heap[up]] <= nodes.keys[node]:
            break
        nodes.heap[at] = nodes.heap[up]
        at = up
    nodes.heap[at] = node
    return size + 1


@kernel
def _pop(nodes: Nodes, size: int) -> int:
    """Take the node with the smallest key off the heap of `size` nodes, and return it.

    The caller lowers the size by one.
    """
    top = nodes.heap[0]
    node = nodes.heap[size - 1]
    at = 0
    while True:
        down = 2 * at + 1
        if down >= size - 1:
            break
        if down + 1 < size - 1 and (
            nodes.keys[nodes.heap[down + 1]] < nodes.keys[nodes.heap[down]]
        ):
            down += 1
        if nodes.keys[nodes.heap[down]] >= nodes.keys[node]:
            break
        nodes.heap[at] = nodes.heap[down]
        at = down
    nodes.heap[at] = node
    return int(top)


@kernel
def _slot(nodes: Nodes, p: Problem, x: float, y: float, vx: float, vy: float, step: int) -> int:
    """The row of the hash table for a configuration; a free row is taken if it has none yet."""
    cx = int(np.floor((x - p.x) / CELL_M)) + 512
    cy = int(np.floor((y - p.y) / CELL_M)) + 512
    heading = HEADINGS
    if np.hypot(vx, vy) > 0.3:
        heading = int(np.floor(np.arctan2(vy, vx) / (2.0 * np.pi) * HEADINGS + 0.5)) % HEADINGS
    key = ((cx * 1024 + cy) * 64 + step) * 16 + heading
    rows = len(nodes.table)
    row = (key * 2654435761) % rows
    while nodes.table[row, 1] != NO_NODE and nodes.table[row, 0] != key:
        row = (row + 1) % rows
    nodes.table[row, 0] = key
    return int(row)


@kernel
def search(
    p: Problem, directions: NDArray[np.float64], speeds: NDArray[np.float64], nodes: Nodes
) -> tuple[int, int]:
    """Search for the least time to the goal, or to the last step.

    Returns the final node and the number of expanded nodes. The node is `NO_NODE` if no motion is
    possible at all. `parents` leads back from it to the start, which is node 0.
    """
    steps = len(p.distances_m) - 1
    room = len(nodes.costs)
    nodes.table[:, 1] = NO_NODE
    nodes.places[0] = (p.x, p.y, p.vx, p.vy)
    nodes.costs[0] = 0.0
    nodes.steps[0] = 0
    nodes.parents[0] = NO_NODE
    nodes.keys[0] = 0.0
    count = 1
    size = _push(nodes, 0, 0)
    best = NO_NODE
    expanded = 0
    while size > 0:
        node = _pop(nodes, size)
        size -= 1
        x, y, vx, vy = nodes.places[node]
        k = nodes.steps[node]
        if k > 0 and (best == NO_NODE or k > nodes.steps[best]):
            best = node
        if k > 0 and (k == steps or np.hypot(p.goal_x - x, p.goal_y - y) <= p.tolerance_m):
            return node, expanded
        if count + len(directions) * len(speeds) + 2 > room:
            break
        expanded += 1
        to_x = p.goal_x - x
        to_y = p.goal_y - y
        away = np.hypot(to_x, to_y)
        for d in range(-1, len(directions)):
            for s in range(len(speeds) + (d < 0)):
                if s == len(speeds):
                    ux, uy = 0.0, 0.0
                elif d < 0:
                    pace = min(speeds[s], away / p.step_s) / max(away, 1e-9)
                    ux, uy = to_x * pace, to_y * pace
                else:
                    ux, uy = directions[d, 0] * speeds[s], directions[d, 1] * speeds[s]
                change = np.hypot(ux - vx, uy - vy)
                ramp_s = change / p.acceleration_mps2
                if ramp_s > p.step_s:
                    share = p.step_s / ramp_s
                    wx, wy = vx + (ux - vx) * share, vy + (uy - vy) * share
                    nx = x + 0.5 * (vx + wx) * p.step_s
                    ny = y + 0.5 * (vy + wy) * p.step_s
                else:
                    wx, wy = ux, uy
                    nx = x + ux * p.step_s - 0.5 * (ux - vx) * ramp_s
                    ny = y + uy * p.step_s - 0.5 * (uy - vy) * ramp_s
                if _hits_person(p, k, x, y, nx, ny) or _hits_wall(p, x, y, nx, ny):
                    continue
                left = np.hypot(p.goal_x - nx, p.goal_y - ny)
                cost = nodes.costs[node] + p.step_s + 0.05 * change
                row = _slot(nodes, p, nx, ny, wx, wy, k + 1)
                old = nodes.table[row, 1]
                key = cost + left / p.speed_mps - 1e-3 * (k + 1)
                if old != NO_NODE and nodes.keys[old] <= key:
                    continue
                nodes.table[row, 1] = count
                nodes.places[count] = (nx, ny, wx, wy)
                nodes.costs[count] = cost
                nodes.steps[count] = k + 1
                nodes.parents[count] = node
                nodes.wanted[count] = (ux, uy)
                nodes.keys[count] = key
                size = _push(nodes, size, count)
                count += 1
    return best, expanded

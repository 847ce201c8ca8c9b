"""Ways to a goal by the textbook: Dijkstra over cells, and over a graph of what sees what."""

from __future__ import annotations

import heapq
import math
from collections.abc import Iterable, Iterator, Mapping
from itertools import combinations
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from tests.naive.geometry import Point, inside, point_segment_distance, segment_distance

Cell = tuple[int, int]
Node = TypeVar("Node")
Segment = tuple[Point, Point]


def clearance_field(
    segments: Iterable[Segment],
    rings: Iterable[list[Point]],
    bounds: tuple[float, float, float, float],
    cell_m: float,
    cap_m: float,
) -> NDArray[np.float64]:
    """Distance from every cell's centre to the nearest segment, negative inside a ring."""
    x0, y0, x1, y1 = bounds
    shape = (math.ceil((y1 - y0) / cell_m), math.ceil((x1 - x0) / cell_m))
    segments, rings = list(segments), list(rings)
    out = np.empty(shape)
    for j, i in np.ndindex(shape):
        p = (x0 + (i + 0.5) * cell_m, y0 + (j + 0.5) * cell_m)
        away = min([cap_m, *(point_segment_distance(p, *segment) for segment in segments)])
        out[j, i] = -away if any(inside(p, ring) for ring in rings) else away
    return out


def dijkstra(ways: Mapping[Node, Mapping[Node, float]], start: Node) -> dict[Node, float]:
    """Length of the shortest way from the start to every node that can be reached."""
    settled: dict[Node, float] = {}
    queue = [(0.0, 0, start)]
    pushed = 0
    while queue:
        length, _, node = heapq.heappop(queue)
        if node in settled:
            continue
        settled[node] = length
        for other, way in ways[node].items():
            if other not in settled:
                pushed += 1
                heapq.heappush(queue, (length + way, pushed, other))
    return settled


def nf1(free: NDArray[np.bool_], goal: Cell, cell_m: float) -> NDArray[np.float64]:
    """Metres to the goal's cell over free cells, eight neighbours, no cut corners; inf if none."""

    def neighbours(j: int, i: int) -> Iterator[tuple[Cell, float]]:
        for dj in (-1, 0, 1):
            for di in (-1, 0, 1):
                to = (j + dj, i + di)
                on_grid = 0 <= to[0] < free.shape[0] and 0 <= to[1] < free.shape[1]
                if (dj or di) and on_grid and free[to] and free[j, to[1]] and free[to[0], i]:
                    yield to, cell_m * math.hypot(dj, di)

    cells = {(j, i): dict(neighbours(j, i)) for j, i in np.ndindex(*free.shape)}
    out = np.full(free.shape, np.inf)
    for cell, length in dijkstra(cells, goal).items():
        out[cell] = length
    return out


def shortest_way(
    walls: list[Segment], start: Point, goal: Point, radius_m: float, corners: int = 48
) -> float:
    """Length of the shortest way of a disc around thin walls; at most 1/4 % too long.

    A graph of what sees what: the ends of walls are surrounded by polygons whose sides touch the
    circle that the disc's centre may not enter.
    """
    around = radius_m / math.cos(math.pi / corners)
    turns = [2.0 * math.pi * k / corners for k in range(corners)]
    nodes = [start, goal]
    for x, y in {end for wall in walls for end in wall}:
        nodes += [(x + around * math.cos(t), y + around * math.sin(t)) for t in turns]
    ways: dict[int, dict[int, float]] = {k: {} for k in range(len(nodes))}
    for a, b in combinations(range(len(nodes)), 2):
        p, q = nodes[a], nodes[b]
        if all(segment_distance(p, q, *wall) >= radius_m - 1e-9 for wall in walls):
            ways[a][b] = ways[b][a] = math.dist(p, q)
    return dijkstra(ways, 0).get(1, math.inf)

"""Standing surfaces the long way: every column and every pair of surfaces by itself."""

from __future__ import annotations

import itertools
import math

from tests.naive.geometry import inside

LOWEST_M = 1.0
LINK_M = 1.2
ROOM_M = 0.5
NEIGHBOURS = ((0, 1), (1, 1), (1, 0), (1, -1), (0, -1), (-1, -1), (-1, 0), (-1, 1))

Column = list[tuple[float, float]]
"""Floor and ceiling of each surface, lowest first."""


def columns_of_scene(scene, cell_m: float) -> dict[tuple[int, int], Column]:
    """The surfaces over every cell's centre: tops and ground that no solid buries."""
    x0, y0, x1, y1 = scene.bounds
    found = {}
    for j in range(math.ceil((y1 - y0) / cell_m)):
        for i in range(math.ceil((x1 - x0) / cell_m)):
            x, y = x0 + (i + 0.5) * cell_m, y0 + (j + 0.5) * cell_m
            here = [s for s in scene.solids() if inside((x, y), list(s.points))]
            floors = {0.0} | {s.top_at(x, y) for s in here if s.kind not in ("plant", "water")}
            found[j, i] = []
            for floor in sorted(floors):
                higher = [s.offset_m for s in here if s.top_at(x, y) > floor + 1e-4]
                ceiling = min(higher, default=math.inf)
                if ceiling - floor >= LOWEST_M - 1e-4:
                    found[j, i].append((floor, ceiling))
    return found


def columns_of_triangles(triangles, raster) -> dict[tuple[int, int], Column]:
    """The surfaces over every cell's centre, by a vertical line through all triangles."""
    found, hits = {}, {}
    for j in range(raster.ny):
        for i in range(raster.nx):
            x, y = raster.x0 + (i + 0.5) * raster.cell_m, raster.y0 + (j + 0.5) * raster.cell_m
            hits[j, i] = sorted(h for t in triangles if (h := _hit(t.tolist(), x, y)) is not None)
            found[j, i] = []
            for k, (floor, kind) in enumerate(hits[j, i]):
                higher = [z for z, _ in hits[j, i][k + 1 :] if z > floor + 0.01]
                ceiling = min(higher, default=math.inf)
                if kind == "up" and ceiling - floor >= LOWEST_M:
                    found[j, i].append((floor, ceiling))
    return {cell: _with_gaps(cell, column, found, hits[cell]) for cell, column in found.items()}


def _with_gaps(cell, column: Column, found, hits) -> Column:
    """A column and what lies over gaps and sides of steps in it, between neighbours either side."""
    j, i = cell
    heights = [height for height, _ in hits]
    added: Column = []
    for dj, di in ((0, 1), (1, 0), (1, 1), (1, -1)):
        one, two = (j - dj, i - di), (j + dj, i + di)
        for a, b in itertools.product(found.get(one, ()), found.get(two, ())):
            low, high = sorted((a[0], b[0]))
            if high - low <= 0.1:
                z = top = high = (low + high) / 2
                if dj * di or any(abs(height - z) < LOWEST_M for height in heights):
                    continue
            else:
                side = [h for h in heights if low - 0.01 <= h <= high + 0.01]
                if high - low > LINK_M + 0.01 or not side:
                    continue
                z, top = (low if side[-1] - low < high - side[-1] + 0.01 else high), high + 0.01
            ceiling = min([a[1], b[1], *(height for height in heights if height > top)])
            others = [floor for floor, _ in [*column, *added]]
            if ceiling - high >= LOWEST_M and all(abs(floor - z) >= LOWEST_M for floor in others):
                added.append((z, ceiling))
    floors = sorted([*column, *added])
    return [
        (floor, min([ceiling, *(higher for higher, _ in floors[k + 1 :])]))
        for k, (floor, ceiling) in enumerate(floors)
    ]


def _hit(triangle, x: float, y: float) -> tuple[float, str] | None:
    a, b, c = triangle
    u = [b[k] - a[k] for k in range(3)]
    v = [c[k] - a[k] for k in range(3)]
    normal = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
    if normal[2] == 0.0 or not inside((x, y), [p[:2] for p in triangle]):
        return None
    z = a[2] - ((x - a[0]) * normal[0] + (y - a[1]) * normal[1]) / normal[2]
    flat = normal[2] / math.hypot(*normal)
    return z, "up" if flat >= math.cos(math.pi / 4) else "other"


def links(columns: dict[tuple[int, int], Column]) -> set[tuple[tuple[int, int, int], int]]:
    """(row, column, number from below) and direction of every link."""
    found = set()
    for (j, i), surfaces in columns.items():
        for d, (dj, di) in enumerate(NEIGHBOURS):
            others = columns.get((j + dj, i + di), [])
            for k, surface in enumerate(surfaces):
                best = _nearest(surface, others)
                if best is not None and _nearest(others[best], surfaces) == k:
                    found.add(((j, i, k), d))
    return found


def _nearest(surface: tuple[float, float], others: Column) -> int | None:
    fits = [
        (abs(floor - surface[0]), k)
        for k, (floor, ceiling) in enumerate(others)
        if abs(floor - surface[0]) <= LINK_M + 1e-4
        and min(ceiling, surface[1]) - max(floor, surface[0]) >= ROOM_M
    ]
    return min(fits)[1] if fits else None

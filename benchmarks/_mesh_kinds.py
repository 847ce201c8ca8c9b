"""Meshes of several kinds, each of about so many triangles, z up, metres."""

from collections.abc import Callable
from typing import Final

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Vector = tuple[float, float, float]

_LONGEST_M: Final = 640.0


def sheet(origin: Vector, along: Vector, across: Vector, columns: int, rows: int) -> Floats:
    """A rectangle in triangles, (2 * columns * rows, 3, 3); it looks to along x across."""
    u, v = np.meshgrid(np.linspace(0, 1, columns + 1), np.linspace(0, 1, rows + 1), indexing="ij")
    at = np.array(origin) + u[..., None] * np.array(along) + v[..., None] * np.array(across)
    a, b, c, d = at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]
    return np.concatenate(
        [np.stack(each, axis=-2).reshape(-1, 3, 3) for each in ((a, b, c), (a, c, d))]
    )


def block(low: Vector, high: Vector, edge_m: float) -> Floats:
    """A box whose sides are cut into squares of about that edge."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    dx, dy, dz = x1 - x0, y1 - y0, z1 - z0
    i, j, k = (max(1, round(length / edge_m)) for length in (dx, dy, dz))
    return np.concatenate(
        [
            sheet((x0, y0, z1), (dx, 0, 0), (0, dy, 0), i, j),
            sheet((x0, y0, z0), (0, dy, 0), (dx, 0, 0), j, i),
            sheet((x0, y0, z0), (dx, 0, 0), (0, 0, dz), i, k),
            sheet((x1, y1, z0), (-dx, 0, 0), (0, 0, dz), i, k),
            sheet((x1, y0, z0), (0, dy, 0), (0, 0, dz), j, k),
            sheet((x0, y1, z0), (0, -dy, 0), (0, 0, dz), j, k),
        ]
    )


def hills(triangles: int) -> Floats:
    """A ground of little hills in squares of 25 cm."""
    side = max(1, round((triangles / 2) ** 0.5))
    width = side * min(0.25, _LONGEST_M / side)
    found = sheet((0, 0, 0), (width, 0, 0), (0, width, 0), side, side)
    found[..., 2] += 0.1 * np.sin(0.5 * found[..., 0]) * np.cos(0.5 * found[..., 1])
    return found


def terrain(triangles: int) -> Floats:
    """As large a ground as a scene may be, with hills of 20 m and waves of 1 m."""
    side = max(1, round((triangles / 2) ** 0.5))
    found = sheet((0, 0, 0), (_LONGEST_M, 0, 0), (0, _LONGEST_M, 0), side, side)
    x, y = found[..., 0], found[..., 1]
    found[..., 2] += 20.0 * np.sin(x / 60.0) * np.cos(y / 45.0) + np.sin(x / 2.3)
    return found


def building(triangles: int) -> Floats:
    """Twelve storeys of rooms with desks, and stairs between them, finely cut."""
    edge_m = 0.5
    while 12 * len(storey := _storey(0.0, edge_m)) < triangles:
        edge_m *= max(0.7, (12 * len(storey) / triangles) ** 0.5) * 0.999
    return np.concatenate([storey + np.array((0.0, 0.0, 3.0 * level)) for level in range(12)])


def _storey(z: float, edge_m: float) -> Floats:
    parts = [
        block((0, 0, z - 0.3), (60, 36, z), edge_m),
        block((0, 36, z - 0.3), (52, 40, z), edge_m),
    ]
    for x in np.arange(6.0, 54.0, 6.0).tolist():
        for low, high in (((x, 0), (x + 0.15, 14)), ((x, 20), (x + 0.15, 34)),
                          ((x, 14), (x + 4.5, 14.15)), ((x, 20), (x + 4.5, 20.15))):  # fmt: skip
            parts.append(block((*low, z), (*high, z + 2.7), edge_m))
        for k in range(6):
            at = x + 1.5 + 2.0 * (k % 2), 3.0 + 4.0 * (k // 2)
            parts.append(block((*at, z), (at[0] + 0.8, at[1] + 1.6, z + 0.75), edge_m / 2))
    for k in range(20):
        x, top = 52.0 + 0.3 * k, z + 0.15 * (k + 1)
        parts.append(block((x, 36.5, top - 0.17), (x + 0.32, 39.5, top), edge_m))
    return np.concatenate(parts)


def city(triangles: int) -> Floats:
    """Four hundred towers with finely cut sides on a ground of 600 m."""
    chance = np.random.default_rng(5)
    parts = [sheet((0, 0, 0), (600, 0, 0), (0, 600, 0), 300, 300)]
    for number in range(400):
        x, y = (number % 20) * 30.0 + 3.0, (number // 20) * 30.0 + 3.0
        width, depth, height = chance.uniform((10, 10, 8), (24, 24, 60)).tolist()
        area = 2.0 * (width * height + depth * height + width * depth)
        edge_m = (2.0 * area / max(12.0, (triangles - 180_000) / 400)) ** 0.5
        parts.append(block((x, y, 0.0), (x + width, y + depth, height), edge_m))
    return np.concatenate(parts)


def rubble(triangles: int) -> Floats:
    """Half of it a ground, half small triangles anywhere above, as bad scans have them."""
    chance = np.random.default_rng(3)
    half = triangles // 2
    ground = sheet((0, 0, 0), (150, 0, 0), (0, 100, 0), *(round((half / 2 * k) ** 0.5) or 1 for k in (1.5, 1 / 1.5)))  # noqa: E501  # fmt: skip
    ground[..., 2] += 0.05 * np.sin(3.0 * ground[..., 0])
    middles = chance.uniform((0, 0, 0), (150, 100, 6), (half, 3))
    return np.concatenate([ground, middles[:, None] + chance.normal(0, 0.05, (half, 3, 3))])


KINDS: Final[dict[str, Callable[[int], Floats]]] = {
    each.__name__: each for each in (hills, terrain, building, city, rubble)
}

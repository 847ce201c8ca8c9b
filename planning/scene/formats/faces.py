"""Faces of three and more corners, cut into triangles in the plane of each face."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field
from typing import Final

import numpy as np
from mapbox_earcut import triangulate_float64
from numpy.typing import NDArray

MAX_CORNERS: Final = 20_000
"""Most corners of one face: to cut it may take their square."""
_PIECE: Final = 65_536
"""Corners that are looked at together: they stay near the processor."""
_AREA_SHARE: Final = 1e-6
"""The triangles of a face may differ from its area by this share of it."""

_Floats = NDArray[np.float64]
_Ints = NDArray[np.int64]


@dataclass(frozen=True)
class Faces:
    """Corners, and faces that name them one after the other."""

    vertices: _Floats
    """(N, 3)."""
    corners: _Ints
    """(C,): the vertices of all faces, face by face."""
    sizes: _Ints
    """(F,): corners of each face."""
    passed: Counter[str] = field(default_factory=Counter)
    """The parts of the file that are passed over, with their counts."""
    unit: str = ""
    """The name of the unit of length that the file says; empty where it says none."""


@dataclass(frozen=True)
class Triangles:
    """Triangles, and what was passed over to get them."""

    points: _Floats
    """(T, 3, 3)."""
    passed: Counter[str] = field(default_factory=Counter)
    told: tuple[str, ...] = ()
    """Further facts that the file tells, such as the names of its storeys."""
    unit: str = ""
    """The name of the unit of the points; empty where the file says none, or they are in metres."""


def cut(faces: Faces) -> Triangles:
    """Triangles that fill the faces, each turned as its face is.

    Faces of fewer than three corners or without an area, and those that cross themselves, are
    passed over and counted.

    Raises
    ------
    ValueError
        A face has more than `MAX_CORNERS` corners.
    """
    passed = Counter(faces.passed)
    sizes = faces.sizes
    if len(sizes) and sizes.max() > MAX_CORNERS:
        raise ValueError(f"a face has {sizes.max()} corners, {MAX_CORNERS} are possible")
    passed["faces of fewer than three corners"] += int((sizes < 3).sum())
    starts = np.cumsum(sizes) - sizes
    parts = [np.empty((0, 3, 3))]
    for size in np.unique(sizes[sizes >= 3]).tolist():
        begins = starts[sizes == size]
        each = max(1, _PIECE // size)
        for first in range(0, len(begins), each):
            places = begins[first : first + each, None] + np.arange(size)
            rings = faces.vertices[faces.corners[places]]
            parts.append(rings if size == 3 else _cut_rings(rings, passed))
    return Triangles(np.concatenate(parts), +passed, unit=faces.unit)


def _cut_rings(rings: _Floats, passed: Counter[str]) -> _Floats:
    """Triangles of rings of the same number of corners, (F, n, 3)."""
    to = rings - rings[:, :1]
    fan = 0.5 * np.cross(to[:, 1:-1], to[:, 2:])
    normal = fan.sum(axis=1)
    area = np.linalg.norm(normal, axis=1)
    finite = np.isfinite(rings).all(axis=(1, 2))
    flat = finite & (area <= 1e-12 * np.ptp(to, axis=1).max(axis=1) ** 2)
    passed["faces of no area"] += int(flat.sum())
    unit = normal / np.where(area > 0.0, area, 1.0)[:, None]
    edges = np.roll(rings, -1, axis=1) - rings
    turns = np.einsum("fnk,fk->fn", np.cross(edges, np.roll(edges, -1, axis=1)), unit)
    sweeps = np.einsum("fnk,fk->fn", fan, unit)
    least = -1e-9 * area[:, None]
    convex = ((turns >= least).all(axis=1) & (sweeps >= least).all(axis=1)) | ~finite
    whole = rings[convex & ~flat]
    corner = np.broadcast_to(whole[:, :1], whole[:, 1:-1].shape)
    parts = [np.stack([corner, whole[:, 1:-1], whole[:, 2:]], axis=2).reshape(-1, 3, 3)]
    for k in np.flatnonzero(~convex & ~flat).tolist():
        clipped = _clip_ears(to[k], unit[k], float(area[k]))
        if clipped is None:
            passed["faces that cross themselves"] += 1
        else:
            parts.append(rings[k][clipped])
    return np.concatenate(parts)


def _clip_ears(ring: _Floats, unit: _Floats, area: float) -> _Ints | None:
    """Triangles (T, 3) of a ring in the plane across `unit`; None where it crosses itself."""
    axis = np.eye(3)[np.abs(unit).argmin()]
    east = np.cross(axis, unit)
    east /= np.linalg.norm(east)
    flat = np.ascontiguousarray(ring @ np.stack([east, np.cross(unit, east)]).T)
    found = triangulate_float64(flat, np.array([len(flat)], dtype=np.uint32))
    triangles = np.asarray(found, dtype=np.int64).reshape(-1, 3)
    a, b, c = (flat[triangles[:, k]] for k in range(3))
    areas = 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])
    if abs(np.abs(areas).sum() - area) > _AREA_SHARE * area:
        return None
    backward = areas < 0.0
    triangles[backward] = triangles[backward, ::-1]
    return triangles

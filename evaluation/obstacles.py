"""Exact distances from obstacles, which are straight walls and circles."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from esplanade.recordings import Obstacles

Floats = NDArray[np.float64]

CIRCLE_SIDES: Final = 8
"""Lines of sight are tested against straight walls alone; a circle becomes this many."""

_PARALLEL: Final = 1e-12


class ObstacleSet:
    """The obstacles of a recording as arrays."""

    def __init__(self, obstacles: Obstacles) -> None:
        self.obstacles = obstacles
        self.segments = np.array(obstacles.segments, dtype=np.float64).reshape(-1, 2, 2)
        self.circles = np.array(obstacles.circles, dtype=np.float64).reshape(-1, 3)
        self.outline = np.concatenate(
            [self.segments, *(_corners(*circle) for circle in obstacles.circles)]
        )
        """All obstacles as straight walls, float64 (M, 2, 2), metres; circles are replaced by
        inscribed polygons."""

    def distance(self, point: Floats) -> float:
        """Distance of a point (2,) to the nearest obstacle, metres.

        It is infinite if there are no obstacles, and negative inside a circle.
        """
        distances = [np.inf]
        if len(self.segments):
            distances.append(float(point_segment_distances(point, self.segments).min()))
        if len(self.circles):
            away = np.linalg.norm(self.circles[:, :2] - point, axis=1) - self.circles[:, 2]
            distances.append(float(away.min()))
        return min(distances)


def _corners(x: float, y: float, radius_m: float) -> Floats:
    angles = np.arange(CIRCLE_SIDES + 1) * (2.0 * np.pi / CIRCLE_SIDES)
    ring = np.column_stack([x + radius_m * np.cos(angles), y + radius_m * np.sin(angles)])
    return np.stack([ring[:-1], ring[1:]], axis=1)


def point_segment_distances(points: Floats, segments: Floats) -> Floats:
    """Distances of points to segments, float64 (M,).

    `points` is (2,), one point that is compared with all segments, or (M, 2), one point for each
    segment. `segments` is (M, 2, 2), or (1, 2, 2) if one segment is compared with all points.
    """
    starts = segments[:, 0]
    along = segments[:, 1] - starts
    squares = np.maximum((along * along).sum(axis=1), _PARALLEL)
    share = np.clip(((points - starts) * along).sum(axis=1) / squares, 0.0, 1.0)
    return np.asarray(np.linalg.norm(starts + share[:, None] * along - points, axis=1))


def segment_segment_distances(start: Floats, end: Floats, segments: Floats) -> Floats:
    """Distances of one segment from `start` to `end` to M segments (M, 2, 2), float64 (M,).

    The distance is 0 where the segments cross.
    """
    line = np.stack([start, end])[None]
    nearest = np.minimum.reduce(
        [
            point_segment_distances(start, segments),
            point_segment_distances(end, segments),
            point_segment_distances(segments[:, 0], line),
            point_segment_distances(segments[:, 1], line),
        ]
    )
    step = end - start
    along = segments[:, 1] - segments[:, 0]
    offset = segments[:, 0] - start
    cross = step[0] * along[:, 1] - step[1] * along[:, 0]
    meets = np.abs(cross) > _PARALLEL
    safe = np.where(meets, cross, 1.0)
    on_line = (offset[:, 0] * along[:, 1] - offset[:, 1] * along[:, 0]) / safe
    on_wall = (offset[:, 0] * step[1] - offset[:, 1] * step[0]) / safe
    crosses = meets & (on_line >= 0.0) & (on_line <= 1.0) & (on_wall >= 0.0) & (on_wall <= 1.0)
    return np.where(crosses, 0.0, nearest)

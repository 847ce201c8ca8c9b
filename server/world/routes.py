"""Routes for people who want to walk to a point: a few straight legs around obstacles."""

import math
from typing import Final

import numpy as np

from esplanade.planning import LayeredGrid, Potential
from esplanade.planning.scene.heights import SAME_SURFACE_M

Point = tuple[float, float, float]
"""x, y and the height of the floor, metres."""
Route = tuple[Point, ...]
"""The ends of straight legs, the goal last."""

STEP_M: Final = 0.2
TURN_COS: Final = math.cos(math.radians(2.0))


def straight_route(
    grid: LayeredGrid, start: Point, goal: Point, clearance_m: float
) -> Route | None:
    """The goal itself, if it is free and nothing stands between; quick."""
    if not grid.is_free([goal[:2]], [goal[2]], clearance_m)[0]:
        return None
    line = np.subtract(goal[:2], start[:2])
    reached, heights = grid.walk([start[:2]], [start[2]], [line], clearance_m)
    there = math.dist(reached[0], goal[:2]) < 1e-6 and abs(heights[0] - goal[2]) < SAME_SURFACE_M
    return (goal,) if there else None


def find_route(grid: LayeredGrid, start: Point, goal: Point, clearance_m: float) -> Route | None:
    """A shortest route to the free place nearest to the goal; None where there is no route.

    Cost: that of a potential where no straight line leads there. Some 40 ms in 64 m, half a second
    at 150 m a side and more than a minute at 650 m, so not for the event loop.
    """
    free = grid.nearest_free(goal[:2], goal[2], clearance_m)
    if free is None:
        return None
    goal = (*free, grid.floor_at(free, goal[2]))
    return straight_route(grid, start, goal, clearance_m) or _around(grid, start, goal, clearance_m)


def _around(grid: LayeredGrid, start: Point, goal: Point, clearance_m: float) -> Route | None:
    potential = Potential(grid, goal[:2], goal[2], clearance_m)
    here, heights = np.array([start[:2]]), np.array([start[2]])
    distance_m = float(potential.distance(here, heights)[0])
    if not math.isfinite(distance_m):
        return None
    legs: list[Point] = []
    heading = potential.direction(here, heights)[0]
    for _ in range(int(2.0 * distance_m / STEP_M) + 10):
        near = math.dist(here[0], goal[:2]) <= STEP_M
        if near and abs(heights[0] - goal[2]) < SAME_SURFACE_M:
            return (*legs, goal)
        direction = potential.direction(here, heights)[0]
        if direction @ heading < TURN_COS:
            legs.append((float(here[0, 0]), float(here[0, 1]), float(heights[0])))
            heading = direction
        here, heights = grid.walk(here, heights, [STEP_M * direction], clearance_m)
    return None

"""A walk down the waypoints of a wave, step by step in plain Python."""

import math

import numpy as np

from esplanade.planning import Body, LayeredGrid
from esplanade.planning.grid._side_kernels import is_cut_off
from esplanade.planning.routes.wave_front import WaveFront

Place = tuple[float, float, float]
PIECE_M = 0.07
"""Steps are walked in pieces that are no longer."""


def descend(
    grid: LayeredGrid,
    wave: WaveFront,
    start: Place,
    toward: tuple[float, float],
    goal: Place,
    clearance_m: float,
    step_m: float,
    turn_cos: float,
    most: int,
) -> list[Place] | None:
    """The corners of the way; None if the goal is not reached in so many steps."""
    corners: list[Place] = []
    here, height = np.array(start[:2]), start[2]
    waypoint = np.array(toward)
    heading = None
    for _ in range(most):
        cell = int(grid.on_ground([here], [height])[1][0])
        if math.dist(here, goal[:2]) <= step_m and abs(height - goal[2]) < 1.0:
            return corners
        row = grid.row_of(Body.adult())
        if wave.settled[cell] and not is_cut_off(grid.arrays, row, cell, *map(float, here)):
            left_m, *place = wave.values[cell, :3].tolist()
            if math.dist(here, place) < 0.25 * grid.cell_m and left_m > 0.0:
                place = wave.values[int(grid.on_ground([place], [height])[1][0]), 1:3].tolist()
            waypoint = np.array(place)
        leg = waypoint - here
        length_m = math.hypot(*leg)
        if length_m < 1e-4:
            return None
        direction = leg / length_m
        if heading is None:
            heading = direction
        elif direction @ heading < turn_cos:
            corners.append((float(here[0]), float(here[1]), height))
            heading = direction
        pieces = math.ceil(step_m / PIECE_M)
        for _ in range(pieces):
            moved, heights = grid.walk([here], [height], [step_m / pieces * direction], clearance_m)
            here, height = moved[0], float(heights[0])
    return None

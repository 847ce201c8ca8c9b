"""Scenes in which many actors change sides, with the start and goal of each."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from esplanade.planning import Scene

Floats = NDArray[np.float64]

APART_M: Final = 1.5
"""The spacing of goals in a room; it lets others pass between actors that have arrived."""
FILE_M: Final = 1.2
"""The spacing within a group on the square."""
RIM_M: Final = 0.8
"""The spacing on the circle, where nobody has to pass between actors that have arrived."""
MARGIN_M: Final = 3.0
"""The open ground extends this far beyond starts and goals."""


@dataclass(frozen=True)
class Swap:
    """A scene with the starts and goals of A actors, (A, 2) each, metres."""

    name: str
    scene: Scene
    starts: Floats
    goals: Floats


def doorway(actors: int, door_m: float, random: np.random.Generator) -> Swap:
    """Two rooms that share a doorway; everyone goes to a random goal in the other room."""
    half = -(-actors // 2)
    columns = int(np.ceil(np.sqrt(half)))
    spots = _lattice(half, columns, APART_M)
    depth = MARGIN_M + columns * APART_M
    height = (-(-half // columns) + 1) * APART_M
    left = spots + np.array([APART_M / 2, APART_M])
    right = np.array([2.0 * depth, 0.0]) + left * (-1.0, 1.0)
    walls = (
        ((depth, 0.0), (depth, (height - door_m) / 2)),
        ((depth, (height + door_m) / 2), (depth, height)),
    )
    starts = np.concatenate([left, right])[:actors]
    goals = np.concatenate([random.permutation(right), random.permutation(left)])[:actors]
    scene = Scene.open_space((0.0, 0.0, 2.0 * depth, height), walls=walls)
    return Swap(f"doorway of {door_m:g} m", scene, _shaken(starts, 0.2, random), goals)


def square(actors: int, random: np.random.Generator) -> Swap:
    """Four groups on the sides of a square; each goes straight to the opposite side."""
    quarter = -(-actors // 4)
    columns = int(np.ceil(np.sqrt(2 * quarter)))
    depth = -(-quarter // columns) * FILE_M
    side = (columns + 1) * FILE_M
    group = _lattice(quarter, columns, FILE_M) - ((columns - 1) * FILE_M / 2, 0.0)
    group[:, 1] += side / 2
    far = group - (0.0, side + depth - FILE_M)
    middle = MARGIN_M + depth + side / 2
    turns = [
        np.array([[c, -s], [s, c]], dtype=float) for c, s in ((1, 0), (0, 1), (-1, 0), (0, -1))
    ]
    starts = np.concatenate([group @ turn.T for turn in turns])[:actors]
    goals = np.concatenate([far @ turn.T for turn in turns])[:actors]
    scene = Scene.open_space((0.0, 0.0, 2.0 * middle, 2.0 * middle))
    return Swap("square", scene, middle + _shaken(starts, 0.2, random), middle + goals)


def circle(actors: int, random: np.random.Generator) -> Swap:
    """Everyone goes to the opposite point of a circle."""
    radius = max(3.0, actors * RIM_M / (2.0 * np.pi))
    turns = 2.0 * np.pi * (np.arange(actors) + random.uniform(-0.1, 0.1, actors)) / actors
    rim = radius * np.stack([np.cos(turns), np.sin(turns)], axis=1)
    middle = radius + MARGIN_M
    scene = Scene.open_space((0.0, 0.0, 2.0 * middle, 2.0 * middle))
    return Swap("circle", scene, middle + rim, middle - rim)


SWAPS: Final[dict[str, Callable[[int, float, np.random.Generator], Swap]]] = {
    "doorway": doorway,
    "square": lambda actors, _, random: square(actors, random),
    "circle": lambda actors, _, random: circle(actors, random),
}
"""The scenes by name; each takes the number of actors, the width of the doorway in metres, and a
random generator."""


def _lattice(count: int, columns: int, apart_m: float) -> Floats:
    """The first `count` points of a lattice of `columns` columns, (count, 2), metres."""
    numbers = np.arange(count)
    return np.asarray(apart_m * np.stack([numbers % columns, numbers // columns], axis=1))


def _shaken(points: Floats, most_m: float, random: np.random.Generator) -> Floats:
    """Points that are moved at random a little, so that nothing is exactly symmetric."""
    return points + random.uniform(-most_m, most_m, points.shape)

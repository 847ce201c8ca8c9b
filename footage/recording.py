"""Films a walk: the steps that the server would begin, and the bodies that browsers would draw."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.locomotion.aims import AHEAD, AHEAD_S, Course
from esplanade.actors.locomotion.builds import physique_of
from esplanade.actors.locomotion.ground import Ground
from esplanade.actors.locomotion.motion import Steps
from esplanade.actors.locomotion.reference.posing import Pose, pose
from esplanade.actors.locomotion.stance import Build
from esplanade.actors.locomotion.walkers import Walkers
from esplanade.footage.walks import TICK_S, Floats, Walk
from esplanade.planning import LayeredGrid

_CELL_M: Final = 0.25
_SLOT: Final = np.zeros(1, dtype=np.int64)
_TICKS_AHEAD: Final = round(AHEAD_S / TICK_S)


class Footprint(NamedTuple):
    """Where a foot stood."""

    place: Floats
    """(4,): x, y, z of the heel, heading."""
    right: bool
    since_s: float


@dataclass(frozen=True)
class Recording:
    """F frames of one body."""

    walk: Walk
    times_s: Floats
    """(F,)"""
    poses: Pose
    """Of F rows."""
    footprints: tuple[Footprint, ...]
    build: Build
    steps: int
    """How many were begun, those included that only went on otherwise."""


def record(walk: Walk, frames_a_second: float, seed: int = 0) -> Recording:
    """Walk it through and keep every frame."""
    physique = physique_of(seed, 1)
    build = Build(np.array([physique.leg_m]), np.array([physique.stature_m]))
    grid = LayeredGrid.from_scene(walk.scene, _CELL_M)
    begun = []

    def carry(steps: Steps, _slots: NDArray[np.int64]) -> Steps:
        begun.append(steps)
        return steps

    walkers = Walkers(1, Ground(walk.scene, grid), TICK_S, carry)
    courses = _courses(walk, grid)
    walkers.join(0, _SLOT, [physique], courses[0])
    poses: list[Pose] = []
    times: list[float] = []
    prints: list[Footprint] = []
    for tick, course in enumerate(courses):
        walkers.update(tick, _SLOT, course)
        step = walkers.steps
        _keep_print(prints, step.standing[0].copy(), bool(step.right[0]), tick * TICK_S)
        while len(times) / frames_a_second < (tick + 1) * TICK_S - 1e-9:
            seconds = len(times) / frames_a_second
            poses.append(pose(step, step.share(seconds / TICK_S), build))
            times.append(seconds)
    _keep_print(prints, walkers.steps.landing[0].copy(), not walkers.steps.right[0], times[-1])
    together = Pose._make(np.concatenate(rows) for rows in zip(*poses, strict=True))
    return Recording(walk, np.array(times), together, tuple(prints), build, len(begun))


def _keep_print(prints: list[Footprint], place: Floats, right: bool, since_s: float) -> None:
    for known in prints:
        if known.right == right and np.allclose(known.place, place, atol=1e-6):
            return
    prints.append(Footprint(place, right, since_s))


def _courses(walk: Walk, grid: LayeredGrid) -> list[Course]:
    """What the server would say of the body at each tick."""
    heights = _heights(walk.places, grid)
    last = len(walk.places) - 1
    made = []
    for tick in range(last + 1):
        if walk.planned:
            ahead = np.minimum(tick + _TICKS_AHEAD * np.arange(AHEAD), last)
            places, up = walk.places[ahead], heights[ahead]
        else:
            moved = walk.places[tick] - walk.places[max(tick - 1, 0)]
            places = walk.places[tick] + np.outer(_TICKS_AHEAD * np.arange(AHEAD), moved)
            up = np.full(AHEAD, heights[tick])
        made.append(Course(walk.headings[[tick]], np.column_stack((places, up))[None]))
    return made


def _heights(places: Floats, grid: LayeredGrid) -> Floats:
    """Heights of the floors walked on, (T,)."""
    made, height = [], 0.0
    for x, y in places.tolist():
        height = grid.floor_at((x, y), height)
        made.append(height)
    return np.array(made)

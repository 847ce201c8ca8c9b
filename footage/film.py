"""Films a walk: the steps that the server begins, and the bodies that browsers draw."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from esplanade.actors.locomotion.body.sizes import BodySizes
from esplanade.actors.locomotion.body.traits import traits_of
from esplanade.actors.locomotion.footsteps.course import AHEAD, AHEAD_S, Course
from esplanade.actors.locomotion.footsteps.ground import Ground
from esplanade.actors.locomotion.footsteps.walkers import Walkers
from esplanade.actors.locomotion.motion.key_poses import Steps
from esplanade.actors.locomotion.reference.posing import Pose, pose
from esplanade.footage.walks import TICK_S, Walk
from esplanade.planning import LayeredGrid
from esplanade.planning.compiled.arrays import Floats, Ints

_CELL_M: Final = 0.25
_SLOT: Final = np.zeros(1, dtype=np.int64)
_TICKS_AHEAD: Final = round(AHEAD_S / TICK_S)


class FilmedFootprint(NamedTuple):
    """A footprint on which a foot stood during a film."""

    place: Floats
    """(4,): x, y, z of the heel, heading."""
    right: bool
    """Whether the right foot stood on it."""
    since_s: float
    """Time at which it was first stood on."""


@dataclass(frozen=True)
class Film:
    """F frames of one body on a walk."""

    walk: Walk
    times_s: Floats
    """(F,): from the beginning of the walk."""
    poses: Pose
    """Joints of the body, a row for each of the F frames."""
    footprints: tuple[FilmedFootprint, ...]
    """The footprints in the order in which they were first stood on."""
    sizes: BodySizes
    steps: int
    """Number of steps begun, those included that were only re-aimed."""


def film_walk(walk: Walk, frames_a_second: float, seed: int = 0) -> Film:
    """Film a walk from beginning to end; the seed decides whose body walks."""
    traits = traits_of(seed, 1)
    sizes = BodySizes(np.array([traits.leg_m]), np.array([traits.stature_m]))
    grid = LayeredGrid.from_scene(walk.scene, _CELL_M)
    begun = []

    def publish(steps: Steps, _slots: Ints) -> Steps:
        begun.append(steps)
        return steps

    walkers = Walkers(1, Ground(walk.scene, grid), TICK_S, publish)
    courses = _courses(walk, grid)
    walkers.join(0, _SLOT, [traits], courses[0])
    poses: list[Pose] = []
    times: list[float] = []
    prints: list[FilmedFootprint] = []
    for tick, course in enumerate(courses):
        walkers.update(tick, _SLOT, course)
        step = walkers.steps
        _keep_print(prints, step.standing[0].copy(), bool(step.on_right[0]), tick * TICK_S)
        while len(times) / frames_a_second < (tick + 1) * TICK_S - 1e-9:
            seconds = len(times) / frames_a_second
            poses.append(pose(step, step.share(seconds / TICK_S), sizes))
            times.append(seconds)
    _keep_print(prints, walkers.steps.landing[0].copy(), not walkers.steps.on_right[0], times[-1])
    together = Pose._make(np.concatenate(rows) for rows in zip(*poses, strict=True))
    return Film(walk, np.array(times), together, tuple(prints), sizes, len(begun))


def _keep_print(prints: list[FilmedFootprint], place: Floats, right: bool, since_s: float) -> None:
    """Add a footprint (4,) unless this foot has stood on it before."""
    for known in prints:
        if known.right == right and np.allclose(known.place, place, atol=1e-6):
            return
    prints.append(FilmedFootprint(place, right, since_s))


def _courses(walk: Walk, grid: LayeredGrid) -> list[Course]:
    """The courses that the server would give for the body, one for each tick."""
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
    """Heights (T,) of the floors walked on."""
    made, height = [], 0.0
    for x, y in places.tolist():
        height = grid.floor_at((x, y), height)
        made.append(height)
    return np.array(made)

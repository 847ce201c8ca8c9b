"""Measures how far the bodies that clients draw from records of steps are from the exact ones.

    python -m benchmarks.records                                  all walks, half a minute
    python -m benchmarks.records --ticks 400 --json records.json
    python -m benchmarks.records --picture docs/images/step-record.svg

A record holds the ends of a step in fine quanta, and the keys between as small differences in
coarse ones (docs/protocol.md). The benchmark takes the steps of actors in the served worlds, on
stairs too, and those of people who turn suddenly, stop, and turn in place. It poses each step at 21
even shares twice: with the keys as they were computed, and with those that a client reads. The exit
code is 1 if one in a hundred ankles is more than 3 mm off, hips 2 mm, pelvises 0.5 degrees or hands
15 mm.
"""

import argparse
import json
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Final, NamedTuple
from unittest import mock

import numpy as np
from benchmarks._record_picture import draw_step
from rich.console import Console
from rich.table import Table

from esplanade import scenes
from esplanade.actors.locomotion.body.sizes import BodySizes
from esplanade.actors.locomotion.body.traits import traits_of
from esplanade.actors.locomotion.footsteps.course import AHEAD, AHEAD_S, Course
from esplanade.actors.locomotion.footsteps.ground import Ground
from esplanade.actors.locomotion.footsteps.walkers import Walkers
from esplanade.actors.locomotion.motion.key_poses import Steps
from esplanade.actors.locomotion.reference.posing import Pose, pose
from esplanade.planning import LayeredGrid, Scene
from esplanade.planning.compiled.arrays import Floats, Ints
from esplanade.planning.scene.scene_file import read_scene
from esplanade.protocol.steps import STEP, StepRecords
from esplanade.server.populating import populate
from esplanade.server.world import walking
from esplanade.server.world.rules import Rules
from esplanade.server.world.step_records import from_records, to_records
from esplanade.server.world.zone import Zone

TICK_S: Final = 0.05
SEED: Final = 5
SHARES: Final = np.linspace(0.0, 1.0, 21)
LIMITS: Final = {"ankles": 3.0, "hips": 2.0, "pelvis": 0.5, "hands": 15.0}
"""The error that one observation in a hundred may reach: mm, and degrees of the pelvis."""
PLACES: Final = ("hips", "knees", "ankles", "toes", "head", "hands")
_RULES: Final = Rules(
    person_radius_m=0.25,
    person_clearance_m=0.25,
    person_max_speed_mps=3.0,
    person_walk_speed_mps=1.6,
    view_radius_m=40.0,
    view_limit=100,
    steps_radius_m=25.0,
    steps_limit=60,
    viewer_bytes=12_000,
    tick_rate=20,
)


class Walked(NamedTuple):
    """Steps before they were quantised, and the bodies that took them."""

    steps: Steps
    sizes: BodySizes


def main(argv: Sequence[str] | None = None) -> int:
    options = parser().parse_args(argv)
    walks = {name: actors(name, options.ticks) for name in ("plaza.json", "gallery.json")}
    walks["steered people"] = steered_people(options.ticks)
    found = {name: deviations(walked) for name, walked in walks.items()}
    show(Console(), walks, found)
    if options.json is not None:
        figures = {
            "step_bytes": STEP.itemsize,
            "off": {
                name: {part: percentiles(off) for part, off in parts.items()}
                for name, parts in found.items()
            },
        }
        options.json.write_text(json.dumps(figures, indent=1) + "\n")
    if options.picture is not None:
        draw_step(options.picture, *walks["gallery.json"])
    return int(any(falls_short(parts) for parts in found.values()))


def parser() -> argparse.ArgumentParser:
    """The parser of the options."""
    made = argparse.ArgumentParser(prog="python -m benchmarks.records", description=__doc__)
    made.formatter_class = argparse.RawDescriptionHelpFormatter
    made.add_argument("--ticks", type=int, default=1200, help="ticks walked [default: 1200]")
    made.add_argument("--json", type=Path, metavar="F")
    made.add_argument("--picture", type=Path, metavar="F", help="of a step on stairs, SVG or PNG")
    return made


# --- walks ------------------------------------------------------------------------------------


def actors(name: str, ticks: int, count: int = 30) -> Walked:
    """The steps of actors on their ways in a scene that comes with Esplanade."""
    scene = read_scene(Path(scenes.__path__[0], name))
    grid = LayeredGrid.from_scene(scene)
    population, bodies = populate(grid, scene, count, TICK_S, SEED)
    world = Zone(
        scene,
        grid,
        population,
        bodies,
        _RULES,
        tick_s=TICK_S,
        max_people=1,
        seed=SEED,
        clock=time.perf_counter,
    )
    kept: list[tuple[Steps, Ints]] = []

    def keep(steps: Steps, ids: Ints) -> StepRecords:
        kept.append((steps, ids))
        return to_records(steps, ids)

    with mock.patch.object(walking, "to_records", keep):
        for _ in range(ticks):
            world.begin([])
            world.finish(world.think())
    population.close()
    return _walked(kept)


def steered_people(ticks: int, count: int = 30) -> Walked:
    """The steps of people who turn suddenly at up to 2 m/s, stop, and turn in place."""
    random = np.random.default_rng(SEED)
    scene = Scene.open_space((-200.0, -200.0, 200.0, 200.0))
    kept: list[tuple[Steps, Ints]] = []

    def publish(steps: Steps, slots: Ints) -> Steps:
        kept.append((steps, slots))
        return from_records(to_records(steps, slots))

    walkers = Walkers(count, Ground(scene, LayeredGrid.from_scene(scene, 2.0)), TICK_S, publish)
    slots, places = np.arange(count), random.uniform(-20.0, 20.0, (count, 3))
    places[:, 2] = 0.0
    velocities, headings = np.zeros((count, 3)), np.zeros(count)
    times = (np.arange(AHEAD) * AHEAD_S)[:, None]
    for tick in range(ticks):
        anew = np.flatnonzero(random.random(count) < 1.0 / 30.0)
        headings[anew] += random.uniform(-3.0, 3.0, len(anew))
        speeds = np.maximum(random.uniform(-0.7, 2.0, len(anew)), 0.0)
        ways = np.stack([np.cos(headings[anew]), np.sin(headings[anew])], axis=1)
        velocities[anew, :2] = speeds[:, None] * ways
        places += velocities * TICK_S
        course = Course(headings.copy(), places[:, None] + times * velocities[:, None])
        if tick == 0:
            walkers.join(tick, slots, [traits_of(0, slot) for slot in slots.tolist()], course)
        else:
            walkers.update(tick, slots, course)
    return _walked(kept, 0)


def _walked(kept: list[tuple[Steps, Ints]], seed: int = SEED) -> Walked:
    steps = Steps._make(np.concatenate(parts) for parts in zip(*(s for s, _ in kept), strict=True))
    traits = [traits_of(seed, who) for who in np.concatenate([ids for _, ids in kept]).tolist()]
    walks = steps.ticks > 0
    sizes = BodySizes(
        np.array([each.leg_m for each in traits])[walks],
        np.array([each.stature_m for each in traits])[walks],
    )
    return Walked(steps.take(walks), sizes)


# --- deviations -------------------------------------------------------------------------------


def deviations(walked: Walked) -> dict[str, Floats]:
    """The error of each part in each pose: millimetres, and degrees of the pelvis."""
    exact, sizes = walked
    count = len(exact.ticks)
    known = from_records(to_records(exact, np.arange(count)))
    parts: dict[str, list[Floats]] = {name: [] for name in (*PLACES, "pelvis")}
    for share in SHARES:
        shares = np.full(count, share)
        one, other = pose(exact, shares, sizes), pose(known, shares, sizes)
        for name in PLACES:
            apart = getattr(one, name) - getattr(other, name)
            parts[name].append(1e3 * np.linalg.norm(apart, axis=-1).ravel())
        parts["pelvis"].append(_turned_deg(one, other))
    return {name: np.concatenate(off) for name, off in parts.items()}


def _turned_deg(one: Pose, other: Pose) -> Floats:
    cosine = np.abs(np.einsum("nd,nd->n", one.pelvis, other.pelvis))
    return np.asarray(np.degrees(2.0 * np.arccos(np.minimum(cosine, 1.0))))


def percentiles(off: Floats) -> dict[str, float]:
    """The median, the 99th percentile and the greatest."""
    return {
        "p50": float(np.percentile(off, 50)),
        "p99": float(np.percentile(off, 99)),
        "max": float(off.max()),
    }


def falls_short(parts: dict[str, Floats]) -> bool:
    """Whether more than one in a hundred is further off than `LIMITS` say."""
    return any(percentiles(parts[name])["p99"] > limit for name, limit in LIMITS.items())


def show(console: Console, walks: dict[str, Walked], found: dict[str, dict[str, Floats]]) -> None:
    title = f"Bodies drawn from records of {STEP.itemsize} bytes: off by p50 / p99 / max"
    table = Table("mm, pelvis degrees", title=title)
    for name, walked in walks.items():
        table.add_column(f"{name}\n{len(walked.steps.ticks)} steps", justify="right")
    for part in (*PLACES, "pelvis"):
        cells = (percentiles(parts[part]).values() for parts in found.values())
        table.add_row(part, *(" / ".join(f"{value:.2f}" for value in cell) for cell in cells))
    console.print(table)


if __name__ == "__main__":
    sys.exit(main())

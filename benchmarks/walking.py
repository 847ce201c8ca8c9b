"""Measures what walking costs, how limbs reach, and how well Table 3 of the paper is reproduced.

    python -m benchmarks.walking                                  everything, a minute
    python -m benchmarks.walking --avatars 10 1000 --ticks 400 --json walking.json

Cost: all avatars walk in circles of their own at 1.3 m/s, on a level field and over flights of
stairs. The benchmark measures what a tick of the server spends on their feet (`Walkers.update` and
the records that are sent) and on their contacts, against the 50 ms of a tick, and what posing all
of them once costs in Python. Reaching: 1000 seeded targets of a heel's chain are reached for by
plain CCD and by both ways of two stages. Table 3 is shown as printed, by its own equation, by the
source's curves, and with the offset that was fitted. The exit code is 1 if a tick of the most
avatars takes more than 20 ms at the median, or if reaching or the table fall short of what
docs/walking.md says.
"""

import argparse
import json
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np
from rich import box
from rich.console import Console
from rich.progress import track
from rich.table import Table

from esplanade.actors.locomotion.body.sizes import BodySizes
from esplanade.actors.locomotion.body.traits import traits_of
from esplanade.actors.locomotion.footsteps.course import AHEAD, AHEAD_S, Course
from esplanade.actors.locomotion.footsteps.ground import Ground
from esplanade.actors.locomotion.footsteps.walkers import Walkers
from esplanade.actors.locomotion.motion.key_poses import Steps
from esplanade.actors.locomotion.reaching import two_stage
from esplanade.actors.locomotion.reaching.two_stage import Reach
from esplanade.actors.locomotion.reference import rotations
from esplanade.actors.locomotion.reference import table3 as third
from esplanade.actors.locomotion.reference.posing import pose
from esplanade.footage.targets import SHARES, random_targets
from esplanade.planning import LayeredGrid, Scene, Stairs
from esplanade.planning.compiled.arrays import Floats, Ints
from esplanade.server.world.contacts import Contacts
from esplanade.server.world.state import State
from esplanade.server.world.step_records import from_records, to_records

TICK_S: Final = 0.05
TICK_LIMIT_MS: Final = 20.0
SPEED_MPS: Final = 1.3
_FLIGHTS: Final = tuple(
    Stairs(start=(x, y), end=(x + 1.2, y), width_m=3.0, top_m=0.7, steps=4)
    for x in range(-50, 50, 4)
    for y in range(-50, 50, 4)
)
GROUNDS: Final = {
    "level": Scene(bounds=(-60.0, -60.0, 60.0, 60.0)),
    "stairs": Scene(bounds=(-60.0, -60.0, 60.0, 60.0), stairs=_FLIGHTS),
}
TARGETS: Final = 1000
TRUNK_DOF: Final = 6
PRODUCT: Final = "... and restarts"
LEAST_SAVED: Final = {"limb is enough": 0.80, "half and half": 0.60, "all of the chain": 0.40}


class Cost(NamedTuple):
    """The cost of the feet of a number of avatars."""

    ground: str
    avatars: int
    tick_p50_ms: float
    tick_p99_ms: float
    steps_a_tick: float
    us_an_avatar_and_tick: float
    """Processor time for the steps of an avatar and tick."""
    us_a_step: float
    """Processor time for a step that begins, all else included."""
    contacts_us: float
    """Processor time for the contacts of an avatar and tick; half of all avatars are actors."""
    frame_ms: float
    """Time to pose all of them once."""


class Work(NamedTuple):
    """The results of one method of reaching for `TARGETS` targets."""

    reached_percent: float
    turned: float
    """Mean number of turns of hinges for a target."""
    most_sweeps: int
    trunk_deg: float
    """Mean angle by which the trunk has turned in the end."""
    ms: float
    """Time for all targets."""


def main(argv: Sequence[str] | None = None) -> int:
    options = parser().parse_args(argv)
    costs = [
        cost_of(ground, count, options.ticks) for ground in GROUNDS for count in options.avatars
    ]
    reaching = {name: compare_reaching(share, options.seed) for name, share in SHARES.items()}
    rows = {
        "eq. (12)": third.reproduce_as_printed(),
        "source": third.reproduce(offset=0.0),
        f"+ {third.FITTED_OFFSET}, fitted": third.reproduce(),
    }
    console = Console()
    show_costs(console, costs)
    show_reaching(console, reaching)
    show_table3(console, rows)
    if options.json is not None:
        figures = {
            "costs": [cost._asdict() for cost in costs],
            "reaching": {
                kind: {way: work._asdict() for way, work in ways.items()}
                for kind, ways in reaching.items()
            },
            "table3": {name: list(found.rows_right()) for name, found in rows.items()},
        }
        options.json.write_text(json.dumps(figures, indent=1, allow_nan=False) + "\n")
    return int(falls_short(costs, reaching))


def parser() -> argparse.ArgumentParser:
    """The parser of the options."""
    made = argparse.ArgumentParser(prog="python -m benchmarks.walking", description=__doc__)
    made.formatter_class = argparse.RawDescriptionHelpFormatter
    made.add_argument("--avatars", type=int, nargs="+", default=[10, 100, 1000], metavar="N")
    made.add_argument("--ticks", type=int, default=200, help="ticks measured [default: 200]")
    made.add_argument("--seed", type=int, default=0, help="of the targets [default: 0]")
    made.add_argument("--json", type=Path, metavar="F")
    return made


# --- cost -------------------------------------------------------------------------------------


def cost_of(ground_name: str, avatars: int, ticks: int) -> Cost:
    """Let a number of avatars walk in circles for some ticks."""
    random = np.random.default_rng(1)
    scene = GROUNDS[ground_name]
    ground = Ground(scene, LayeredGrid.from_scene(scene, 2.0))
    begun = 0

    def publish(steps: Steps, slots: Ints) -> Steps:
        nonlocal begun
        begun += len(slots)
        return from_records(to_records(steps, slots))

    slots = np.arange(avatars)
    radius_m = random.uniform(2.0, 20.0, avatars)
    angle = random.uniform(0.0, 2.0 * np.pi, avatars)
    centres = random.uniform(-30.0, 30.0, (avatars, 2))

    def course(tick: int) -> Course:
        seconds = tick * TICK_S + AHEAD_S * np.arange(AHEAD)
        turned = angle[:, None] + SPEED_MPS * seconds / radius_m[:, None]
        ahead = np.zeros((avatars, AHEAD, 3))
        ahead[..., 0] = centres[:, :1] + radius_m[:, None] * np.cos(turned)
        ahead[..., 1] = centres[:, 1:] + radius_m[:, None] * np.sin(turned)
        level = np.full(ahead[..., 0].size, 0.35)
        heights = ground.height(ahead[..., :2].reshape(-1, 2), level)
        ahead[..., 2] = np.nan_to_num(heights).reshape(ahead.shape[:2])
        return Course(turned[:, 0] + 0.5 * np.pi, ahead)

    traits = [traits_of(0, avatar) for avatar in range(avatars)]
    sizes = BodySizes(
        np.array([each.leg_m for each in traits]),
        np.array([each.stature_m for each in traits]),
    )
    walkers = Walkers(avatars, ground, TICK_S, publish)
    walkers.join(0, slots, traits, course(0))
    settled = round(3.0 / TICK_S)
    tick_ms, steps_us, contacts_us = [], [], []
    state, contacts = State(avatars), Contacts()
    for slot in range(avatars):
        state.add(slot % 2, "", (0.0, 0.0, 0.0), 0, 0.25)
    for tick in track(
        range(settled + ticks),
        description=f"{avatars} avatars",
        console=Console(stderr=True),
        transient=True,
        disable=not sys.stderr.isatty(),
    ):
        here = course(tick)
        if tick == settled:
            begun = 0
        start, worked = time.perf_counter(), time.thread_time()
        walkers.update(tick, slots, here)
        tick_ms.append(1e3 * (time.perf_counter() - start))
        steps_us.append(1e6 * (time.thread_time() - worked))
        state.before[:] = state.positions if tick else here.ahead[:, 0, :2]
        state.positions[:], state.heights[:] = here.ahead[:, 0, :2], here.ahead[:, 0, 2]
        worked = time.thread_time()
        contacts.update(state)
        contacts_us.append(1e6 * (time.thread_time() - worked))
    measured = np.array(tick_ms[settled:])
    frames_ms = []
    for k in range(10):
        start = time.perf_counter()
        pose(walkers.steps, walkers.steps.share(settled + ticks - 1 + 0.1 * k), sizes)
        frames_ms.append(1e3 * (time.perf_counter() - start))
    return Cost(
        ground_name,
        avatars,
        float(np.median(measured)),
        float(np.percentile(measured, 99)),
        begun / ticks,
        float(np.mean(steps_us[settled:])) / avatars,
        float(np.sum(steps_us[settled:])) / max(begun, 1),
        float(np.mean(contacts_us[settled:])) / avatars,
        float(np.median(frames_ms)),
    )


# --- reaching ---------------------------------------------------------------------------------


def compare_reaching(trunk_share: float, seed: int) -> dict[str, Work]:
    """Reach for the same targets by each method."""
    chain = two_stage.heel_chain(left=True)
    random = np.random.default_rng(seed)
    starts, targets = random_targets(chain, trunk_share, TARGETS, random)
    ways = {
        "plain CCD": lambda: two_stage.reach_by_ccd(chain, targets, starts),
        "CCD + CCD": lambda: two_stage.reach_by_ccd(
            chain, targets, starts, limb_sweeps=two_stage.LIMB_SWEEPS
        ),
        "closed form + CCD": lambda: two_stage.reach(
            chain,
            targets,
            starts,
            np.random.default_rng(seed),
            sweeps=two_stage.CCD_SWEEPS,
            restarts=0,
        ),
        PRODUCT: lambda: two_stage.reach(chain, targets, starts, np.random.default_rng(seed)),
    }
    found = {}
    for name, way in ways.items():
        way()  # compiles
        begun = time.perf_counter()
        reach = way()
        found[name] = _work(reach, starts, 1e3 * (time.perf_counter() - begun))
    return found


def _work(found: Reach, starts: Floats, ms: float) -> Work:
    before, after = (_trunk_turn(angles) for angles in (starts, found.angles))
    return Work(
        100.0 * float(found.reached.mean()),
        float(found.turned.mean()),
        int(found.sweeps[found.reached].max(initial=0)),
        float(np.degrees(rotations.angle_between(before, after)).mean()),
        ms,
    )


def _trunk_turn(angles: Floats) -> Floats:
    """Rotations of the sub-root against the root, quaternions (N, 4)."""
    joints = rotations.from_euler(angles[:, :TRUNK_DOF].reshape(-1, 2, 3))
    return rotations.multiply(joints[:, 0], joints[:, 1])


# --- what is said -----------------------------------------------------------------------------


def falls_short(costs: Sequence[Cost], reaching: dict[str, dict[str, Work]]) -> bool:
    """Whether any figure is worse than the documents say."""
    slow = costs[-1].tick_p50_ms > TICK_LIMIT_MS
    unsaved = any(saved(ways, PRODUCT) < LEAST_SAVED[kind] for kind, ways in reaching.items())
    missed = any(ways[PRODUCT].reached_percent < 99.0 for ways in reaching.values())
    return slow or unsaved or missed or third.reproduce().rows_right() != (15, 15)


def saved(ways: dict[str, Work], way: str) -> float:
    """Share of the turns of plain CCD that a method does without."""
    return 1.0 - ways[way].turned / ways["plain CCD"].turned


def show_costs(console: Console, costs: Sequence[Cost]) -> None:
    table = Table(box=box.SIMPLE, title="feet of everyone, a tick of 50 ms", title_justify="left")
    table.add_column("ground")
    columns = "avatars", "p50 ms", "p99 ms", "of a tick", "steps a tick", "µs each", "µs a step"
    for column in (*columns, "contacts, µs each", "posed once, ms"):
        table.add_column(column, justify="right")
    for cost in costs:
        table.add_row(
            cost.ground,
            str(cost.avatars),
            f"{cost.tick_p50_ms:.2f}",
            f"{cost.tick_p99_ms:.2f}",
            f"{cost.tick_p50_ms / (1e3 * TICK_S):.1%}",
            f"{cost.steps_a_tick:.1f}",
            f"{cost.us_an_avatar_and_tick:.1f}",
            f"{cost.us_a_step:.0f}",
            f"{cost.contacts_us:.2f}",
            f"{cost.frame_ms:.2f}",
        )
    console.print(table)


def show_reaching(console: Console, reaching: dict[str, dict[str, Work]]) -> None:
    table = Table(
        box=box.SIMPLE, title=f"reaching, {TARGETS} targets of a heel", title_justify="left"
    )
    table.add_column("", no_wrap=True)
    for column in ("reached", "turns", "saved", "most sweeps", "trunk", "ms"):
        table.add_column(column, justify="right")
    for kind, ways in reaching.items():
        table.add_row(f"[bold]{kind}")
        for way, work in ways.items():
            table.add_row(
                way,
                f"{work.reached_percent:.1f} %",
                f"{work.turned:.0f}",
                f"{saved(ways, way):.0%}",
                str(work.most_sweeps),
                f"{work.trunk_deg:.0f}°",
                f"{work.ms:.0f}",
            )
    console.print(table)


def show_table3(console: Console, rows: dict[str, third.Reproduced]) -> None:
    table = Table(box=box.SIMPLE, title="table 3: RV (halvings)", title_justify="left")
    for column in ("step", "printed", *rows):
        table.add_column(column, justify="right")
    for k, length in enumerate(third.LENGTHS.tolist()):
        printed = f"{third.PRINTED_RV[k]:.4f} ({third.PRINTED_HALVINGS[k]})"
        cells = [
            f"{found.rv[k]:.4f} ({found.halvings[k]})" if _solved(found, k) else "–"
            for found in rows.values()
        ]
        table.add_row(f"{length:.2f}", printed, *cells)
    right = ["{} ({}) of 15".format(*found.rows_right()) for found in rows.values()]
    table.add_row("", "the same", *right)
    console.print(table)


def _solved(found: third.Reproduced, row: int) -> bool:
    """Whether any step has that length."""
    return bool(found.halvings[row] < found.halvings.max() or found.halvings.max() < 20)


if __name__ == "__main__":
    sys.exit(main())

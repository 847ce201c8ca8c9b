"""People stand in a doorway, and there is another one: the time that an actor loses.

    python -m benchmarks.doorways                      all widths, second ways, numbers of people
    python -m benchmarks.doorways --seeds 2 --people 1 5 --json doorways.json

An actor walks from one room to the next. One to five people have come to stand in the doorway on
its way as it sets out; they stay. The time that it loses is that beyond the time with the doorway
walled up, where no choice is left; it is negative where the actor slips past the people. The exit
code is 1 if the median of the times lost is above 2 s, the worst above 5 s, or an actor does not
arrive.
"""

import argparse
import json
import sys
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Final

import numpy as np
from rich import box
from rich.console import Console
from rich.table import Table

from esplanade.actors import Navigator, Outcome
from esplanade.planning import PlanModel, Scene, Wall

TICK_S: Final = 0.1
WALL_M: Final = 15.0
"""The wall between the two rooms stands at this x."""
BOUNDS: Final = (0.0, 0.0, 30.0, 30.0)
DOOR_M: Final = 6.0
"""The middle of the doorway with people in it lies at this y."""
LONGEST_S: Final = 120.0
MEDIAN_S: Final = 2.0
WORST_S: Final = 5.0


@dataclass(frozen=True)
class Trial:
    """One walk through the wall, and what it cost."""

    width_m: float
    apart_m: float
    """Metres between the middles of both doorways."""
    people: int
    seed: int
    lost_s: float
    """Infinite if the actor did not arrive."""


def main(argv: Sequence[str] | None = None) -> int:
    options = parser().parse_args(argv)
    trials = [
        trial(width_m, apart_m, people, seed)
        for width_m in options.widths
        for apart_m in options.apart
        for people in options.people
        for seed in range(options.seeds)
    ]
    show(trials)
    if options.json is not None:
        options.json.write_text(json.dumps([asdict(each) for each in trials], indent=1) + "\n")
    lost_s = np.array([each.lost_s for each in trials])
    return int(float(np.median(lost_s)) > MEDIAN_S or float(lost_s.max()) > WORST_S)


def parser() -> argparse.ArgumentParser:
    """The options."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.doorways", description=__doc__)
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.add_argument("--widths", nargs="+", type=float, default=[0.9, 1.2, 1.6, 2.0])
    parser.add_argument("--apart", nargs="+", type=float, default=[4.0, 8.0, 16.0])
    parser.add_argument("--people", nargs="+", type=int, default=[1, 2, 3, 5])
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--json", type=Path, metavar="F")
    return parser


def rooms(width_m: float, apart_m: float, *, walled_up: bool) -> Scene:
    """Two rooms with two doorways, or only the further one."""
    first, second = DOOR_M, DOOR_M + apart_m
    half = 0.5 * width_m
    ends = [0.0, second - half] if walled_up else [0.0, first - half, first + half, second - half]
    ends += [second + half, BOUNDS[3]]
    pairs = zip(ends[::2], ends[1::2], strict=True)
    walls = tuple(Wall(start=(WALL_M, a), end=(WALL_M, b)) for a, b in pairs)
    return Scene(bounds=BOUNDS, walls=walls)


def standing(width_m: float, people: int, chance: np.random.Generator) -> list[tuple[float, float]]:
    """Places of people in and about the doorway, the first in its middle, apart from each other."""
    spots = [(WALL_M, DOOR_M + chance.uniform(-0.15, 0.15) * (width_m - 0.5))]
    while len(spots) < people:
        reach = 0.5 * width_m + 0.3
        spot = WALL_M + chance.uniform(-0.9, 0.9), DOOR_M + chance.uniform(-reach, reach)
        in_wall = abs(spot[0] - WALL_M) < 0.3 and abs(spot[1] - DOOR_M) > 0.5 * width_m - 0.25
        if not in_wall and all(np.hypot(spot[0] - x, spot[1] - y) >= 0.5 for x, y in spots):
            spots.append(spot)
        elif chance.uniform() < 0.01:  # there is no more room
            break
    return spots


def trial(width_m: float, apart_m: float, people: int, seed: int) -> Trial:
    """Walk once with people in the doorway, and once with it walled up."""
    chance = np.random.default_rng([seed, people, round(100 * width_m), round(100 * apart_m)])
    start = float(chance.uniform(4.0, 11.0)), DOOR_M + float(chance.uniform(-3.0, 3.0))
    goal = float(chance.uniform(19.0, 26.0)), DOOR_M + float(chance.uniform(-3.0, 3.0))
    spots = standing(width_m, people, chance)
    plugged = seconds(rooms(width_m, apart_m, walled_up=False), start, goal, spots)
    walled = seconds(rooms(width_m, apart_m, walled_up=True), start, goal, [])
    arrived = np.isfinite(plugged) and np.isfinite(walled)
    lost_s = round(plugged - walled, 2) if arrived else float("inf")
    return Trial(width_m, apart_m, people, seed, lost_s)


def seconds(
    scene: Scene,
    start: tuple[float, float],
    goal: tuple[float, float],
    spots: Sequence[tuple[float, float]],
) -> float:
    """The time that an actor takes among people who stand, infinite if it does not arrive."""
    nav = Navigator(scene, TICK_S, plan=PlanModel(threads=1))
    nav.add_actor("a", start, goal)
    people = dict(enumerate(spots))
    took_s = float("inf")
    for tick in range(round(LONGEST_S / TICK_S)):
        nav.observe(people)
        if (outcome := nav.tick()["a"].outcome) is not None:
            took_s = (tick + 1) * TICK_S if outcome is Outcome.ARRIVED else took_s
            break
    nav.close()
    return took_s


def show(trials: Sequence[Trial]) -> None:
    """Print a table with a row for every width and number of people."""
    table = Table(box=box.SIMPLE)
    for title in ("width, m", "people", "walks", "lost, median s", "worst s", "not arrived"):
        table.add_column(title, justify="right")
    for width_m, people in sorted({(each.width_m, each.people) for each in trials}):
        some = [each for each in trials if (each.width_m, each.people) == (width_m, people)]
        _row(table, f"{width_m:g}", str(people), some)
    _row(table, "all", "all", trials)
    Console().print(table)


def _row(table: Table, width: str, people: str, trials: Sequence[Trial]) -> None:
    lost_s = np.array([each.lost_s for each in trials])
    lost = int(np.isinf(lost_s).sum())
    figures = f"{np.median(lost_s):.1f}", f"{lost_s.max():.1f}"
    table.add_row(width, people, str(len(trials)), *figures, str(lost))


if __name__ == "__main__":
    sys.exit(main())

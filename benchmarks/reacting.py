"""Measures what a tick of reacting people costs, as people and actors become more.

    python -m benchmarks.reacting
    python -m benchmarks.reacting --people 200 400 --json figures.json

People cross a square in which 0.3 stand on each square metre, and one actor for every ten people
goes straight through them all. Memory and search grow with bodies, not with their square: each
person looks into nine cells of 8 m, and reacts to the nearest sixteen.
"""

import argparse
import json
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np
from rich.console import Console
from rich.table import Table

from esplanade.pedestrians import ReactingCrowd, Walk

TICK_S: Final = 0.1
TICKS: Final = 60
PEOPLE_PER_M2: Final = 0.3
PEOPLE_PER_ACTOR: Final = 10
SPEED_MPS: Final = 1.3


def main(argv: Sequence[str] | None = None) -> int:
    options = parser().parse_args(argv)
    crossing(20)
    table = Table("people", "actors", "off their recording", "ms a tick", "µs a person")
    rows = []
    for people in options.people:
        ms, moved = crossing(people)
        rows.append({"people": people, "ms": ms, "moved_percent": moved})
        actors = people // PEOPLE_PER_ACTOR
        told = f"{people}", f"{actors}", f"{moved:.0f} %", f"{ms:.2f}", f"{1e3 * ms / people:.1f}"
        table.add_row(*told)
    Console().print(table)
    if options.json is not None:
        options.json.write_text(json.dumps(rows, indent=1) + "\n", encoding="utf-8")
    return 0


def parser() -> argparse.ArgumentParser:
    made = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    made.add_argument("--people", type=int, nargs="+", default=[100, 200, 400, 800, 1600, 3200])
    made.add_argument("--json", type=Path)
    return made


def crossing(people: int) -> tuple[float, float]:
    """Median milliseconds of processor time for a tick, and per cent of people off their paths."""
    rng = np.random.default_rng(people)
    side_m = float(np.sqrt(people / PEOPLE_PER_M2))
    headings = rng.choice([0.0, 0.5, 1.0, 1.5], people) * np.pi
    ways = np.column_stack([np.cos(headings), np.sin(headings)]) * SPEED_MPS * TICK_S
    starts = rng.uniform(0, side_m, (people, 2))
    paths = starts[:, None] + np.arange(TICKS + 1)[:, None] * ways[:, None]
    walk = ReactingCrowd(list(paths), [0] * people, TICK_S).begin(0)
    count = people // PEOPLE_PER_ACTOR
    places = rng.uniform(0, side_m, (count, 2))
    velocities = np.tile([SPEED_MPS, 0.0], (count, 1))
    seconds = []
    for _ in range(TICKS):
        actors = np.column_stack([places, velocities, np.full(count, 0.25)])
        began_s = time.process_time()
        walk.step(actors)
        seconds.append(time.process_time() - began_s)
        places = places + velocities * TICK_S
    return 1e3 * float(np.median(seconds)), _off_paths(walk)


def _off_paths(walk: Walk) -> float:
    return 100.0 * float((walk.positions != walk.recorded).any(axis=1).mean())


if __name__ == "__main__":
    raise SystemExit(main())

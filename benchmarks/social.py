"""Many actors among themselves: they change sides of a doorway, of a square, and of a circle.

    python -m benchmarks.social                                   200 actors, all three scenes
    python -m benchmarks.social --actors 50 --scenes doorway --door 1.2 --plots pictures
    python -m benchmarks.social --actors 100 --widths 0.9 1.2 1.6 2 2.4

There are only actors, each with its own goal. Contacts are pairs of discs that overlap at any time,
also between ticks. Times are compared with that of the same path alone at the preferred speed. An
actor is stuck if it comes less than 0.5 m nearer to its goal in 20 s. The exit code is 1 if there
was a contact, or an actor was stuck or did not arrive.

With --widths it prints instead how many go through doorways of such widths, half of the actors from
one side and then all of them from both sides: persons a second and metre of width (recorded people:
1.2 to 1.9), of the middle eight tenths, and the longest wait, against that of the fair order, in
which everybody goes through at the same rate and in the order in which they could be there. The
exit code is 1 if there was a contact, a flow below 1.3, or, where a queue forms, a wait longer than
1.5 times the fair one. In all scenes actors are patient enough to wait for their turn.
"""

import argparse
import json
import sys
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, replace
from importlib import import_module
from pathlib import Path
from typing import Any, Final

import numpy as np
from benchmarks._flow import Flow, flow_of, one_way
from benchmarks._swaps import SWAPS, Swap
from benchmarks._walks import Floats, Verdict, Walks, judge, ways_left
from rich import box
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Table

from esplanade.actors import Navigator
from esplanade.evaluation.settings import models_of, parameters_of
from esplanade.planning import LayeredGrid

TICK_S: Final = 0.05
CELL_M: Final = 0.25
LEAST_FLOW: Final = 1.3
"""Persons a second and metre of width."""
MOST_UNFAIRNESS: Final = 1.5
QUEUE_S: Final = 10.0
"""There is no queue, and no ratio to judge, if nobody waits for so long in the fair order."""
MOST_PATIENCE_S: Final = 600.0
EPILOGUE_S: Final = 2.0
"""The simulation goes on for this long after the last actor has arrived."""

ROWS: Final = (
    ("actors", "actors", "{:d}"),
    ("contacts, pairs", "contacts", "{:d}"),
    ("smallest clearance, m", "clearance_m", "{:.3f}"),
    ("arrived, %", "arrived_percent", "{:.1f}"),
    ("last to arrive, s", "last_s", "{:.1f}"),
    ("time / alone, mean", "time_ratio", "{:.2f}"),
    ("time / alone, worst", "worst_time_ratio", "{:.2f}"),
    ("stuck", "stuck", "{:d}"),
    ("tick, p50 ms", "tick_p50_ms", "{:.1f}"),
    ("tick, p99 ms", "tick_p99_ms", "{:.1f}"),
)


def main(argv: Sequence[str] | None = None) -> int:
    options = parser().parse_args(argv)
    random = np.random.default_rng(options.seed)
    if options.widths:
        return int(not flows(options, random))
    swaps = [SWAPS[name](options.actors, options.door, random) for name in options.scenes]
    verdicts: dict[str, Verdict] = {}
    for swap in swaps:
        walks, tick_ms = walk_watched(swap, options.seed, options.until, options.threads)
        verdicts[swap.name] = judge(walks, tick_ms)
        if options.plots is not None:
            draw(options.plots / f"{swap.name.replace(' ', '_')}.png", swap, walks)
    show(verdicts)
    if options.json is not None:
        figures = {name: asdict(verdict) for name, verdict in verdicts.items()}
        options.json.write_text(json.dumps(figures, indent=1, allow_nan=False) + "\n")
    return int(any(v.contacts or v.stuck or v.last_s is None for v in verdicts.values()))


def parser() -> argparse.ArgumentParser:
    """The options."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.social", description=__doc__)
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.add_argument("--actors", type=int, default=200)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--scenes", nargs="+", choices=SWAPS, default=list(SWAPS), metavar="SCENE")
    parser.add_argument("--door", type=float, default=2.0, metavar="M", help="width of the doorway")
    parser.add_argument(
        "--widths", type=float, nargs="+", metavar="M", help="print the flow through such doorways"
    )
    parser.add_argument("--until", type=float, default=300.0, metavar="S", help="simulated seconds")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--plots", type=Path, metavar="DIR", help="draw all paths as PNG")
    parser.add_argument("--json", type=Path, metavar="F")
    return parser


def walk_watched(swap: Swap, seed: int, until_s: float, threads: int) -> tuple[Walks, Floats]:
    """Run `walk` with a progress bar on a terminal."""
    with Progress(
        TextColumn("{task.description}, {task.fields[here]} arrived"),
        BarColumn(),
        TimeElapsedColumn(),
        console=Console(stderr=True),
        transient=True,
        disable=not sys.stderr.isatty(),
    ) as progress:
        task = progress.add_task(swap.name, total=until_s, here=0)

        def report(now_s: float, here: int) -> None:
            progress.update(task, completed=now_s, here=here)

        return walk(swap, seed, until_s, threads, report)


def walk(
    swap: Swap,
    seed: int,
    until_s: float,
    threads: int = 1,
    report: Callable[[float, int], None] | None = None,
    settings: Mapping[str, Any] | None = None,
) -> tuple[Walks, Floats]:
    """Simulate until all actors have arrived, and a little longer.

    Returns the walks and the milliseconds of every tick. `report` is called after every tick with
    the simulated seconds and the number of actors that have arrived. `settings` are as those of
    `esplanade evaluate --set`.
    """
    models = models_of(settings or {})
    # The last in a fair order may wait for most of the time, and must not give up.
    body = parameters_of(settings or {}, {"patience_s": min(until_s, MOST_PATIENCE_S)})
    grid = LayeredGrid.from_scene(swap.scene, CELL_M)
    plan = replace(models.plan, threads=threads)
    nav = Navigator(grid, TICK_S, seed, plan=plan, risk=models.risk, rules=models.rules)
    for k, (start, goal) in enumerate(zip(swap.starts.tolist(), swap.goals.tolist(), strict=True)):
        nav.add_actor(k, tuple(start), tuple(goal), body)
    track, tick_ms = [swap.starts], []
    arrived = np.zeros(len(swap.starts), dtype=bool)
    end = round(until_s / TICK_S)
    while len(track) <= end:
        begun = time.perf_counter()
        nav.observe({})
        states = nav.tick()
        tick_ms.append(1e3 * (time.perf_counter() - begun))
        track.append(np.array([states[k].position for k in range(len(swap.starts))]))
        arrived |= np.hypot(*(track[-1] - swap.goals).T) <= body.goal_tolerance_m
        if arrived.all():
            end = min(end, len(track) + round(EPILOGUE_S / TICK_S))
        if report is not None:
            report((len(track) - 1) * TICK_S, int(arrived.sum()))
    nav.close()
    positions = np.array(track)
    left_m = ways_left(grid, positions, swap.goals, body.radius_m)
    walks = Walks(positions, left_m, TICK_S, body.radius_m, body.speed_mps, body.goal_tolerance_m)
    return walks, np.array(tick_ms)


def flows(options: argparse.Namespace, random: np.random.Generator) -> bool:
    """Print the flow through doorways of some widths; whether all of it is good enough."""
    found = []
    for width_m in options.widths:
        both = SWAPS["doorway"](options.actors, width_m, random)
        for swap in (one_way(both), both):
            walks, _ = walk_watched(swap, options.seed, options.until, options.threads)
            found.append(flow_of(swap, width_m, walks))
            if options.plots is not None:
                draw(options.plots / f"{swap.name.replace(' ', '_')}.png", swap, walks)
    show_flows(found)
    if options.json is not None:
        figures = [asdict(flow) for flow in found]
        options.json.write_text(json.dumps(figures, indent=1, allow_nan=False) + "\n")
    return all(
        flow.contacts == 0
        and (flow.flow or 0.0) >= LEAST_FLOW
        and (flow.fair_wait_s < QUEUE_S or flow.unfairness <= MOST_UNFAIRNESS)
        for flow in found
    )


def show_flows(found: Sequence[Flow]) -> None:
    """Print a table with a row for every doorway and way."""
    table = Table(box=box.SIMPLE)
    for title in ("width, m", "ways", "through", "flow", "last, s", "wait, s", "fair, s", "ratio"):
        table.add_column(title, justify="right", no_wrap=True)
    for flow in found:
        table.add_row(
            f"{flow.width_m:g}",
            "both" if flow.both_ways else "one",
            f"{flow.crossed} of {flow.actors}",
            "–" if flow.flow is None else f"{flow.flow:.2f}",
            "–" if flow.last_s is None else f"{flow.last_s:.1f}",
            f"{flow.longest_wait_s:.1f}",
            f"{flow.fair_wait_s:.1f}",
            f"{flow.unfairness:.2f}",
        )
    console = Console()
    console.print(table)
    console.print(f"{sum(flow.contacts for flow in found)} pairs in contact")


def show(verdicts: dict[str, Verdict]) -> None:
    """Print a table with a column for every scene."""
    table = Table(box=box.SIMPLE)
    table.add_column("")
    for name in verdicts:
        table.add_column(name, justify="right")
    for title, field, shape in ROWS:
        values = [getattr(verdict, field) for verdict in verdicts.values()]
        table.add_row(title, *("–" if v is None else shape.format(v) for v in values))
    Console().print(table)


def draw(path: Path, swap: Swap, walks: Walks) -> None:
    """Draw all paths in one picture, coloured by time; crosses are goals that were not reached."""
    try:
        figure_of = import_module("matplotlib.figure").Figure
        lines_of = import_module("matplotlib.collections").LineCollection
    except ImportError:
        sys.exit("pictures need matplotlib, which comes with `esplanade[evaluate]`")
    path.parent.mkdir(parents=True, exist_ok=True)
    x0, y0, x1, y1 = swap.scene.bounds
    figure = figure_of(figsize=(10.0, 1.0 + 9.0 * (y1 - y0) / (x1 - x0)), layout="constrained")
    axes = figure.add_subplot()
    thinned = walks.positions[:: round(0.2 / walks.tick_s)].transpose(1, 0, 2)
    pieces = np.stack([thinned[:, :-1], thinned[:, 1:]], axis=2).reshape(-1, 2, 2)
    ways = lines_of(list(pieces), cmap="viridis", linewidths=0.7)
    ways.set_array(np.tile(0.2 * np.arange(thinned.shape[1] - 1), len(thinned)))
    axes.add_collection(ways)
    for wall in swap.scene.walls:
        axes.plot(*zip(wall.start, wall.end, strict=True), color="0.2", lw=3)
    axes.scatter(*walks.positions[-1].T, s=12, color="tab:red", zorder=3)
    axes.scatter(*swap.goals[np.isinf(walks.arrivals_s)].T, marker="x", color="tab:red", zorder=3)
    axes.set(xlim=(x0, x1), ylim=(y0, y1), aspect="equal", title=f"{len(thinned)}, {swap.name}")
    figure.colorbar(ways, label="seconds", shrink=0.8)
    figure.savefig(path, dpi=110)


if __name__ == "__main__":
    sys.exit(main())

"""The costs of a thousand zones and a million people: a simulation by measured constants.

    python -m benchmarks.scale_model                         1000 zones, 1000 people in each
    python -m benchmarks.scale_model --zones 3 --people 100 --seconds 120
    python -m benchmarks.scale_model --plots docs/images     draw how it grows, too

Zones lie at random on a square, and people hop from one to another by gravity. Hosts and gateways
die at given rates. Costs are those of `benchmarks/_scale_constants.py`, each measured on one
machine by the command that stands beside it; `--constants FILE` takes others from a JSON file.

Three ways to choose gateways are compared. With a hop, clients go over to a gateway of the zone
where their person is; or they do so some time later (--move-s); or they stay where they came in.
Whoever is elsewhere brings all frames of that zone to a gateway.
"""

import argparse
import math
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from benchmarks._scale_constants import Constants
from benchmarks._scale_costs import Costs, costs_of
from benchmarks._scale_world import Plan, Run, simulate
from matplotlib.figure import Figure
from rich.console import Console
from rich.progress import track
from rich.table import Table

GROWTH = (10, 30, 100, 300, 1000)
"""Numbers of zones in the plots."""


def main(argv: Sequence[str] | None = None) -> int:
    options = parser().parse_args(argv)
    console = Console()
    try:
        constants = Constants() if options.constants is None else Constants.of(options.constants)
    except (OSError, ValueError) as error:
        print(f"python -m benchmarks.scale_model: --constants: {error}", file=sys.stderr)
        return 2
    plan = Plan(
        zones=options.zones,
        people=options.zones * options.people,
        most_in_zone=options.most_in_zone,
        seconds=options.seconds,
        hop_s=options.hop_s,
        move_s=options.move_s,
        gateway_people=options.gateway_people,
        host_deaths_a_day=options.host_deaths,
        gateway_deaths_a_day=options.gateway_deaths,
    )
    ways = {
        "go over at once": replace(plan, move_s=0.0),
        f"after {plan.move_s:g} s": plan,
        "stay": replace(plan, move_s=math.inf),
    }
    table = Table(title=f"{plan.zones} zones, {plan.people} people, {plan.seconds} s")
    table.add_column("after a hop, clients")
    runs = {name: simulate(way, constants, generator(options.seed)) for name, way in ways.items()}
    for name in runs:
        table.add_column(name, justify="right")
    rows = [figures_of(run, constants) for run in runs.values()]
    for name in rows[0]:
        table.add_row(name, *(each[name] for each in rows))
    console.print(table)
    if options.plots is not None:
        draw(plan, constants, options.seed, options.plots, console)
    return 0


def parser() -> argparse.ArgumentParser:
    """The options."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.scale_model", description=__doc__)
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.add_argument("--zones", type=int, default=1000, help="[1000]")
    parser.add_argument("--people", type=int, default=1000, help="for each zone [1000]")
    parser.add_argument("--most-in-zone", type=int, default=4000, help="then it is full [4000]")
    parser.add_argument("--seconds", type=int, default=120, help="of the world [120]")
    parser.add_argument("--hop-s", type=float, default=300.0, help="mean time in a zone [300]")
    parser.add_argument("--move-s", type=float, default=20.0, help="until clients go over [20]")
    parser.add_argument("--gateway-people", type=int, default=1000, help="of a gateway [1000]")
    parser.add_argument("--host-deaths", type=float, default=1.0, help="of each a day [1]")
    parser.add_argument("--gateway-deaths", type=float, default=1.0, help="of each a day [1]")
    parser.add_argument("--constants", type=Path, metavar="F", help="JSON of other constants")
    parser.add_argument("--plots", type=Path, metavar="DIR", help="draw how it grows, as SVG")
    parser.add_argument("--seed", type=int, default=0, help="[0]")
    return parser


def generator(seed: int) -> np.random.Generator:
    return np.random.default_rng(seed)


def mean_costs(run: Run, constants: Constants) -> Costs:
    """The costs of the second half of a run, when clients have moved."""
    late = run.seconds[len(run.seconds) // 2 :]
    return Costs(*np.mean([costs_of(second, constants) for second in late], axis=0).tolist())


def figures_of(run: Run, constants: Constants) -> dict[str, str]:
    """The figures of a run, as they are printed."""
    costs, last = mean_costs(run, constants), run.seconds[-1]
    pauses = np.concatenate([run.host_pauses_s, run.gateway_pauses_s])
    return {
        "people in the fullest zone": f"{last.in_zone.max()}",
        "gateways": f"{run.gateways}",
        "zones whose frames a gateway gets, mean": f"{last.frames / run.gateways:.1f}",
        "hops a second": f"{np.mean([each.hops for each in run.seconds]):.0f}",
        "cores of hosts": f"{costs.zone_cores:.1f}",
        "cores of gateways": f"{costs.gateway_cores:.1f}",
        "cores of brokers": f"{costs.broker_cores:.1f}",
        "inside, MB/s": f"{1e-6 * costs.inside_bytes:.2f}",
        "out to people, MB/s": f"{1e-6 * costs.out_bytes:.2f}",
        "transactions a second": f"{costs.commits:.0f}",
        "checkpoints, MB/s": f"{1e-6 * costs.checkpoint_bytes:.2f}",
        "people who saw a pause": f"{len(pauses)}",
        "  after a host's death, p50 and p99, s": percentiles(run.host_pauses_s),
        "  after a gateway's death": percentiles(run.gateway_pauses_s),
    }


def percentiles(values: np.ndarray) -> str:
    if not len(values):
        return "-"
    return "{:.1f}  {:.1f}".format(*np.percentile(values, (50, 99)))


def draw(plan: Plan, constants: Constants, seed: int, folder: Path, console: Console) -> None:
    """Draw how bytes and cores grow with the number of zones."""
    sizes = [size for size in GROWTH if size <= plan.zones]
    people = plan.people // plan.zones
    ways = {"at once": 0.0, f"after {plan.move_s:g} s": plan.move_s, "never": math.inf}
    found: dict[str, list[Costs]] = {name: [] for name in ways}
    for size in track(sizes, description="growth", console=console):
        for name, move_s in ways.items():
            way = replace(plan, zones=size, people=size * people, move_s=move_s)
            found[name].append(mean_costs(simulate(way, constants, generator(seed)), constants))
    figure = Figure(figsize=(9.0, 5.0), layout="constrained")
    left, right = figure.subplots(1, 2)
    first = found["at once"]
    left.loglog(sizes, [1e-6 * one.out_bytes for one in first], "ko-", label="out to people")
    right.loglog(sizes, [one.zone_cores for one in first], "ko-", label="hosts")
    for (name, costs), look in zip(found.items(), ("s-", "D--", "^:"), strict=True):
        inside = [1e-6 * one.inside_bytes for one in costs]
        left.loglog(sizes, inside, look, label=f"inside, clients go over {name}")
        right.loglog(sizes, [one.gateway_cores for one in costs], look, label=f"gateways, {name}")
    left.set(xlabel=f"zones of {people} people", ylabel="MB/s")
    right.set(xlabel=f"zones of {people} people", ylabel="cores")
    for axes in (left, right):
        axes.grid(alpha=0.3)
        axes.legend(frameon=False, loc="lower left", bbox_to_anchor=(0.0, 1.0))
    path = folder / "scale.svg"
    figure.savefig(path, metadata={"Date": None})
    console.print(f"drawn: {path}")


if __name__ == "__main__":
    sys.exit(main())

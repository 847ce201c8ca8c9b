"""A real `esplanade serve` full of clients: stages of its ticks, processor time, bytes, memory.

    python -m benchmarks.live                          everything, a quarter of an hour
    python -m benchmarks.live crowd --people 300 --actors 30 --seconds 20
    python -m benchmarks.live sides --rounds 3
    python -m benchmarks.live many --people 4000 --processes 4

Scenarios:

    gallery   actors and visitors in the scene that comes along: steps and contacts against planning
    crowd     everyone walks in the open; walkers, some wanderers of `esplanade bots`, and actors
    idle      clients that send nothing: memory of each, and the time to come in at 20 a second
    sides     people without actors, on our server, on servers without a world, and on Colyseus
    many      the crowd without actors, with --many people (only when it is named)

The server runs in a process of its own, the clients in others. A walker says ten times a second
(--moves) where it walks, and changes its mind about every two seconds. Stages are differences of
what /metrics tells at begin and end, divided by the ticks between. Percentiles come from there too;
those of fewer than 1200 ticks are estimates. A client-tick is one client that gets the news of one
tick. Processor time is that of the whole process of the server, reading and writing included; what
else the machine does disturbs it less than times by the clock, and ratios less than both. The load
average stands beside every figure.

`bare` is a server that discards what it is sent and writes as many bytes to everyone in each tick
as ours does; `websockets` does so with the library of that name and reads every message. Colyseus
gives each client the nearest within the same distance, from the same input, at the same rate; it
sends places and headings, but no steps. It is skipped where it is not installed.
"""

import argparse
import json
import os
import sys
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Final

from benchmarks._live_runs import Plan, crowd, gallery, idle, side_by_side
from benchmarks._live_seen import Seen
from benchmarks._live_servers import colyseus_missing
from benchmarks._live_tables import show, show_sides
from chaos.processes import raise_file_limit
from rich.console import Console

SCENARIOS: Final = ("gallery", "crowd", "idle", "sides", "many")
WIDTH: Final = 120


def main(argv: Sequence[str] | None = None) -> int:
    options = parser().parse_args(argv)
    if not sys.platform.startswith("linux"):
        print("skipped: processor time and memory are read from /proc, which needs Linux")
        return 0
    raise_file_limit()
    console = Console(width=None if sys.stdout.isatty() else WIDTH)
    before = os.sched_getaffinity(0)
    server_cores, load_cores = cores(before, options.free)
    os.sched_setaffinity(0, load_cores)
    try:
        with tempfile.TemporaryDirectory() as folder:
            figures = measure(plan_of(options, Path(folder), server_cores), options, console)
    finally:
        os.sched_setaffinity(0, before)
    if options.json is not None:
        options.json.write_text(json.dumps(figures, indent=1) + "\n")
    return 0


def parser() -> argparse.ArgumentParser:
    """The options."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.live", description=__doc__)
    parser.formatter_class = argparse.RawDescriptionHelpFormatter
    parser.add_argument("scenarios", nargs="*", metavar="SCENARIO", help="[all but many]")
    parser.add_argument("--people", type=int, default=1000, help="of crowd and sides [1000]")
    parser.add_argument("--actors", type=int, default=100, help="of the crowd [100]")
    parser.add_argument("--bots", type=int, default=20, help="wanderers in the crowd [20]")
    parser.add_argument("--gallery-actors", type=int, default=200, metavar="N", help="[200]")
    parser.add_argument("--visitors", type=int, default=20, help="of the gallery [20]")
    parser.add_argument("--idle", type=int, default=400, help="idle clients [400]")
    parser.add_argument("--many", type=int, default=4000, help="people of many [4000]")
    parser.add_argument("--rounds", type=int, default=2, help="of sides, all in turns [2]")
    parser.add_argument("--seconds", type=float, default=60.0, help="that are measured [60]")
    parser.add_argument("--warm-up", type=float, default=5.0, metavar="S", help="before [5]")
    parser.add_argument("--side", type=float, default=100.0, metavar="M", help="of the field [100]")
    parser.add_argument("--join-rate", type=float, default=100.0, metavar="HZ", help="[100]")
    parser.add_argument("--walking", type=float, default=1.0, help="share that walks [1.0]")
    parser.add_argument("--moves", type=float, default=10.0, metavar="HZ", help="of each [10]")
    parser.add_argument("--processes", type=int, default=1, help="of walkers [1]")
    parser.add_argument("--free", action="store_true", help="let server and load share all cores")
    parser.add_argument("--json", type=Path, metavar="F", help="also write the figures here")
    return parser


def cores(here: set[int], free: bool) -> tuple[set[int] | None, set[int]]:
    """The cores of the server, and those of everything else: the last is the server's alone."""
    if free or len(here) < 2:
        return None, here
    return {max(here)}, here - {max(here)}


def plan_of(options: argparse.Namespace, folder: Path, server_cores: set[int] | None) -> Plan:
    """The settings of every scenario by these options."""
    return Plan(
        folder=folder,
        seconds=options.seconds,
        warm_up_s=options.warm_up,
        side_m=options.side,
        join_rate=options.join_rate,
        walking=options.walking,
        move_rate=options.moves,
        processes=options.processes,
        server_cores=server_cores,
    )


def measure(plan: Plan, options: argparse.Namespace, console: Console) -> dict[str, Any]:
    """Run the scenarios one after the other and print what was seen of each."""
    chosen = options.scenarios or SCENARIOS[:-1]
    unknown = sorted(set(chosen) - set(SCENARIOS))
    if unknown:
        raise SystemExit(f"{unknown[0]!r} is no scenario, expected one of {', '.join(SCENARIOS)}")
    held = "on any core" if plan.server_cores is None else f"on core {min(plan.server_cores)}"
    console.print(
        f"server {held}, load on the others, {plan.seconds:g} s each, "
        f"load average {os.getloadavg()[0]:.2f}; whatever else runs disturbs these figures"
    )
    one: dict[str, Callable[[], Seen]] = {
        "gallery": lambda: gallery(plan, options.gallery_actors, options.visitors),
        "crowd": lambda: crowd(plan, "crowd", options.people, options.actors, options.bots),
        "idle": lambda: idle(plan, options.idle),
        "many": lambda: crowd(plan, "many", options.many, 0),
    }
    figures: dict[str, Any] = {}
    for name in chosen:
        if name == "sides":
            if absent := colyseus_missing():
                console.print(f"\nskipped: {absent}")
            rounds = side_by_side(plan, options.people, options.rounds)
            show(console, rounds["esplanade"][-1])
            show_sides(console, rounds)
            figures[name] = {who: [seen.plain() for seen in many] for who, many in rounds.items()}
        else:
            seen = one[name]()
            show(console, seen)
            figures[name] = seen.plain()
    return figures


if __name__ == "__main__":
    sys.exit(main())

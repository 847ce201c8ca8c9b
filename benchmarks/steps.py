"""Measures real steps as a client sees them: whether feet slide, and what steps cost on the wire.

    python -m benchmarks.steps                          20 visitors who wander among 10 actors
    python -m benchmarks.steps --crowd zara1.csv        a recorded crowd, replayed as it was
    python -m benchmarks.steps --crowd zara1.csv --seconds 120 --json figures.json
    python -m benchmarks.steps --flights 0 30 45        flights of stairs at these angles

The benchmark starts a server and a crowd of bots that walk about; one more bot stands in the middle
and looks on. From the steps and snapshots that this one is sent, and nothing else, everyone is
drawn 60 times a second. Measured is how far planted feet move, how well one step joins the next,
and how many bytes a second each walker costs. On flights, eight people and some actors walk up and
down, and their feet are compared with the treads.
"""

import argparse
import asyncio
import json
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

import numpy as np
from benchmarks._slide import Findings, Floats, judge
from benchmarks._step_log import Cost, Seen, StepLog, cost_of, kinds_of
from benchmarks._treads import (
    KEY,
    Flight,
    judge_treads,
    millimetres,
    onlooker_place,
    walk_up_and_down,
)
from rich.console import Console
from rich.table import Table

from esplanade import bots
from esplanade.bots.load import LoadJob
from esplanade.bots.replay import ReplayJob
from esplanade.bots.tally import Tally
from esplanade.recordings import Crowd, Track, read_crowd
from esplanade.server import logs
from esplanade.server.app import running
from esplanade.server.settings import ServerSettings

VISITORS: Final = 20
JOINING_S: Final = 2.0
"""The onlooker begins to look after this time, when everyone has joined."""


def main(argv: Sequence[str] | None = None) -> int:
    options = parser().parse_args(argv)
    if options.flights:
        found = flights(Console(), options)
    else:
        settings = settings_of(options.actors, crowd=options.crowd)
        crowd = None if options.crowd is None else read_crowd(options.crowd)
        with logs.written(settings):
            log, everyone, seconds = asyncio.run(watch(settings, crowd, options.seconds))
        findings, cost = judge(everyone, log.tick_rate), cost_of(log, everyone, seconds)
        show(Console(), findings, cost)
        found = figures(findings, cost, kinds_of(everyone))
    if options.json is not None:
        options.json.write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    return 0


def settings_of(actors: int, **changes: Any) -> ServerSettings:
    """A server without anything that is not measured."""
    return ServerSettings(
        actors=actors, host="127.0.0.1", port=0, private_port=0, log_level="error", **changes
    )


def parser() -> argparse.ArgumentParser:
    made = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    made.add_argument("--crowd", type=Path, help="recorded crowd (CSV t,id,x,y) to replay")
    made.add_argument("--seconds", type=float, default=30.0, help="how long to look on")
    made.add_argument("--actors", type=int, default=10, help="computer-run actors")
    made.add_argument(
        "--flights", type=float, nargs="+", metavar="DEG", help="flights of stairs at these angles"
    )
    made.add_argument("--json", type=Path, help="also write the figures here")
    return made


async def watch(
    settings: ServerSettings, crowd: Crowd | None, seconds: float, flight: Flight | None = None
) -> tuple[StepLog, list[Seen], float]:
    """Log what an onlooker in the middle of a crowd sees for some seconds of the world's time."""
    async with running(settings) as server:
        url = f"ws://127.0.0.1:{server.port}"
        x0, y0, x1, y1 = server.world.scene.bounds
        middle = (x0 + x1) / 2.0, (y0 + y1) / 2.0
        x, y = middle if flight is None else onlooker_place(flight)
        stop = asyncio.Event()
        if flight is None:
            walking = asyncio.create_task(_crowd(url, crowd, seconds).run(Tally(), stop))
        else:
            walking = asyncio.create_task(walk_up_and_down(url, flight, stop))
        await asyncio.sleep(JOINING_S)
        key = None if flight is None else KEY
        async with bots.connect(url, name="Onlooker", at=(x, y, 0), operator=key) as bot:
            log = StepLog(bot)
            first = bot.tick
            async for event in bot.events():
                log.take(event)
                if bot.tick - first >= seconds * log.tick_rate:
                    break
            if bot.dropped_events:
                raise RuntimeError(f"{bot.dropped_events} events were lost: too busy a machine")
        stop.set()
        with suppress(asyncio.CancelledError):
            await walking
    return log, log.end(), seconds


def flights(console: Console, options: argparse.Namespace) -> dict[str, Any]:
    """Print how feet meet the treads of a flight at each angle, one beside the other."""
    found: dict[str, Any] = {}
    for degrees in options.flights:
        flight = Flight.at_angle(degrees)
        with TemporaryDirectory() as folder:
            path = Path(folder, "flight.json")
            flight.write(path)
            settings = settings_of(options.actors, scene=path, operator_key=KEY)
            with logs.written(settings):
                log, everyone, _ = asyncio.run(watch(settings, None, options.seconds, flight))
        slides = spread(judge(everyone, log.tick_rate).slide)
        treads = judge_treads(everyone, log.tick_rate, flight)
        found[f"{degrees:g}"] = {**millimetres(treads), "slide": slides}
    table = Table("millimetres, p99 and worst", *(f"{degrees} degrees" for degrees in found))
    for title, name in TREADS:
        cells = [f"{each[name]['p99']:.1f}  {each[name]['worst']:.1f}" for each in found.values()]
        table.add_row(title, *cells)
    shares = [f"{each['cut over 1 cm, %']:.3f} %" for each in found.values()]
    table.add_row("heels and toes deeper than 10 mm", *shares)
    table.add_row("footprints", *(f"{each['off_tread']['count']:,}" for each in found.values()))
    console.print(table)
    return found


def _crowd(url: str, crowd: Crowd | None, seconds: float) -> LoadJob | ReplayJob:
    if crowd is None:
        return LoadJob(url, count=VISITORS, first=0, step=1, seed=0, join_rate=50.0, duration_s=0.0)
    return ReplayJob(url, busiest(crowd, seconds), speedup=1.0, linger_s=0.0)


def busiest(crowd: Crowd, seconds: float) -> tuple[Track, ...]:
    """The tracks that begin in that stretch of a number of seconds in which most people walk."""
    tracks = [track for track in crowd.tracks if len(track.times) > 1]
    begins = np.array([track.start_s for track in tracks])
    ends = np.array([track.end_s for track in tracks])
    # A replay begins with the start of its first track, so only starts are tried.
    crowded = [
        np.clip(np.minimum(ends, t + seconds) - np.maximum(begins, t), 0.0, None)[begins >= t].sum()
        for t in begins
    ]
    from_s = float(begins[int(np.argmax(crowded))])
    return tuple(t for t in tracks if from_s <= t.start_s <= from_s + seconds)


# --- what it came to --------------------------------------------------------------------------

TREADS: Final = (
    ("footprints above or below their tread", "off_tread"),
    ("feet that hang over an edge", "hanging"),
    ("heels and toes below the ground", "cut"),
    ("planted feet, from frame to frame", "slide"),
)
MILLIMETRES: Final = (
    ("planted feet, from frame to frame", "slide"),
    ("planted feet, from where they stand", "drift"),
    ("swing foot at its landing", "landing"),
    ("feet, from one record to the next", "jump_feet"),
    ("hips, from one record to the next", "jump_root"),
    ("hips from the place in snapshots", "off_body"),
)


def figures(findings: Findings, cost: Cost, kinds: dict[str, int]) -> dict[str, Any]:
    """All figures, for JSON; distances are in millimetres."""
    return {
        "frames": int(findings.frames.sum()),
        "walkers": len(findings.frames),
        "records": kinds,
        "mm": {name: spread(getattr(findings, name)) for _, name in MILLIMETRES},
        "step_length_error_mm": spread(step_errors(findings)),
        "step_length_mm": spread(findings.step_m),
        "cost": asdict(cost),
    }


def step_errors(findings: Findings) -> Floats:
    """Differences between the lengths of steps and what the body covers meanwhile, metres."""
    return np.abs(findings.step_m - findings.travel_m)


def spread(metres: Floats) -> dict[str, float] | None:
    """Percentiles, the worst and the number of some distances, millimetres; None without any."""
    if not len(metres):
        return None
    values = {f"p{p}": float(np.percentile(metres, p)) for p in (50, 99)}
    values["worst"] = float(metres.max())
    return {name: 1e3 * value for name, value in values.items()} | {"count": float(len(metres))}


def show(console: Console, findings: Findings, cost: Cost) -> None:
    table = Table("millimetres", "p50", "p99", "worst", "count")
    rows = [(title, getattr(findings, name)) for title, name in MILLIMETRES]
    for title, metres in (*rows, ("length of steps against the body's", step_errors(findings))):
        found = spread(metres)
        if found is not None:
            cells = [f"{found[name]:.3f}" for name in ("p50", "p99", "worst")]
            table.add_row(title, *cells, f"{int(found['count']):,}")
    console.print(table)
    console.print(
        f"{cost.steps:,} steps of {len(findings.frames)} avatars, {cost.visible_at_once:.1f} at a "
        f"time, {int(findings.frames.sum()):,} frames; {cost.step_bytes:,} bytes: "
        f"{cost.for_each_visible:.0f} bytes/s for each visible, {cost.for_each_walking:.0f} for "
        "each who walks"
    )


if __name__ == "__main__":
    raise SystemExit(main())

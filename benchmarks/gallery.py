"""Actors and visitors in the gallery: trips, contacts, and impossible positions.

    python -m benchmarks.gallery                                    a minute, 20 actors, 20 bots
    python -m benchmarks.gallery --actors 50 --bots 50 --seconds 300
    python -m benchmarks.gallery --scene scenes/gallery.json scenes/gallery_turned.json --runs 5

The server runs in a process of its own and the visitors in another, over real sockets. One more
client stands still and observes: the positions of all avatars that it is sent in every tick are
checked against the shapes of the scene file, and contacts are judged by who moved. Goals of trips
that end without a way are listed by name. The exit code is 1 if an avatar was inside an obstacle or
stood on nothing, or if a trip ended without a way where `find_path` finds one.
"""

import argparse
import asyncio
import json
import multiprocessing as mp
import sys
import tempfile
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

import numpy as np
import uvloop
from benchmarks._contact_causes import SeenBody, contact_causes
from benchmarks._lost_trips import LostTrips
from benchmarks._position_checks import Points, clearances, inside, unsupported

from esplanade import bots
from esplanade.bots.events import SnapshotEvent
from esplanade.planning import Scene
from esplanade.planning.scene.scene_file import read_scene
from esplanade.protocol import Kind
from esplanade.protocol.messages import Enter
from esplanade.server import logs
from esplanade.server.app import running
from esplanade.server.loading import DEFAULT_SCENE
from esplanade.server.settings import ServerSettings

VIEW_M = 200.0
TOUCHING_M = 0.15
"""The centre of a body is nearer than this to a wall only if it is pressed into the wall."""
STEP_M = 0.65
"""Nobody may rise or fall by more than this between two ticks."""
FAULTS = ("inside", "unsupported", "no_way_though_there_is")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--scene", type=Path, nargs="+", default=[DEFAULT_SCENE], help="scenes of polygons, in turn"
    )
    parser.add_argument("--runs", type=int, default=1, help="of each scene [1]")
    parser.add_argument("--actors", type=int, default=20)
    parser.add_argument("--bots", type=int, default=20)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--json", type=Path, help="also write the figures here")
    options = parser.parse_args()
    runs: list[dict[str, Any]] = []
    for run in range(options.runs):
        for path in options.scene:
            figures = {"scene": path.stem, **measure(path, options, options.seed + run)}
            print("\n".join(_line(name, value) for name, value in figures.items()), flush=True)
            runs.append(figures)
    if options.json:
        options.json.write_text(json.dumps(runs, indent=1))
    return int(any(run[fault] for run in runs for fault in FAULTS))


def _line(name: str, value: str | int | float) -> str:
    form = {int: ",", float: "g"}.get(type(value), "")
    return f"{name:24} {value:{form}}"


def measure(path: Path, options: argparse.Namespace, seed: int) -> dict[str, Any]:
    """The figures of one run in one scene."""
    settings = ServerSettings(
        scene=path, actors=options.actors, seed=seed, host="127.0.0.1", port=0,
        private_port=0, view_radius_m=VIEW_M, view_limit=options.actors + options.bots + 1,
        log_level="error",
    )  # fmt: skip
    here, there = mp.get_context("spawn").Pipe()
    process = mp.get_context("spawn").Process(target=serve, args=(there, settings), daemon=True)
    process.start()
    seen, bodies, visitors = uvloop.run(watch(here.recv(), options.bots, options.seconds, seed))
    here.send("end")
    causes = contact_causes(seen, bodies, settings.tick_s).figures()
    figures = {**here.recv(), **causes, **visitors, **position_figures(read_scene(path), seen)}
    process.join()
    return figures


def serve(parent: Connection, settings: ServerSettings) -> None:
    """Run a world until a message arrives, and send back its summary."""

    async def run() -> None:
        async with running(settings) as server:
            parent.send(server.port)
            trips = LostTrips(server.world)
            looking = asyncio.create_task(trips.look())
            await asyncio.to_thread(parent.recv)
            looking.cancel()
            lost = {"walkers_lost": server.world.feet.lost}
            parent.send({**server.summary(), **trips.figures(), **lost})

    with logs.written(settings):
        uvloop.run(run())


async def watch(
    port: int, visitors: int, seconds: float, seed: int
) -> tuple[Points, dict[int, SeenBody], dict[str, Any]]:
    """The positions and bodies of all others that one client is sent, and how visitors' walks went.

    Positions are float64 (N, 5): tick, id, x, y and z, metres.
    """
    url = f"ws://127.0.0.1:{port}"
    with tempfile.TemporaryDirectory() as folder:
        report = Path(folder, "bots.json")
        command = ["bots", "--url", url, "--count", str(visitors), "--duration", str(seconds)]
        bots_process = await asyncio.create_subprocess_exec(
            sys.executable, "-m", "esplanade", *command, "--seed", str(seed), "--json", report,
            stdout=asyncio.subprocess.DEVNULL,
        )  # fmt: skip
        rows: list[Points] = []
        bodies: dict[int, SeenBody] = {}
        async with bots.connect(url, name="Watcher") as watcher:
            reading = asyncio.create_task(_read(watcher, rows, bodies))
            code = await bots_process.wait()
            reading.cancel()
        told = json.loads(await asyncio.to_thread(report.read_text))
    if code:
        raise SystemExit(f"some of the visitors failed: exit code {code}")
    return (
        np.concatenate(rows),
        bodies,
        {
            "visitors_lost": told["clients"]["lost"],
            "walks_without_a_way": told["no_path"],
        },
    )


async def _read(watcher: bots.Bot, rows: list[Points], bodies: dict[int, SeenBody]) -> None:
    async for event in watcher.events():
        if isinstance(event, Enter):
            for each in event.entities:
                bodies[each.id] = SeenBody(each.kind == Kind.ACTOR, each.radius)
        elif isinstance(event, SnapshotEvent):
            records = event.records
            ticks = np.full(len(records), event.tick)
            columns = [ticks, records["id"], *event.positions.T, event.heights]
            rows.append(np.stack(columns, axis=1).astype(np.float64))


def position_figures(scene: Scene, seen: Points) -> dict[str, Any]:
    """The figures of all positions, which are (N, 5): tick, id, x, y and z."""
    seen = seen[np.lexsort((seen[:, 0], seen[:, 1]))]
    points = seen[:, 2:]
    following = (np.diff(seen[:, 1]) == 0.0) & (np.diff(seen[:, 0]) == 1.0)
    moves = np.diff(points, axis=0)[following]
    heights = points[:, 2]
    floors = np.unique([spawn.z_m for spawn in scene.spawns])
    on_floor = [float((np.abs(heights - z) < 0.05).mean()) for z in floors]
    away = clearances(scene, points)
    return {
        "positions": len(points),
        "avatars": len(np.unique(seen[:, 1])),
        **{f"share_at_{z:g}_m": share for z, share in zip(floors, on_floor, strict=True)},
        "share_between": 1.0 - sum(on_floor),
        "inside": int(inside(scene, points).sum()),
        "unsupported": int(unsupported(scene, points).sum()),
        "nearest_m": round(float(away.min()), 3),
        "pressed_share": float((away < TOUCHING_M).mean()),
        "longest_move_m": round(float(np.hypot(*moves[:, :2].T).max()), 3),
        "highest_step_m": round(float(np.abs(moves[:, 2]).max()), 3),
        "steps_too_high": int((np.abs(moves[:, 2]) > STEP_M).sum()),
    }


if __name__ == "__main__":
    sys.exit(main())

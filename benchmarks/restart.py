"""Measures restarts: taking a checkpoint between two ticks, its bytes, and the time to ready.

    python -m benchmarks.restart

Taking is what a tick's thread does; packing and writing happen in other threads. A start is that of
a process with its kernels and its Python sources compiled, up to the line that says that it is
open; the one that counts is the second of a world, which goes on.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from esplanade.server.building import build_world
from esplanade.server.checkpoint.format import pack
from esplanade.server.loading import load_scene
from esplanade.server.settings import ServerSettings
from esplanade.server.world.inputs import Input, Join

SIZES = ((10, 20), (100, 100), (500, 500))
TICKS_BETWEEN = 20
JOINS_A_TICK = 50


def measured(actors: int, people: int, rounds: int) -> None:
    """Print what checkpoints of a world of this size cost."""
    settings = ServerSettings(actors=actors, max_clients=max(1, people))
    population, world, _ = build_world(load_scene(settings), settings)
    joins: list[Input] = [Join(k, f"p{k}", None) for k in range(people)]
    takes, packs, payload = [], [], b""
    for _ in range(rounds):
        for _ in range(TICKS_BETWEEN):
            world.begin(joins[:JOINS_A_TICK])
            del joins[:JOINS_A_TICK]
            world.finish(world.think())
        start = time.thread_time()
        saved = world.save()
        taken = time.thread_time()
        payload = pack(saved)
        packs.append(time.thread_time() - taken)
        takes.append(taken - start)
    population.close()
    take, most, packing = 1e3 * np.median(takes), 1e3 * max(takes), 1e3 * np.median(packs)
    print(
        f"{actors} actors, {people} people: taken in {take:.2f} ms (most {most:.2f}), "
        f"packed in {packing:.1f} ms elsewhere, {len(payload) / 1e3:.0f} kB",
        flush=True,
    )


def started(data: Path, actors: int) -> str:
    """Start a server and kill it; the seconds until it is open, and those of the processor."""
    begin = time.perf_counter()
    places = ("--host", "127.0.0.1", "--port", "0", "--private-port", "0")
    log = ("--log-format", "json", "--data", str(data), "--actors", str(actors))
    kept = {key: value for key, value in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"}
    with subprocess.Popen(
        [sys.executable, "-m", "esplanade", "serve", *places, *log],
        stderr=subprocess.PIPE,
        env=kept,
    ) as process:
        assert process.stderr is not None
        for line in process.stderr:
            if json.loads(line)["event"] == "open":
                break
        seconds = time.perf_counter() - begin
        fields = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
        busy = (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
        time.sleep(2.5)
        process.kill()
    return f"{seconds:.1f} s (processor {busy:.1f} s)"


def main(arguments: Sequence[str] | None = None) -> None:
    """Print all figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rounds", type=int, default=10, help="checkpoints of each size")
    rounds = parser.parse_args(arguments).rounds
    for actors, people in SIZES:
        measured(actors, people, rounds)
    for actors in (10, 100):
        with tempfile.TemporaryDirectory() as folder:
            new, again = started(Path(folder), actors), started(Path(folder), actors)
        print(f"{actors} actors: open in {new}; when it goes on, in {again}")


if __name__ == "__main__":
    main()

"""The compared servers, each started in a process of its own, and what they take of the machine."""

import json
import os
import subprocess
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import chaos.server
import numpy as np
from benchmarks._node import node_missing, node_program
from chaos.server import Server, resident_mb

from esplanade.planning import Scene, Spawn

PROJECT: Final = Path(__file__).resolve().parents[1]
COLYSEUS: Final = Path(__file__).parent / "colyseus"
TICK_RATE: Final = 20
MAX_SPEED_MPS: Final = 3.0
ARRIVALS_M: Final = 10.0
"""Places of arrival are so far apart, so that walkers come in all over the field."""
STOP_S: Final = 10.0
_CLOCK_TICKS: Final = os.sysconf("SC_CLK_TCK")
_SCHEDULED: Final = 2
"""Linux has a clock of the processor time of every process, whose number ends with these bits."""


@dataclass(frozen=True)
class Usage:
    """The processor time and memory that a process has taken so far."""

    processor_s: float
    main_thread_s: float
    """Of it the thread with the event loop."""
    memory_kb: float
    """Resident memory."""

    @classmethod
    def of(cls, process: int) -> "Usage":
        return cls(
            time.clock_gettime(~process << 3 | _SCHEDULED),
            _thread_s(Path(f"/proc/{process}/task/{process}/stat")),
            1024.0 * resident_mb(process),
        )


@dataclass(frozen=True)
class Peer:
    """A running server: how walkers speak with it, and where."""

    name: str
    dialect: str
    process: int
    port: int
    paths: Sequence[str]


@contextmanager
def held_to(cores: set[int] | None) -> Iterator[None]:
    """Processes that are started within run on these cores only; None leaves them free."""
    if cores is None:
        yield
        return
    before = os.sched_getaffinity(0)
    os.sched_setaffinity(0, cores)
    try:
        yield
    finally:
        os.sched_setaffinity(0, before)


@contextmanager
def serving(folder: Path, cores: set[int] | None, actors: int, *options: str) -> Iterator[Server]:
    """A real `esplanade serve`.

    Raises
    ------
    ServerError
        It does not start.
    """
    with ExitStack() as stack:
        with held_to(cores):
            server = stack.enter_context(chaos.server.serving(folder, *options, actors=actors))
        yield server


@contextmanager
def field_server(
    folder: Path, cores: set[int] | None, people: int, actors: int, side_m: float
) -> Iterator[tuple[Server, Peer]]:
    """A real `esplanade serve` with a square of open ground, for so many people."""
    scene = folder / "field.json"
    scene.write_text(field_of(side_m).model_dump_json())
    options = ("--scene", str(scene), "--max-clients", str(people))
    with serving(folder, cores, actors, *options) as server:
        yield server, Peer("esplanade", "esplanade", server.pid, server.port, ["/ws"] * people)


def field_of(side_m: float) -> Scene:
    """Open ground with places of arrival all over it."""
    middles = np.arange(0.5 * ARRIVALS_M, side_m, ARRIVALS_M).tolist()
    spawns = tuple(
        Spawn(position=(x, y), radius_m=0.5 * ARRIVALS_M) for x in middles for y in middles
    )
    scene = Scene.open_space((0.0, 0.0, side_m, side_m), name="field")
    return scene.model_copy(update={"spawns": spawns})


@contextmanager
def plain_server(kind: str, cores: set[int] | None, people: int, size: int) -> Iterator[Peer]:
    """A server without a world, `bare` or `websockets`, whose frames have this many bytes."""
    command = [sys.executable, "-m", "benchmarks._live_peers", kind, str(size)]
    with _started(command, cores) as (process, line):
        yield Peer(kind, "bare", process, int(line), ["/"] * people)


def colyseus_missing() -> str | None:
    """A message about what must be installed first; None if everything is installed."""
    if absent := node_missing():
        return absent
    if not (COLYSEUS / "node_modules" / "@colyseus" / "core").is_dir():
        return "Colyseus is absent: python tools/npm.py --prefix ../benchmarks/colyseus ci"
    return None


@contextmanager
def colyseus_server(
    cores: set[int] | None, people: int, side_m: float, view: tuple[float, int]
) -> Iterator[Peer]:
    """The same world of people on Colyseus; `view` is the distance in metres and the most seen."""
    options = {
        "people": people,
        "side_m": side_m,
        "view_m": view[0],
        "view_limit": view[1],
        "tick_rate": TICK_RATE,
        "max_speed": MAX_SPEED_MPS,
    }
    command = [node_program(), str(COLYSEUS / "world.mjs"), json.dumps(options)]
    with _started(command, cores) as (process, line):
        told = json.loads(line)
        yield Peer("colyseus", "colyseus", process, told["port"], told["paths"])


@contextmanager
def _started(command: Sequence[str], cores: set[int] | None) -> Iterator[tuple[int, str]]:
    """A program that prints one line when it serves, and ends with its standard input."""
    with held_to(cores):
        process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd=PROJECT
        )
    assert process.stdin is not None
    assert process.stdout is not None
    try:
        line = process.stdout.readline()
        if not line:
            raise RuntimeError(f"{command[0]} has ended with code {process.wait()}")
        yield process.pid, line
        process.stdin.close()
        process.wait(STOP_S)
    finally:
        process.kill()
        process.wait()
        process.stdout.close()


def _thread_s(stat: Path) -> float:
    fields = stat.read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / _CLOCK_TICKS

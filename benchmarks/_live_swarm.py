"""Walkers by the hundred, in processes of their own: they steer and count what comes."""

import asyncio
import multiprocessing
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from typing import Final

import numpy as np
import uvloop
from benchmarks._live_dialects import DIALECTS
from benchmarks._live_walker import Walker
from chaos.processes import raise_file_limit

TURN_EVERY_S: Final = 2.0
"""A walker changes its mind about this often; until then it repeats its wish."""
SPEED_MPS: Final = 1.3
JOIN_S: Final = 600.0
"""A server that is overloaded lets clients in late."""
_SLICES: Final = 20


@dataclass(frozen=True)
class Share:
    """The walkers of one process."""

    dialect: str
    port: int
    paths: Sequence[str]
    first: int
    side_m: float
    join_rate: float
    walking: float
    """The part of them that walks at any time; the others stand, and send as much."""
    move_rate: float = 10.0
    """Movements that each sends a second; with 0 they are idle and send nothing but pongs."""


@dataclass
class Count:
    """The traffic of the walkers between two moments."""

    seconds: float = 0.0
    bytes_in: int = 0
    sent: int = 0
    snapshots: list[int] = field(default_factory=list)
    """Of each walker."""
    lost: int = 0
    """Connections that have ended."""


class Swarm:
    """All processes of walkers, seen from the one that measures."""

    def __init__(self, pipes: Sequence[Connection]) -> None:
        self._pipes = pipes
        self.join_s: list[float] = []
        """For each, the time from TCP to the welcome."""
        for pipe in pipes:
            self.join_s += pipe.recv()

    def count(self, seconds: float) -> Count:
        """Let this time pass, and count what came meanwhile."""
        self.begin()
        time.sleep(seconds)
        return self.end()

    def begin(self) -> None:
        """Begin to count."""
        for pipe in self._pipes:
            pipe.send("begin")

    def end(self) -> Count:
        """Stop counting and tell."""
        for pipe in self._pipes:
            pipe.send("tell")
        counts: list[Count] = [pipe.recv() for pipe in self._pipes]
        return Count(
            seconds=float(np.mean([each.seconds for each in counts])),
            bytes_in=sum(each.bytes_in for each in counts),
            sent=sum(each.sent for each in counts),
            snapshots=[number for each in counts for number in each.snapshots],
            lost=sum(each.lost for each in counts),
        )


@contextmanager
def swarming(shares: Sequence[Share]) -> Iterator[Swarm]:
    """Send all walkers in, and take them out again at the end.

    Raises
    ------
    EOFError
        Some were not let in; their process has told why.
    """
    context = multiprocessing.get_context("spawn")
    pipes, processes = [], []
    for share in shares:
        here, there = context.Pipe()
        process = context.Process(target=_run, args=(share, there), daemon=True)
        process.start()
        there.close()
        pipes.append(here)
        processes.append(process)
    try:
        yield Swarm(pipes)
    finally:
        for pipe in pipes:
            pipe.close()
        for process in processes:
            process.join()


def shares_of(whole: Share, processes: int) -> list[Share]:
    """The walkers dealt out to so many processes."""
    dealt = np.array_split(np.arange(len(whole.paths)), processes)
    return [
        Share(
            **{
                **vars(whole),
                "paths": [whole.paths[k] for k in part],
                "first": whole.first + int(part[0]),
                "join_rate": whole.join_rate * len(part) / len(whole.paths),
            }
        )
        for part in dealt
        if len(part)
    ]


def _run(share: Share, parent: Connection) -> None:
    raise_file_limit()
    uvloop.run(_walk(share, parent))


async def _walk(share: Share, parent: Connection) -> None:
    loop = asyncio.get_running_loop()
    walkers = [
        Walker(DIALECTS[share.dialect], path, share.first + k, share.side_m)
        for k, path in enumerate(share.paths)
    ]
    moving = loop.create_task(_steer(walkers, share)) if share.move_rate else None
    began_s = loop.time()
    async with asyncio.timeout(JOIN_S + len(walkers) / share.join_rate):
        for k, walker in enumerate(walkers):
            await asyncio.sleep(began_s + k / share.join_rate - loop.time())
            walker.began_s = time.perf_counter()
            await loop.create_connection(lambda w=walker: w, "127.0.0.1", share.port)
        for walker in walkers:
            await walker.welcomed.wait()
    parent.send([walker.joined_s - walker.began_s for walker in walkers])
    before, since_s = _sums(walkers), loop.time()
    while True:
        try:
            word = await asyncio.to_thread(parent.recv)
        except EOFError:
            break
        now = _sums(walkers)
        if word == "begin":
            before, since_s = now, loop.time()
        else:
            seconds = loop.time() - since_s
            received, sent, snapshots = (b - a for a, b in zip(before, now, strict=True))
            lost = sum(walker.lost for walker in walkers)
            parent.send(Count(seconds, received, sent, snapshots.tolist(), lost))
    if moving is not None:
        moving.cancel()
    for walker in walkers:
        walker.transport.abort()


def _sums(walkers: Sequence[Walker]) -> tuple[int, int, np.ndarray]:
    snapshots = np.array([walker.snapshots for walker in walkers])
    return sum(w.received for w in walkers), sum(w.seq for w in walkers), snapshots


async def _steer(walkers: Sequence[Walker], share: Share) -> None:
    """Let each that is in send its movements, in slices spread over the time between two."""
    loop = asyncio.get_running_loop()
    random = np.random.default_rng(share.first)
    due_s, place, every_s = loop.time(), 0, 1.0 / share.move_rate
    while True:
        for walker in walkers[place::_SLICES]:
            if not walker.inside:
                continue
            if walker.seq == 0 or random.random() < every_s / TURN_EVERY_S:
                walker.direction = float(random.uniform(-np.pi, np.pi))
                walker.speed = SPEED_MPS if random.random() < share.walking else 0.0
            walker.move()
        place = (place + 1) % _SLICES
        due_s += every_s / _SLICES
        await asyncio.sleep(due_s - loop.time())

"""Bots that are killed and come back, again and again: `python -m chaos.resumes --minutes 10`.

At the end each of them must have the avatar that it began with, there must be no other avatar of
a person, and the server's memory must be what it was.
"""

import argparse
import asyncio
import random
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from rich.console import Console
from websockets.asyncio.client import ClientConnection
from websockets.exceptions import WebSocketException

from chaos.canary import greet, opened
from chaos.memory import MEMORY_SHARE, Memory
from chaos.server import Reading, Server, ServerError, serving, unnamed
from chaos.wire import SERVER
from esplanade.commandline.progress import progress
from esplanade.protocol import decode_server, encode, peek_snapshot
from esplanade.protocol.messages import Census, Move, Welcome

WARM_UP_SHARE: Final = 0.1
LIVES_S: Final = (0.2, 4.0)
AWAY_S: Final = (0.0, 2.0)
TAKEOVERS: Final = 0.15
"""The share of lives that end because the bot comes back before it has gone."""

CENSUS_S: Final = 60.0
"""A census comes once a second; it must be right by then at the end."""


@dataclass
class Run:
    """Counts of all bots together."""

    kills: int = 0
    takeovers: int = 0
    resumes: int = 0
    faults: list[str] = field(default_factory=list)
    memory: Memory = field(default_factory=Memory)
    people: int = 0
    """People in the world at the end, by the census."""

    @property
    def passed(self) -> bool:
        return not self.faults and abs(self.memory.growth) <= MEMORY_SHARE


class _Bot:
    """One person: dies at random, and comes back with the newest token."""

    def __init__(self, url: str, name: str, seed: int, run: Run) -> None:
        self._url = url
        self._random = random.Random(seed)
        self._run = run
        self.name = name
        self.id = 0
        self._token: str | None = None

    async def live_until(self, end_s: float) -> ClientConnection:
        """Die and come back until then; the last connection stays open."""
        wire = await self._come()
        while True:
            try:
                await self._walk(wire, self._random.uniform(*LIVES_S))
            except WebSocketException as fault:
                self._run.faults.append(f"{self.name}: {fault}")
            if time.monotonic() >= end_s:
                return wire
            if self._random.random() < TAKEOVERS:
                self._run.takeovers += 1
                before, wire = wire, await self._come()
                before.transport.abort()
            else:
                self._run.kills += 1
                wire.transport.abort()
                await asyncio.sleep(self._random.uniform(*AWAY_S))
                wire = await self._come()

    async def _come(self) -> ClientConnection:
        wire = await opened(self._url)
        welcome = await greet(wire, self.name, self._token)
        if self._token is not None:
            self._check(welcome)
        self.id, self._token = welcome.id, welcome.resume
        return wire

    def _check(self, welcome: Welcome) -> None:
        self._run.resumes += 1
        if not welcome.resumed or welcome.id != self.id:
            self._run.faults.append(f"{self.name} came back as {welcome.id}, not as {self.id}")

    async def _walk(self, wire: ClientConnection, seconds: float) -> None:
        direction = self._random.uniform(-3.0, 3.0)
        await wire.send(encode(Move(seq=1, direction=direction, speed=1.3)))
        loop = asyncio.get_running_loop()
        end_s = loop.time() + seconds
        try:
            async with asyncio.timeout_at(end_s):
                while True:
                    await wire.recv()
        except TimeoutError:
            pass


def resumes(
    folder: Path,
    bots: int,
    seconds: float,
    seed: int,
    *,
    actors: int = 10,
    advance: Callable[[float], None] = lambda _: None,
) -> Run:
    """Let bots die and come back for some time, and look at the world afterwards.

    Raises
    ------
    ServerError
        The server does not start, or does not answer.
    """
    run = Run()
    with serving(folder, actors=actors, seed=seed) as server:
        asyncio.run(_live(server, run, bots, seconds, seed, advance))
        run.faults += unnamed(server.lines())
    return run


async def _live(
    server: Server,
    run: Run,
    number: int,
    seconds: float,
    seed: int,
    advance: Callable[[float], None],
) -> None:
    url = f"ws://{SERVER}:{server.port}/ws"
    bots = [_Bot(url, f"Bot {k}", seed * 1000 + k, run) for k in range(number)]
    end_s = time.monotonic() + seconds
    lives = [asyncio.create_task(bot.live_until(end_s)) for bot in bots]
    warm_s = time.monotonic() + WARM_UP_SHARE * seconds
    before_mb = 0.0
    while time.monotonic() < end_s and not any(life.done() for life in lives):
        await asyncio.sleep(0.25)
        advance(0.25)
        if not before_mb and time.monotonic() >= warm_s:
            before_mb = server.memory_mb()
    wires = await asyncio.gather(*lives)
    after: Reading = await asyncio.to_thread(server.read)
    run.memory = Memory(before_mb, after.memory_mb)
    await _look(wires[0], run, number)
    if len({bot.id for bot in bots}) != number:
        run.faults.append("two bots have one avatar")
    seats = after.metrics["esplanade_clients"] + after.metrics["esplanade_clients_away"]
    if seats != number:
        run.faults.append(f"{seats:g} seats for {number} bots")
    await asyncio.gather(*(wire.close() for wire in wires))


async def _look(wire: ClientConnection, run: Run, number: int) -> None:
    """Read the census until it counts as many people as there are bots."""
    try:
        async with asyncio.timeout(CENSUS_S):
            while run.people != number:
                message = await wire.recv()
                if isinstance(message, bytes) and peek_snapshot(message) is None:
                    said = decode_server(message)
                    run.people = said.people if isinstance(said, Census) else run.people
    except TimeoutError:
        run.faults.append(f"{run.people} avatars of {number} bots")


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="python -m chaos.resumes", description="Bots that are killed and come back."
    )
    parser.add_argument("--minutes", type=float, default=10.0)
    parser.add_argument("--bots", type=int, default=50)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    console = Console()
    seconds = 60.0 * options.minutes
    try:
        with (
            tempfile.TemporaryDirectory() as folder,
            progress(share=True, time_left=True) as bar,
        ):
            task = bar.add_task("bots die and come back", total=seconds)
            run = resumes(
                Path(folder),
                options.bots,
                seconds,
                options.seed,
                advance=lambda passed: bar.advance(task, passed),
            )
    except ServerError as fault:
        console.print(str(fault), markup=False, style="red", soft_wrap=True)
        return 2
    for line in (
        f"{options.bots} bots: {run.kills} kills, {run.takeovers} takeovers, {run.resumes} resumes",
        f"people in the world at the end: {run.people}",
        str(run.memory),
        *(f"FAULT {fault[:2000]}" for fault in run.faults[:20]),
        f"{len(run.faults)} faults",
    ):
        console.print(line, highlight=False, markup=False, soft_wrap=True)
    return 0 if run.passed else 1


if __name__ == "__main__":
    sys.exit(main())

"""A load test's share of one process: many bots that come and go at their times."""

import asyncio
import math
from collections.abc import Callable, Coroutine, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

from esplanade.bots.admission import admission
from esplanade.bots.client import Client, sleep_until, until_first, visit
from esplanade.bots.clock import ServerClock
from esplanade.bots.looks import look_of
from esplanade.bots.player import Player
from esplanade.bots.scenario_file import load_scenario
from esplanade.bots.stages import Stage, Stay, stays
from esplanade.bots.tally import Tally
from esplanade.bots.wanderer import Act, wander
from esplanade.protocol import VERSION
from esplanade.protocol.messages import Hello


class Planned(NamedTuple):
    """Bot `number` is to be in the world at this time, seconds from the beginning."""

    stay: Stay
    number: int


@dataclass(frozen=True)
class LoadJob:
    """Visitors `first`, `first + step`, ... of `count`.

    With stages, these say when each comes and goes. Without, number i joins at i / join_rate
    seconds.
    """

    url: str
    count: int
    first: int
    step: int
    seed: int
    join_rate: float
    duration_s: float
    """Time with everyone there; 0 means until stopped."""
    stages: tuple[Stage, ...] = ()
    scenario: str | None = None
    """The bots do what this class in a file says, FILE:CLASS; without it they wander."""
    trust: Path | None = None
    """The only certificate that is trusted."""
    token: str = ""
    """The token of a bot, by which all of them come in."""

    async def run(self, tally: Tally, stop: asyncio.Event) -> None:
        """Send the visitors in and take them out again, all at their times."""
        play = self._wander if self.scenario is None else self._scenario(self.scenario, tally)
        plan = self._plan()
        tally.expected = len(plan)
        clock = ServerClock()
        began_s = asyncio.get_running_loop().time()
        async with asyncio.TaskGroup() as group:
            for stay, index in plan:
                await sleep_until(began_s + stay.begin_s, stop)
                if stop.is_set():
                    break
                group.create_task(
                    self._visit(index, clock, tally, play, began_s + stay.end_s, stop)
                )

    def _plan(self) -> list[Planned]:
        """Every visit of this share, in the order in which they begin."""
        visitors = range(self.first, self.count, self.step)
        if self.stages:
            plan = [
                Planned(stay, index) for index in visitors for stay in stays(self.stages, index)
            ]
            return sorted(plan)
        end_s = self.count / self.join_rate + self.duration_s if self.duration_s else math.inf
        return [Planned(Stay(index / self.join_rate, end_s), index) for index in visitors]

    async def _visit(
        self,
        index: int,
        clock: ServerClock,
        tally: Tally,
        play: "Play",
        end_s: float,
        stop: asyncio.Event,
    ) -> None:
        hello = Hello(
            name=f"Visitor {index + 1}",
            version=VERSION,
            admission=admission(self.token),
            look=look_of(self.seed, index),
        )

        async def stay(client: Client) -> None:
            works = play(client, index)
            await until_first(*works, client.keep_pinging(), _until(end_s, stop))

        await visit(self.url, hello, clock, tally, stay, self.trust)

    def _wander(self, client: Client, index: int) -> "Works":
        return client.read(), _walk(client, self._acts(client, index))

    def _acts(self, client: Client, index: int) -> Iterator[Act]:
        """Acts in the scene where the client is, also when it has come into another zone."""
        while True:
            welcome = client.welcome
            x0, y0, x1, y1 = welcome.scene["bounds"]
            places = welcome.scene.get("places", ())
            floors_m = sorted({0.0, *(place["z_m"] for place in places)})
            acts = wander(self.seed, index, (x0, y0, x1, y1), welcome.max_speed, floors_m)
            for act in acts:
                if client.welcome is not welcome:
                    break
                yield act

    def _scenario(self, place: str, tally: Tally) -> "Play":
        kind = load_scenario(place)

        def play(client: Client, index: int) -> Works:
            player = Player(kind, client, index, self.seed, tally)
            return client.read(on_frame=player.see), player.play()

        return play


Works = tuple[Coroutine[Any, Any, None], Coroutine[Any, Any, None]]
Play = Callable[[Client, int], Works]


async def _walk(client: Client, acts: Iterator[Act]) -> None:
    for act in acts:
        await client.send(act.message)
        await asyncio.sleep(act.pause_s)


async def _until(time_s: float, stop: asyncio.Event) -> None:
    """Wait until the loop's clock says `time_s`, or until stopped."""
    if math.isinf(time_s):
        await stop.wait()
    else:
        await sleep_until(time_s, stop)

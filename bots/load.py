"""A load test's share of one process: many wanderers that join one after another."""

import asyncio
from collections.abc import Iterator
from dataclasses import dataclass

from esplanade.bots.client import Client, sleep_until, until_first, visit
from esplanade.bots.clock import ServerClock
from esplanade.bots.tally import Tally
from esplanade.bots.wanderer import Act, wander
from esplanade.protocol import VERSION
from esplanade.protocol.messages import Hello


@dataclass(frozen=True)
class LoadJob:
    """Visitors `first`, `first + step`, ... of `count`; number i joins at i / join_rate seconds."""

    url: str
    count: int
    first: int
    step: int
    seed: int
    join_rate: float
    duration_s: float
    """Time with everyone there; 0 means until stopped."""

    async def run(self, tally: Tally, stop: asyncio.Event) -> None:
        """Send the visitors in, keep them walking, take them out again."""
        visitors = range(self.first, self.count, self.step)
        tally.expected = len(visitors)
        clock = ServerClock()
        began_s = asyncio.get_running_loop().time()
        over = asyncio.Event()
        timer = asyncio.create_task(self._end(over, stop))
        async with asyncio.TaskGroup() as group:
            for index in visitors:
                await sleep_until(began_s + index / self.join_rate, over)
                if over.is_set():
                    break
                group.create_task(self._visit(index, clock, tally, over))
        timer.cancel()

    async def _end(self, over: asyncio.Event, stop: asyncio.Event) -> None:
        """Tell the visitors to leave once the time is over, or when stopped."""
        if self.duration_s:
            now_s = asyncio.get_running_loop().time()
            await sleep_until(now_s + self.count / self.join_rate + self.duration_s, stop)
        else:
            await stop.wait()
        over.set()

    async def _visit(
        self, index: int, clock: ServerClock, tally: Tally, over: asyncio.Event
    ) -> None:
        hello = Hello(name=f"Visitor {index + 1}", version=VERSION)

        async def stay(client: Client) -> None:
            scene = client.welcome.scene
            x0, y0, x1, y1 = scene["bounds"]
            floors_m = sorted({0.0, *(place["z_m"] for place in scene.get("places", ()))})
            speed_mps = client.welcome.max_speed
            acts = wander(self.seed, index, (x0, y0, x1, y1), speed_mps, floors_m)
            await until_first(
                client.read(), client.keep_pinging(), _walk(client, acts), over.wait()
            )

        await visit(self.url, hello, clock, tally, stay)


async def _walk(client: Client, acts: Iterator[Act]) -> None:
    for act in acts:
        await client.send(act.message)
        await asyncio.sleep(act.pause_s)

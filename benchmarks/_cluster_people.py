"""People of a benchmark of a cluster: some look at gateways, the others only walk."""

import asyncio
import math
from collections.abc import AsyncIterator, Sequence
from contextlib import asynccontextmanager
from typing import Final

import numpy as np
from benchmarks._cluster_world import SHEPHERD, Seat, World
from chaos.cluster.herd import Herd, Person
from chaos.wire import frame

from esplanade.protocol import encode
from esplanade.protocol.messages import Move
from esplanade.server.cluster.world_rows import world_kept
from esplanade.server.link.batches import MOVEMENT, Batch, encode_batch
from esplanade.server.link.broker import connected
from esplanade.server.link.subjects import Subjects

TICK_S: Final = 0.05
TURN_S: Final = 2.0
"""A walker changes its mind about this often."""
WALKING: Final = 0.7
SPEED_MPS: Final = 1.3
HOLD_S: Final = 0.5


class Wishes:
    """The wishes of walkers: 70 % of them walk at any time, the others stand."""

    def __init__(self, seed: int) -> None:
        self._random = np.random.default_rng(seed)

    def of(self, number: int, chance: float) -> list[tuple[int, float, float]]:
        """Those who change their mind now: index, new direction in radians and speed, m/s."""
        turning = np.flatnonzero(self._random.random(number) < chance)
        angles = self._random.uniform(-math.pi, math.pi, len(turning))
        speeds = SPEED_MPS * (self._random.random(len(turning)) < WALKING)
        return list(zip(turning.tolist(), angles.tolist(), speeds.tolist(), strict=True))


@asynccontextmanager
async def viewers(world: World, seats: Sequence[Seat], seed: int) -> AsyncIterator[Herd]:
    """People who look and walk, each at one of the gateways; all of them are in."""
    people = [Person(seat.name, token=seat.token) for seat in seats]
    herd = Herd(people, [each.port for each in world.gateways], seed)
    tasks = [asyncio.create_task(herd.live())]
    try:
        await herd.all_in()
        tasks.append(asyncio.create_task(_walk(herd, Wishes(seed))))
        yield herd
    finally:
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)


async def _walk(herd: Herd, wishes: Wishes) -> None:
    """Let everybody walk, in steps of a tick."""
    loop = asyncio.get_running_loop()
    due_s, chance, number = loop.time(), 1.0, 0
    while True:
        number += 1
        for k, direction, speed in wishes.of(len(herd.people), chance):
            connection = herd.people[k].connection
            if connection is not None:
                move = Move(seq=number, direction=direction, speed=speed)
                connection.transport.write(frame(encode(move)))
        chance = TICK_S / TURN_S
        due_s += TICK_S
        await asyncio.sleep(due_s - loop.time())


@asynccontextmanager
async def walkers(world: World, seats: Sequence[Seat], seed: int) -> AsyncIterator[None]:
    """People of one zone who walk and do not look: one gateway has them all, and takes no
    frames."""
    if not seats:
        yield
        return
    async with connected([world.broker.address], SHEPHERD) as client:
        subject = await asyncio.to_thread(lambda: world.cluster.ask(world_kept).subject)
        zone = seats[0].zone
        epoch = world.cluster.owner(zone)[1]
        held = [(seat.person, 1) for seat in seats]
        people = np.array([seat.person for seat in seats], dtype=np.uint32)

        async def steer() -> None:
            loop, wishes = asyncio.get_running_loop(), Wishes(seed + 1)
            due_s, chance, number = loop.time(), 1.0, 0
            while True:
                number += 1
                who, directions, speeds = np.array(
                    wishes.of(len(seats), chance) or [(0, 0.0, 0.0)]
                ).T
                movements = np.zeros(len(who), dtype=MOVEMENT)
                movements["person"] = people[who.astype(np.int64)]
                movements["generation"], movements["seq"] = 1, number
                movements["direction_rad"], movements["speed_mps"] = directions, speeds
                everyone = held if number % round(HOLD_S / TICK_S) == 1 else []
                batch = Batch(SHEPHERD, number, epoch, movements, everyone)
                await client.publish(Subjects(subject).inputs(zone), encode_batch(batch))
                # Until all are in, wishes of those who are not there yet have no effect.
                chance = 1.0 if number < 10 / TICK_S and number % 40 == 0 else TICK_S / TURN_S
                due_s += TICK_S
                await asyncio.sleep(due_s - loop.time())

        task = asyncio.create_task(steer())
        try:
            yield
        finally:
            task.cancel()
            await asyncio.gather(task, return_exceptions=True)

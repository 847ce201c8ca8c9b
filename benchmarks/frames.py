"""Frames between a host and gateways: their size, their cost, and their age over NATS.

    python -m benchmarks.frames                        1000 people, then 1, 2 and 4 gateways
    python -m benchmarks.frames --people 4000 --seconds 20

The first table is of frames of an open field on which 70 % of the people walk: bytes for each
avatar and tick, and microseconds of processor time to make them bytes and back, beside those of the
zone's tick. The second sends frames of that size 20 times a second through a nats-server of its own
to gateways in this process, and prints how old they are when they come.
"""

import argparse
import asyncio
import tempfile
import time
from contextlib import AsyncExitStack
from itertools import islice
from pathlib import Path

import numpy as np
from benchmarks._stages import MEASURED_TICKS, WARM_UP_TICKS, steering
from tests.server.brokers import nats_server

from esplanade.planning import LayeredGrid, Scene
from esplanade.server.link.broker import connected
from esplanade.server.link.frame_format import decode_frame, encode_frame
from esplanade.server.link.frame_parts import FrameKey
from esplanade.server.link.frames_over_nats import FrameReceiver, FrameSender
from esplanade.server.link.subjects import Subjects
from esplanade.server.loading import load_scene
from esplanade.server.populating import populate
from esplanade.server.settings import ServerSettings
from esplanade.server.world.inputs import Join
from esplanade.server.world.zone import Zone

SIDE_M = 100.0
TICK_S = 0.05
GATEWAYS = (1, 2, 4)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--people", type=int, default=1000, help="in the field [1000]")
    parser.add_argument("--seconds", type=float, default=10.0, help="of each run [10]")
    options = parser.parse_args()
    size = print_costs(options.people)
    with nats_server() as server:
        print(f"\nframes of {size} bytes over NATS, 20 a second: age when they come, ms")
        print(f"{'gateways':>10}{'p50':>8}{'p99':>8}{'came':>12}")
        for gateways in GATEWAYS:
            ages = asyncio.run(ages_ms(server.address, gateways, bytes(size), options.seconds))
            p50, p99 = np.percentile(ages, [50, 99])
            due = gateways * round(options.seconds / TICK_S)
            print(f"{gateways:10d}{p50:8.2f}{p99:8.2f}{len(ages):7d}/{due}")


def print_costs(people: int) -> int:
    """Print what frames of a crowd cost, and return the bytes of the median one."""
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder, "field.json")
        scene.write_text(Scene.open_space((0.0, 0.0, SIDE_M, SIDE_M)).model_dump_json())
        settings = ServerSettings(scene=scene, actors=0, port=0, private_port=0)
        loaded = load_scene(settings)
    grid = LayeredGrid.from_scene(loaded.scene)
    actors, names = populate(grid, loaded.scene, 0, TICK_S, 0)
    zone = Zone(
        loaded.scene,
        grid,
        actors,
        names,
        loaded.rules,
        tick_s=TICK_S,
        max_people=people,
        seed=0,
        clock=time.thread_time,
    )
    zone.begin([Join(k, "p", None) for k in range(people)])
    ids = [avatar_id for _, avatar_id in zone.finish(zone.think()).joined]
    rows = []
    for inputs in islice(steering(ids, TICK_S), WARM_UP_TICKS + MEASURED_TICKS):
        begin = time.thread_time()
        zone.begin(inputs)
        frame = zone.finish(zone.think())
        ticked = time.thread_time()
        body = encode_frame(frame)
        encoded = time.thread_time()
        decode_frame(body)
        rows.append((len(body), ticked - begin, encoded - ticked, time.thread_time() - encoded))
    size, tick, encode, decode = np.median(rows[WARM_UP_TICKS:], axis=0).tolist()
    print(f"{people} people, median of {MEASURED_TICKS} ticks, processor time")
    print(f"  bytes of a frame       {size:10.0f}   {size / people:.1f} for each avatar")
    print(f"  the zone's tick, ms    {1e3 * tick:10.2f}")
    print(f"  to bytes, µs           {1e6 * encode:10.0f}   {encode / tick:.1%} of the tick")
    print(f"  from bytes, µs         {1e6 * decode:10.0f}   {decode / tick:.1%} of the tick")
    return int(size)


async def ages_ms(server: str, gateways: int, body: bytes, seconds: float) -> list[float]:
    """Return the age of every frame that came to any of the gateways."""
    sent: dict[int, float] = {}
    ages: list[float] = []

    async def take(receiver: FrameReceiver) -> None:
        while True:
            key, _ = await receiver.next()
            if not key.is_whole:
                ages.append(1e3 * (time.perf_counter() - sent[key.tick]))

    async with AsyncExitStack() as stack:
        subjects = Subjects("bench")
        host = await stack.enter_async_context(connected([server], "host"))
        sender = FrameSender(host, subjects, "field", lambda: (FrameKey(1, 0, is_whole=True), b""))
        await sender.start()
        for number in range(gateways):
            client = await stack.enter_async_context(connected([server], f"gateway-{number}"))
            receiver = FrameReceiver(client, subjects, "field")
            await receiver.start()
            taking = asyncio.create_task(take(receiver))
            stack.callback(taking.cancel)
        await asyncio.sleep(1.0)  # everyone has the whole state
        begin = time.perf_counter()
        for tick in range(1, round(seconds / TICK_S) + 1):
            await asyncio.sleep(max(0.0, begin + tick * TICK_S - time.perf_counter()))
            sent[tick] = time.perf_counter()
            await sender.publish(FrameKey(1, tick), body)
        await asyncio.sleep(0.5)
    return ages


if __name__ == "__main__":
    main()

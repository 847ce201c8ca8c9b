"""The cost of consoles that look at a world, for its ticks; and the bytes that each is sent.

    python -m benchmarks.consoles                       1000 people, all of whom walk
    python -m benchmarks.consoles --people 500 --actors 100 --walking 0.7

A world ticks in real time; its operators' port has a thread of its own, as in a server, and the
consoles are another process. `own` is the time that ticks are handed over in, by the clock of the
thread that ticks; `other thread` is the processor time of the port's thread, which has turns of the
interpreter between those of the tick; `tick` is a whole tick by the clock on the wall. Before and
after each round with consoles there is one without. With actors, the time of a trace of a decision
is told too, in the thread of the actors and for its text, and that of what `actor:ID` tells.
"""

import argparse
import asyncio
import gc
import json
import multiprocessing as mp
import tempfile
import threading
import time
from collections.abc import Sequence
from concurrent.futures import Future
from itertools import cycle
from multiprocessing.connection import Connection
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
from benchmarks import _stages
from fastapi import FastAPI
from websockets.asyncio.client import connect

from esplanade.planning import LayeredGrid, Scene
from esplanade.server.accounts.identity import MACHINE
from esplanade.server.console.live_socket import router
from esplanade.server.live.bulletin import Bulletin
from esplanade.server.live.live import Live, beating
from esplanade.server.live.one_actor import actor_probe
from esplanade.server.live.told_traces import told_trace
from esplanade.server.loading import LoadedScene, load_scene
from esplanade.server.metrics import Traffic
from esplanade.server.net.asgi import serving
from esplanade.server.populating import populate
from esplanade.server.settings import ServerSettings
from esplanade.server.world.inputs import Input, Join
from esplanade.server.world.zone import Zone

SIDE_M = 100.0
TICK_S = 0.05


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--people", type=int, default=1000)
    parser.add_argument("--actors", type=int, default=0)
    parser.add_argument("--walking", type=float, default=1.0, help="part of the people")
    parser.add_argument("--consoles", type=int, nargs="+", default=[1, 5])
    parser.add_argument("--seconds", type=float, default=15.0, help="of each round")
    options = parser.parse_args()
    _stages.WALKING = options.walking
    world = World(options.people, options.actors)
    print(f"{options.people} people and {options.actors} actors in {SIDE_M:g} m square")
    asyncio.run(world.ticks(3.0))
    gc.collect()
    gc.freeze()
    port, stop = world.open_port()
    try:
        for consoles in cycle_of(options.consoles):
            print_round(world, port, consoles, options.seconds)
    finally:
        stop()
    if options.actors:
        print_traces(world)


def print_traces(world: "World", rounds: int = 200) -> None:
    """The time of traces, and of what a subscription to an actor is told, tick after tick."""
    zone, live = world.zone, world.live
    avatars = [avatar for each in zone.agents if (avatar := zone.avatar_of(str(each)))]
    traced, text, channel, kept = [], [], [], []
    zone.keep_decisions(True)
    world.tick()
    for k in range(rounds):
        world.tick()
        live.beat()
        avatar = avatars[k % len(avatars)]
        actor = zone.actor_of(avatar) or ""
        answer = live.tap.traces.ask(avatar)
        begun = time.thread_time()
        live.tap.traces.make_one()
        traced.append(1e3 * (time.thread_time() - begun))
        found = answer.result()
        if found is None or not found.trace.exact:
            raise RuntimeError(f"the trace of {actor} is not what was decided")
        begun = time.thread_time()
        size = len(json.dumps(told_trace(actor, found, zone.slice_s)))
        text.append(1e3 * (time.thread_time() - begun))
        begun = time.thread_time()
        actor_probe(avatar, 1).ask(zone)
        channel.append(1e3 * (time.thread_time() - begun))
        population = world.population
        begun = time.thread_time()
        population.navigator.tracing.keep(population.table.agents, population.table.version)
        kept.append(1e3 * (time.thread_time() - begun))
    for name, times in (
        ("trace, actors' thread", traced),
        ("trace, text, port's thread", text),
        ("actor:ID, asking the zone", channel),
        ("keeping what a tick decides upon", kept),
    ):
        p50, p99 = np.percentile(times, [50, 99])
        print(f"{name}: p50 {p50:.3f}, p99 {p99:.3f} ms")
    print(f"a trace has {size / 1e3:.0f} kB")


def cycle_of(consoles: list[int]) -> list[int]:
    """Rounds with so many consoles each, and one without before and after each of them."""
    return [0, *(each for count in consoles for each in (count, 0))]


def print_round(world: "World", port: int, consoles: int, seconds: float) -> None:
    context = mp.get_context("spawn")
    here, there = context.Pipe()
    process = context.Process(target=look, args=(port, consoles, there), daemon=True)
    process.start()
    here.recv()
    asyncio.run(world.ticks(2.0))  # they are told who is there
    here.send("begin")
    processor_s, mine_s = time.process_time(), time.thread_time()
    own, ticks = asyncio.run(world.ticks(seconds))
    other_s = time.process_time() - processor_s - (time.thread_time() - mine_s)
    here.send("end")
    received = here.recv()
    process.join()
    each = f", {received / consoles / seconds / 1e3:6.1f} kB/s each" if consoles else ""
    p50, p99 = np.percentile(ticks, [50, 99])
    print(
        f"{consoles} consoles: own {np.mean(own):.3f} ms a tick (p99 {np.percentile(own, 99):.3f}),"
        f" other thread {1e3 * other_s / len(ticks):.3f};"
        f" tick p50 {p50:.2f}, p99 {p99:.2f} ms{each}",
        flush=True,
    )


class World:
    """A world with people who steer, and what operators see of it."""

    def __init__(self, people: int, actors: int) -> None:
        loaded = _field()
        scene, grid = loaded.scene, LayeredGrid.from_scene(loaded.scene)
        self.population, names = populate(grid, scene, actors, TICK_S, 0)
        self.zone = Zone(
            scene,
            grid,
            self.population,
            names,
            loaded.rules,
            tick_s=TICK_S,
            max_people=people,
            seed=0,
            clock=time.perf_counter,
        )
        self.population.warm_up()
        self.live = Live(self.zone, [0.0], Bulletin(), Traffic(), hide_names=False)
        frame = self.tick([Join(k, f"Person {k}", None) for k in range(people)])
        ids = [avatar_id for _, avatar_id in frame.joined]
        self._wishes = cycle([]) if not ids else _stages.steering(ids, TICK_S)

    def tick(self, inputs: Sequence[Input] = ()) -> Any:
        self.zone.begin(inputs)
        frame = self.zone.finish(self.zone.think())
        self.live.tap.take(frame, 0.01, 0)
        return frame

    async def ticks(self, seconds: float) -> tuple[list[float], list[float]]:
        """Tick in real time; milliseconds of each hand-over, and of each tick."""
        own, whole = [], []
        due = time.perf_counter()
        for _ in range(round(seconds / TICK_S)):
            inputs = list(next(self._wishes))
            begun = time.perf_counter()
            self.zone.begin(inputs)
            frame = self.zone.finish(self.zone.think())
            before = time.thread_time()
            self.live.tap.take(frame, 0.01, 0)
            own.append(1e3 * (time.thread_time() - before))
            whole.append(1e3 * (time.perf_counter() - begun))
            due += TICK_S
            await asyncio.sleep(max(0.0, due - time.perf_counter()))
        return own, whole

    def open_port(self) -> tuple[int, Any]:
        """Serve the live socket in a thread of its own; the port, and what ends it."""

        async def at_socket(_: Any) -> Any:
            async def renew() -> Any:
                return MACHINE

            return SimpleNamespace(identity=MACHINE, renew=renew)

        app = FastAPI()
        app.include_router(router)
        app.state.gate = SimpleNamespace(
            live=self.live, callers=SimpleNamespace(at_socket=at_socket)
        )
        opened: Future[tuple[int, Any]] = Future()

        async def serve() -> None:
            stopping = asyncio.Event()
            async with serving(app, "127.0.0.1", 0) as port:
                pulse = asyncio.create_task(beating(lambda: self.live))
                loop = asyncio.get_running_loop()
                opened.set_result((port, lambda: loop.call_soon_threadsafe(stopping.set)))
                await stopping.wait()
                pulse.cancel()

        threading.Thread(target=lambda: asyncio.run(serve()), name="private").start()
        return opened.result()


def _field() -> LoadedScene:
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "field.json")
        path.write_text(Scene.open_space((0.0, 0.0, SIDE_M, SIDE_M)).model_dump_json())
        return load_scene(ServerSettings(scene=path))


def look(port: int, consoles: int, parent: Connection) -> None:
    """Open some consoles, and tell how many bytes they were sent while it counted."""
    asyncio.run(_look(port, consoles, parent))


async def _look(port: int, consoles: int, parent: Connection) -> None:
    received = [0] * consoles

    async def one(number: int) -> None:
        address = f"ws://127.0.0.1:{port}/api/v1/live"
        async with connect(address, compression=None, max_size=None) as socket:
            for channel in ("map", "events", "series", "contacts"):
                await socket.send(f'{{"subscribe": "{channel}"}}')
            async for message in socket:
                received[number] += len(message)

    tasks = [asyncio.create_task(one(number)) for number in range(consoles)]
    parent.send("ready")
    loop = asyncio.get_running_loop()
    await loop.run_in_executor(None, parent.recv)
    before = sum(received)
    await loop.run_in_executor(None, parent.recv)
    parent.send(sum(received) - before)
    for task in tasks:
        task.cancel()
    await asyncio.gather(*tasks, return_exceptions=True)


if __name__ == "__main__":
    main()

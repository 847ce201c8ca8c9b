"""The cost of a tick of the server, by stage and by client.

    python -m benchmarks.server                      worlds of 100, 300 and 1000, then 200 sockets
    python -m benchmarks.server --clients 1000
    python -m benchmarks.server --people 4000 --viewers 1000 --actors 100 --clients 0

The first part runs a world without sockets, in which simulated people steer; 70 % of them walk.
There `write` is the time of cutting frames and handing them to transports that discard them. On a
busy machine `--processor-time` leaves out what others take; planning of actors has threads of its
own, which are then not counted. The second part runs a server with real sockets in a process of
its own, and then a bare server that only sends frames of the same size at the same times and
discards the same input. The ratio of the two is the cost of sessions, world and encoding on top of
the sockets.
"""

import argparse
import asyncio
import math
import multiprocessing as mp
import resource
import struct
import tempfile
import time
from collections.abc import Callable
from multiprocessing.connection import Connection
from pathlib import Path
from typing import cast

import numpy as np
import uvloop
from benchmarks._stages import STEER_EVERY_S, Crowd, print_stages

from esplanade.planning import Scene
from esplanade.protocol import VERSION, encode
from esplanade.protocol.messages import Hello, Move
from esplanade.server import logs
from esplanade.server.app import running
from esplanade.server.settings import ServerSettings

SIDE_M = 100.0
TICK_S = 0.05


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--people", type=int, nargs="+", default=[100, 300, 1000])
    parser.add_argument("--viewers", type=int, help="those who look [everyone]")
    parser.add_argument("--actors", type=int, default=0)
    parser.add_argument("--processor-time", action="store_true")
    parser.add_argument("--clients", type=int, default=200)
    parser.add_argument("--seconds", type=float, default=10.0)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder, "field.json")
        scene.write_text(Scene.open_space((0.0, 0.0, SIDE_M, SIDE_M)).model_dump_json())
        settings = ServerSettings(
            scene=scene, actors=0, host="127.0.0.1", port=0, private_port=0, log_level="error"
        )
        print(f"world without sockets, {SIDE_M:g} m square, milliseconds a tick, median")
        clock = time.thread_time if options.processor_time else time.perf_counter
        for people in options.people:
            crowd = Crowd(people, min(options.viewers or people, people), options.actors)
            print_stages(settings, crowd, clock)
        if not options.clients:
            return
        print(f"\n{options.clients} clients over sockets for {options.seconds:g} s, 20 ticks/s")
        print_sockets(settings, options.clients, options.seconds)


# --- with sockets -----------------------------------------------------------------------------


def print_sockets(settings: ServerSettings, clients: int, seconds: float) -> None:
    ours, size = measure(serve_world, settings, clients, seconds)
    print(f"  esplanade    {ours:6.1f} µs of processor a client-tick, {size:.0f} bytes each")
    bare, _ = measure(serve_bare, round(size), clients, seconds)
    print(f"  bare sockets {bare:6.1f} µs; ratio {ours / bare:.2f}")


def measure(
    server: Callable[[Connection, object], None], what: object, clients: int, seconds: float
) -> tuple[float, float]:
    """The processor microseconds and the bytes of a server for each client and tick.

    The server runs in a process of its own.
    """
    here, there = mp.get_context("spawn").Pipe()
    process = mp.get_context("spawn").Process(target=server, args=(there, what), daemon=True)
    process.start()
    received = uvloop.run(visit(here.recv(), clients, seconds, here))
    used_s, ticks = here.recv()
    process.join()
    return 1e6 * used_s / (clients * ticks), received / (clients * ticks)


async def visit(port: int, clients: int, seconds: float, server: Connection) -> int:
    """Join with raw sockets and steer now and then; returns the bytes that were received."""
    visitors = [Visitor(k) for k in range(clients)]
    loop = asyncio.get_running_loop()
    for visitor in visitors:
        await loop.create_connection(lambda v=visitor: v, "127.0.0.1", port)
        await asyncio.sleep(0.002)
    await asyncio.sleep(2.0)
    server.send("begin")
    before = sum(visitor.received for visitor in visitors)
    end = loop.time() + seconds
    while loop.time() < end:
        for visitor in visitors[:: int(STEER_EVERY_S / TICK_S)]:
            visitor.steer()
        visitors.append(visitors.pop(0))
        await asyncio.sleep(TICK_S)
    received = sum(visitor.received for visitor in visitors) - before
    server.send("end")
    return received


class Visitor(asyncio.Protocol):
    """A client that only counts the bytes that it receives."""

    def __init__(self, number: int) -> None:
        self._random = np.random.default_rng(number)
        self.received = 0
        self._seq = 0

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        self._transport = cast(asyncio.Transport, transport)
        self._transport.write(
            b"GET /ws HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\n"
            b"Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
            b"Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n"
        )
        x, y = self._random.uniform(1.0, SIDE_M - 1.0, 2).tolist()
        self._send(encode(Hello(name="p", version=VERSION, at=(x, y, 0))))
        self.steer()

    def data_received(self, data: bytes) -> None:
        self.received += len(data)

    def steer(self) -> None:
        self._seq += 1
        angle = float(self._random.uniform(0.0, 2.0 * math.pi))
        self._send(encode(Move(seq=self._seq, direction=angle, speed=1.3)))

    def _send(self, payload: bytes) -> None:
        self._transport.write(struct.pack(">BB", 0x82, 0x80 | len(payload)) + bytes(4) + payload)


def serve_world(parent: Connection, settings: object) -> None:
    """Run our server; sends back its processor time and ticks between `begin` and `end`."""
    assert isinstance(settings, ServerSettings)

    async def serve() -> None:
        async with running(settings) as server:
            parent.send(server.port)
            await asyncio.to_thread(parent.recv)
            used_s, tick = processor_s(), server.world.tick
            await asyncio.to_thread(parent.recv)
            parent.send((processor_s() - used_s, server.world.tick - tick))

    with logs.written(settings):
        uvloop.run(serve())


def serve_bare(parent: Connection, size: object) -> None:
    """Run a server that sends frames of one size to every connection 20 times a second."""
    transports: list[asyncio.Transport] = []

    class Bare(asyncio.Protocol):
        def connection_made(self, transport: asyncio.BaseTransport) -> None:
            transports.append(cast(asyncio.Transport, transport))

    async def serve() -> None:
        loop = asyncio.get_running_loop()
        listening = await loop.create_server(Bare, "127.0.0.1", 0)
        parent.send(listening.sockets[0].getsockname()[1])
        measured: list[tuple[float, int]] = []
        tick, next_tick = 0, loop.time()
        while True:
            tick += 1
            for transport in transports:
                transport.write(bytes(int(str(size))))
            next_tick += TICK_S
            await asyncio.sleep(next_tick - loop.time())
            if parent.poll():
                parent.recv()
                measured.append((processor_s(), tick))
                if len(measured) == 2:
                    (used_s, ticks), (used_end_s, ticks_end) = measured
                    parent.send((used_end_s - used_s, ticks_end - ticks))
                    return

    uvloop.run(serve())


def processor_s() -> float:
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


if __name__ == "__main__":
    main()

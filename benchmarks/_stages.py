"""The stages of a tick without sockets: people steer, and what is written is discarded."""

import gc
import math
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import count, islice
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
from websockets.asyncio.server import ServerConnection
from websockets.protocol import State

from esplanade.planning import LayeredGrid
from esplanade.server.loading import load_scene
from esplanade.server.metrics import Traffic
from esplanade.server.net.delivery import Delivery
from esplanade.server.net.outbox import Outbox, SlowPolicy
from esplanade.server.populating import populate
from esplanade.server.settings import ServerSettings
from esplanade.server.world.audience import Audience
from esplanade.server.world.inputs import Detach, Join, Steer
from esplanade.server.world.zone import Zone

WARM_UP_TICKS = 40
MEASURED_TICKS = 200
STEER_EVERY_S = 2.0
WALKING = 0.7
"""This part of the people walks at any time; the others stand."""
SPEED_MPS = 1.3


@dataclass(frozen=True)
class Crowd:
    """The numbers of people, of those of them that look, and of actors."""

    people: int
    viewers: int
    actors: int


class Sink:
    """A connection, its transport and its socket in one; all that is written is gone."""

    state = State.OPEN

    def __init__(self) -> None:
        self.transport = self

    def write(self, frame: bytes) -> None:
        pass

    def get_write_buffer_size(self) -> int:
        return 0

    def get_extra_info(self, _: str) -> "Sink":
        return self

    def setsockopt(self, *_: object) -> None:
        pass


def print_stages(
    settings: ServerSettings, crowd: Crowd, clock: Callable[[], float] = time.perf_counter
) -> None:
    """Print the median time of each stage, and that of all stages for each viewer."""
    scene = load_scene(settings)
    grid = LayeredGrid.from_scene(scene.scene)
    actors, names = populate(grid, scene.scene, crowd.actors, settings.tick_s, 0)
    zone = Zone(
        scene.scene,
        grid,
        actors,
        names,
        scene.rules,
        tick_s=settings.tick_s,
        max_people=crowd.people,
        seed=0,
        clock=clock,
    )
    actors.warm_up()
    audience = Audience(zone.rules, zone.origin_m, zone.times)
    zone.begin([Join(k, "p", None) for k in range(crowd.people)])
    frame = zone.finish(zone.think())
    audience.take(frame)
    ids = [avatar_id for _, avatar_id in frame.joined]
    traffic = Traffic()
    sessions = {one: _session(settings, traffic) for one in ids[: crowd.viewers]}
    delivery = Delivery(audience, cast(Any, sessions), settings.tick_rate, lambda _: None)
    zone.begin([Detach(one) for one in ids[crowd.viewers :]])
    audience.take(zone.finish(zone.think()))
    gc.collect()
    gc.freeze()  # the server does the same
    times: list[dict[str, float]] = []
    bytes_before = 0
    wishes = islice(steering(ids, settings.tick_s), WARM_UP_TICKS + MEASURED_TICKS)
    for tick, inputs in enumerate(wishes):
        zone.begin(inputs)
        news = audience.take(zone.finish(zone.think()))
        with zone.times.stage("write"):
            delivery.deliver(news, 0.0)
        if tick == WARM_UP_TICKS - 1:
            bytes_before = traffic.bytes_out
        elif tick >= WARM_UP_TICKS:
            times.append(dict(zone.times.seconds))
    gc.unfreeze()
    actors.close()
    _print(crowd, times, (traffic.bytes_out - bytes_before) / MEASURED_TICKS / crowd.viewers)


def steering(ids: list[int], tick_s: float) -> Iterator[list[Steer]]:
    """The wishes of each tick; at first everyone has one, later those who change their mind."""
    random = np.random.default_rng(1)
    for tick in count():
        turning = random.random(len(ids)) < (tick_s / STEER_EVERY_S if tick else 1.0)
        angles = random.uniform(0.0, 2.0 * math.pi, len(ids)).tolist()
        speeds = (SPEED_MPS * (random.random(len(ids)) < WALKING)).tolist()
        yield [Steer(ids[k], tick, angles[k], speeds[k]) for k in np.flatnonzero(turning).tolist()]


def _session(settings: ServerSettings, traffic: Traffic) -> SimpleNamespace:
    policy = SlowPolicy.of(settings)
    outbox = Outbox(cast(ServerConnection, Sink()), policy, traffic)
    return SimpleNamespace(outbox=outbox, watching=None)


def _print(crowd: Crowd, times: list[dict[str, float]], size: float) -> None:
    medians = {name: 1e3 * float(np.median([t[name] for t in times])) for name in times[0]}
    totals = 1e3 * np.array([sum(t.values()) for t in times])
    parts = "  ".join(f"{name} {ms:.2f}" for name, ms in medians.items())
    half, most = np.percentile(totals, (50, 99)).tolist()
    print(
        f"{crowd.people:5d} people, {crowd.viewers} viewers, {crowd.actors} actors:  {parts}"
        f"  all p50 {half:.1f} p99 {most:.1f}"
        f"  = {1e3 * half / crowd.viewers:.1f} µs a viewer ({size:.0f} bytes each)",
        flush=True,
    )

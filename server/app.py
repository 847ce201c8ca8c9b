"""Puts the server together and runs it: the one place that knows all of its parts."""

import asyncio
import time
from collections.abc import AsyncIterator, Hashable
from concurrent.futures import ThreadPoolExecutor
from contextlib import AsyncExitStack, asynccontextmanager
from dataclasses import dataclass

import structlog
from websockets.asyncio.server import Server

from actors import Cast
from planning import LayeredGrid
from planning.storey_heights import reached_from, storeys_of
from server.assets import Assets
from server.casting import assemble
from server.metrics import Metrics
from server.net.delivery import Delivery
from server.net.guidance import Guidance
from server.net.hub import Hub
from server.net.listener import Listener
from server.net.private import private_port
from server.net.schedule import Schedule
from server.net.ticker import Ticker
from server.settings import ServerSettings
from server.stage import Stage, StageError, set_stage
from server.world.troupe import Body
from server.world.world import World

log = structlog.get_logger(__name__)


@dataclass(frozen=True)
class Running:
    """A server that people can reach."""

    port: int
    private_port: int
    world: World
    metrics: Metrics
    ticking: "asyncio.Task[None]"
    """Runs as long as the world does; ends early only by a fault."""

    def summary(self) -> dict[str, int | float]:
        """The run in figures."""
        ticks = self.metrics.ticks
        return {
            "ticks": self.world.tick,
            "tick_p50_ms": round(1e3 * ticks.percentile(50), 2),
            "tick_p99_ms": round(1e3 * ticks.percentile(99), 2),
            "people_seen": self.world.people_seen,
            "trips_completed": self.world.trips,
            "contacts_actor_person": self.world.contacts.actor_person,
            "contacts_actor_actor": self.world.contacts.actor_actor,
        }


@asynccontextmanager
async def running(settings: ServerSettings, assets: Assets | None = None) -> AsyncIterator[Running]:
    """Run a server; on leaving, everyone is told goodbye. The assets are the built client's.

    Raises
    ------
    StageError
        The scene or crowd cannot be run.
    OSError
        A port cannot be had.
    """
    stage = set_stage(settings)
    assets, mesh = assets or Assets.load(), None
    if stage.triangles is not None:
        assets, mesh = assets.with_data("mesh", stage.triangles)
    metrics = Metrics()
    loop = asyncio.get_running_loop()
    ready = False
    async with AsyncExitStack() as stack:
        thread = stack.enter_context(ThreadPoolExecutor(1, thread_name_prefix="actors"))
        private = await stack.enter_async_context(private_port(settings, metrics, lambda: ready))
        # Whether the port can be had is found out now, not after a minute of compiling.
        bound = await loop.create_server(
            asyncio.Protocol, settings.host, settings.port, start_serving=False
        )
        bound.close()
        log.info("compiling; the first start on a machine takes a minute or two")
        cast, world, storeys = await loop.run_in_executor(thread, _build, stage, settings)
        stack.callback(cast.close)
        _watch(world, metrics)

        schedule = Schedule(world.tick_s, loop.time())
        ways = stack.enter_context(ThreadPoolExecutor(1, thread_name_prefix="ways"))
        guidance = Guidance(world, ways)
        metrics.gauge("ways_waiting", "People who wait for a way", lambda: guidance.waiting)
        hub = Hub(
            world,
            guidance,
            settings,
            metrics,
            lambda: schedule.world_time(world.tick, loop.time()),
            {"storeys": storeys} if mesh is None else {"storeys": storeys, "mesh": mesh},
        )
        delivery = Delivery(world, hub.sessions, settings.tick_rate)
        ticker = Ticker(world, hub, delivery, schedule, metrics, thread)
        listener = await stack.enter_async_context(
            Listener(hub, assets, settings, metrics).listening()
        )
        ticking = asyncio.create_task(ticker.run())
        guiding = asyncio.create_task(guidance.run(hub.way_found))
        ready = True
        try:
            yield Running(_port(listener), _port(private), world, metrics, ticking)
        finally:
            ready = False
            guiding.cancel()
            await _stop(ticker, ticking, hub)


def _build(stage: Stage, settings: ServerSettings) -> tuple[Cast, World, list[float]]:
    grid = LayeredGrid.from_scene(stage.scene)
    tick_s, seed = settings.tick_s, settings.seed
    bodies: dict[Hashable, Body]
    try:
        cast, bodies = assemble(grid, stage.scene, settings.actors, tick_s, seed)
        world = World(
            stage.scene,
            grid,
            cast,
            bodies,
            stage.rules,
            tick_s=tick_s,
            max_people=settings.max_clients,
            seed=seed,
            clock=time.perf_counter,
        )
    except ValueError as error:
        raise StageError(f"scene {stage.scene.name!r}: {error}") from error
    cast.warm_up()
    starts = [(*spawn.position, spawn.z_m) for spawn in stage.scene.spawns]
    storeys = storeys_of(grid, reached_from(grid, starts))
    return cast, world, [round(height, 2) for height in storeys]


async def _stop(ticker: Ticker, ticking: "asyncio.Task[None]", hub: Hub) -> None:
    ticker.stop()
    try:
        await ticking
    finally:
        await hub.close()


def _watch(world: World, metrics: Metrics) -> None:
    metrics.gauge("people", "People in the world", lambda: world.count()[0])
    metrics.gauge("actors", "Actors in the world", lambda: world.count()[1])
    metrics.total("people_seen", "People who came in", lambda: world.people_seen)
    metrics.total("actor_trips", "Trips that actors completed", lambda: world.trips)
    contacts = world.contacts
    metrics.total("contacts_actor_person", "Actor-person contacts", lambda: contacts.actor_person)
    metrics.total("contacts_actor_actor", "Actor-actor contacts", lambda: contacts.actor_actor)
    feet = world.feet
    metrics.total("steps", "Steps that began or were re-aimed", lambda: feet.begun)
    metrics.total("walkers_lost", "Walkers set back onto their feet", lambda: feet.lost)
    metrics.total("stepping_failures", "Ticks in which nobody could step", lambda: feet.failures)


def _port(server: Server) -> int:
    port: int = server.sockets[0].getsockname()[1]
    return port

"""Puts the server together and runs it: the one place that knows all of its parts."""

import asyncio
import socket
from collections.abc import AsyncIterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import AsyncExitStack, asynccontextmanager
from dataclasses import dataclass

from esplanade.actors import Outcome
from esplanade.actors.warming import tables_ahead
from esplanade.server.assets import Assets
from esplanade.server.building import build_world, with_roster
from esplanade.server.commanding import commanding, live_view, shipped_presets
from esplanade.server.console.console import Console
from esplanade.server.console.gate import Gate
from esplanade.server.crowding import warn_of_crowding
from esplanade.server.entrances import make_gate, people_url, private_certificate
from esplanade.server.keeping import keeping
from esplanade.server.kept import Kept
from esplanade.server.link.local import LocalLink
from esplanade.server.live.bulletin import Bulletin
from esplanade.server.live.live import Live
from esplanade.server.loading import LoadedScene, load_scene, tell_crowd
from esplanade.server.metrics import Metrics
from esplanade.server.net.delivery import Delivery
from esplanade.server.net.descriptors import places_for_people
from esplanade.server.net.entrance import Entrance
from esplanade.server.net.ground_work import GroundWork
from esplanade.server.net.hub import Hub
from esplanade.server.net.listener import Listener, connections_wanted
from esplanade.server.net.listening import bound_sockets
from esplanade.server.net.private import private_port
from esplanade.server.net.readiness import Readiness
from esplanade.server.net.route_requests import RouteRequests
from esplanade.server.net.schedule import Schedule
from esplanade.server.net.search_budget import SearchBudget
from esplanade.server.net.ticker import Ticker
from esplanade.server.net.tls import Tls, renewed
from esplanade.server.recovery import read_recovery
from esplanade.server.resuming import persistence_of, resume
from esplanade.server.settings import ServerSettings
from esplanade.server.trajectories.keeping import trajectories_kept
from esplanade.server.watching import watch_routes, watch_world
from esplanade.server.world.audience import Audience
from esplanade.server.world.zone import Zone


@dataclass(frozen=True)
class Running:
    """A server that people can reach."""

    port: int
    private_port: int
    world: Zone
    metrics: Metrics
    kept: Kept
    gate: Gate
    console: Console
    ticking: "asyncio.Task[None]"
    """Runs as long as the world does; ends early only by a fault."""

    @property
    def live(self) -> Live:
        """The world as operators see it, there for as long as it runs."""
        if self.gate.live is None:
            raise RuntimeError("the world has ended")
        return self.gate.live

    def summary(self) -> dict[str, int | float]:
        """The run in figures."""
        ticks = self.metrics.ticks
        return {
            "ticks": self.world.tick,
            "tick_p50_ms": round(1e3 * ticks.percentile(50), 2),
            "tick_p99_ms": round(1e3 * ticks.percentile(99), 2),
            "people_seen": self.world.people_seen,
            "trips_completed": self.world.trips,
            **{
                f"trips_{outcome.name.lower()}": count
                for outcome, count in self.world.ended.items()
                if outcome is not Outcome.ARRIVED
            },
            "contacts_actor_person": self.world.contacts.actor_person,
            "contacts_actor_actor": self.world.contacts.actor_actor,
        }


@asynccontextmanager
async def running(settings: ServerSettings, assets: Assets | None = None) -> AsyncIterator[Running]:
    """Run a server; on leaving, everyone is told goodbye. The assets are the built client's.

    Raises
    ------
    LoadingError
        The scene or crowd cannot be run.
    TlsError
        The certificate and its key cannot be used.
    StoreError
        What is to be kept cannot be.
    OSError
        A port cannot be had, or too few open files are allowed.
    """
    warn_of_crowding(settings)
    # A lack of the machine is told now, not after a minute of building the world.
    places = places_for_people(connections_wanted(settings))
    tls = _tls(settings)
    loaded, presets = _loaded(settings), shipped_presets(settings)
    assets, mesh = _with_mesh(assets or Assets.load(), loaded)
    metrics = Metrics()
    loop = asyncio.get_running_loop()
    readiness = Readiness(metrics)
    async with AsyncExitStack() as stack:
        thread = stack.enter_context(ThreadPoolExecutor(1, thread_name_prefix="actors"))
        kept = await stack.enter_async_context(keeping(settings, metrics))
        private_tls = private_certificate(settings, tls)
        stack.enter_context(renewed(tls, private_tls))
        gate = make_gate(settings, kept, loop, encrypted=private_tls is not None)
        private = await stack.enter_async_context(
            private_port(settings, metrics, readiness, gate, assets, private_tls)
        )
        # This finds out now, not after a minute of compiling, whether the port can be had.
        sockets = await bound_sockets(settings.host, settings.port)
        for each in sockets:
            stack.callback(each.close)
        gate.people_url = people_url(settings, sockets[0].getsockname()[1])
        recovery = await read_recovery(kept, settings, loaded)
        population, world, storeys = await loop.run_in_executor(
            thread, build_world, loaded, settings, recovery
        )
        stack.callback(population.close)
        watch_world(world, population, metrics)

        schedule = Schedule(world.tick_s, loop.time())
        searching = stack.enter_context(ThreadPoolExecutor(1, thread_name_prefix="routes"))
        route_requests = RouteRequests(world, searching, SearchBudget())
        watch_routes(route_requests, metrics)
        audience = Audience(world.rules, world.origin_m, world.times)
        persistence = persistence_of(world, recovery, kept, metrics)
        hub = Hub(
            world,
            audience,
            route_requests,
            settings,
            metrics,
            lambda: schedule.world_time(world.tick, loop.time()),
            {"storeys": storeys, **mesh},
            kept.moderation,
            Entrance(settings, kept, metrics),
            schedule.pace,
            persistence.seats,
        )
        delivery = Delivery(
            audience,
            hub.sessions,
            settings.tick_rate,
            hub.wishes.stop_watching,
            hub.moderation.lines,
        )
        link, bulletin = LocalLink(), Bulletin()
        console = await resume(
            await stack.enter_async_context(
                commanding(world, hub, kept, loaded, metrics, presets, schedule.pace, bulletin)
            ),
            recovery,
            kept,
            hub,
            persistence,
            thread,
        )
        deriving = stack.enter_context(ThreadPoolExecutor(1, thread_name_prefix="ground"))
        ground_work = GroundWork(world, deriving, tables_ahead(population.navigator))
        gate.console = console
        ticker = (
            Ticker(
                world,
                ground_work,
                audience,
                link,
                hub,
                delivery,
                schedule,
                metrics,
                thread,
                console,
            )
            .keeping(persistence)
            .planning(settings.planning_interval)
        )
        gate.live = live = live_view(world, storeys, console, hub, metrics, settings, bulletin)
        ticker.tap, ticker.trajectories = (
            live.tap,
            await stack.enter_async_context(
                trajectories_kept(settings, loaded, world, metrics, live.bulletin)
            ),
        )
        await stack.enter_async_context(
            Listener(hub, assets, settings, metrics, places).listening(sockets, tls)
        )
        ticking = asyncio.create_task(ticker.run())
        guiding = asyncio.create_task(route_requests.run(hub.wishes.route_found))
        readiness.open()
        try:
            yield Running(_port_of(sockets), private, world, metrics, kept, gate, console, ticking)
        finally:
            readiness.close()
            guiding.cancel()
            await _stop(ticker, ticking, hub, gate)


def _port_of(sockets: Sequence[socket.socket]) -> int:
    port: int = sockets[0].getsockname()[1]
    return port


async def _stop(ticker: Ticker, ticking: "asyncio.Task[None]", hub: Hub, gate: Gate) -> None:
    gate.console = gate.live = None
    ticker.stop()
    in_order = False
    try:
        await ticking
        in_order = True
    finally:
        await ticker.keep(in_order=in_order)
        await hub.close()


def _loaded(settings: ServerSettings) -> LoadedScene:
    """The scene of the settings, with actors; the log says how a recorded crowd was understood."""
    loaded = load_scene(settings)
    if settings.crowd is not None and loaded.crowd is not None:
        tell_crowd(settings.crowd, loaded.crowd)
    return with_roster(loaded, settings)


def _tls(settings: ServerSettings) -> Tls | None:
    """The certificate of people's port, if it has one."""
    if settings.tls_cert is None or settings.tls_key is None:
        return None
    return Tls(settings.tls_cert, settings.tls_key)


def _with_mesh(assets: Assets, loaded: LoadedScene) -> tuple[Assets, dict[str, str]]:
    """The assets with the triangles of a mesh, and what a welcome says of where they are."""
    if loaded.triangles is None:
        return assets, {}
    assets, mesh = assets.with_data("mesh", loaded.triangles)
    return assets, {"mesh": mesh}

"""Puts the server together and runs it: the one place that knows all of its parts."""

import asyncio
import time
from collections.abc import AsyncIterator, Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import AsyncExitStack, asynccontextmanager
from dataclasses import dataclass, replace

import structlog

from esplanade.actors import Population
from esplanade.planning import LayeredGrid
from esplanade.planning.routes.storey_heights import reached_from, storeys_of
from esplanade.server.accounts.kept import Kept
from esplanade.server.assets import Assets
from esplanade.server.console.console import Console
from esplanade.server.console.gate import Gate
from esplanade.server.crowding import warn_of_crowding
from esplanade.server.entrances import make_gate, people_url, private_certificate
from esplanade.server.keeping import keeping
from esplanade.server.link.local import LocalLink
from esplanade.server.live.live import Live
from esplanade.server.loading import LoadedScene, LoadingError, load_scene
from esplanade.server.metrics import Metrics
from esplanade.server.net.delivery import Delivery
from esplanade.server.net.descriptors import places_for_people
from esplanade.server.net.door_commands import DoorCommands
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
from esplanade.server.populating import default_roster, names_of, populate_from
from esplanade.server.rehearsal import rehearse, rehearse_walking
from esplanade.server.settings import ServerSettings
from esplanade.server.warming import kernels_compiled
from esplanade.server.world.audience import Audience
from esplanade.server.world.zone import Zone

log = structlog.get_logger(__name__)


@dataclass(frozen=True)
class Running:
    """A server that people can reach."""

    port: int
    private_port: int
    world: Zone
    metrics: Metrics
    kept: Kept
    gate: Gate
    ticking: "asyncio.Task[None]"
    """Runs as long as the world does; ends early only by a fault."""

    @property
    def live(self) -> Live:
        """What operators see of the world, which is there for as long as that runs."""
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
    # What the machine cannot give is said now, not after a minute of building the world.
    places = places_for_people(connections_wanted(settings))
    tls = _tls(settings)
    loaded = _with_roster(load_scene(settings), settings)
    assets, mesh = assets or Assets.load(), None
    if loaded.triangles is not None:
        assets, mesh = assets.with_data("mesh", loaded.triangles)
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
        population, world, storeys = await loop.run_in_executor(
            thread, build_world, loaded, settings
        )
        stack.callback(population.close)
        _watch(world, population, metrics)

        schedule = Schedule(world.tick_s, loop.time())
        searching = stack.enter_context(ThreadPoolExecutor(1, thread_name_prefix="routes"))
        route_requests = RouteRequests(world, searching, SearchBudget())
        _watch_routes(route_requests, metrics)
        audience = Audience(world.rules, world.origin_m, world.times)
        hub = Hub(
            world,
            audience,
            route_requests,
            settings,
            metrics,
            lambda: schedule.world_time(world.tick, loop.time()),
            {"storeys": storeys} if mesh is None else {"storeys": storeys, "mesh": mesh},
            Entrance(settings, kept, metrics),
        )
        delivery = Delivery(audience, hub.sessions, settings.tick_rate, hub.stop_watching)
        link = LocalLink()
        deriving = stack.enter_context(ThreadPoolExecutor(1, thread_name_prefix="ground"))
        ground_work = GroundWork(world, deriving)
        console = gate.console = _console(world, hub, kept, loaded, metrics)
        ticker = Ticker(
            world, ground_work, audience, link, hub, delivery, schedule, metrics, thread, console
        )
        gate.live = live = _live(world, storeys, console, metrics, settings)
        ticker.tap = live.tap
        await stack.enter_async_context(
            Listener(hub, assets, settings, metrics, places).listening(sockets, tls)
        )
        ticking = asyncio.create_task(ticker.run())
        guiding = asyncio.create_task(route_requests.run(hub.route_found))
        readiness.open()
        try:
            yield Running(sockets[0].getsockname()[1], private, world, metrics, kept, gate, ticking)
        finally:
            readiness.close()
            guiding.cancel()
            await _stop(ticker, ticking, hub, gate)


def build_world(
    loaded: LoadedScene, settings: ServerSettings
) -> tuple[Population, Zone, list[float]]:
    """The world of a loaded scene, ready to tick: its actors, itself, the heights of its storeys.

    It compiles what is not compiled yet, and takes a while.

    Raises
    ------
    LoadingError
        The scene has no room for the actors.
    """
    with kernels_compiled(lambda: rehearse_walking(loaded.rules, settings.tick_s)) as ready_to_plan:
        return _build_warm(loaded, settings, ready_to_plan)


def _build_warm(
    loaded: LoadedScene, settings: ServerSettings, ready_to_plan: Callable[[], None]
) -> tuple[Population, Zone, list[float]]:
    tick_s, seed = settings.tick_s, settings.seed
    try:
        grid = LayeredGrid.from_scene(loaded.scene)
        roster = loaded.roster or default_roster(loaded.scene, settings.actors, seed)
        population = populate_from(
            roster,
            grid,
            loaded.scene,
            tick_s,
            seed,
            person_radius_m=settings.person_radius_m,
        )
        world = Zone(
            loaded.scene,
            grid,
            population,
            names_of(roster),
            loaded.rules,
            tick_s=tick_s,
            max_people=settings.max_clients,
            seed=seed,
            clock=time.perf_counter,
            roster=roster.actors,
        )
    except ValueError as error:
        raise LoadingError(f"scene {loaded.scene.name!r}: {error}") from error
    population.warm_up(ready_to_plan)
    rehearse(loaded.rules, tick_s)
    starts = [(*spawn.position, spawn.z_m) for spawn in loaded.scene.spawns]
    storeys = storeys_of(grid, reached_from(grid, starts))
    return population, world, [round(height, 2) for height in storeys]


async def _stop(ticker: Ticker, ticking: "asyncio.Task[None]", hub: Hub, gate: Gate) -> None:
    gate.console = gate.live = None
    ticker.stop()
    try:
        await ticking
    finally:
        await hub.close()


def _watch(world: Zone, population: Population, metrics: Metrics) -> None:
    metrics.gauge("people", "People in the world", lambda: world.count()[0])
    metrics.gauge("actors", "Actors in the world", lambda: world.count()[1])
    metrics.total("people_seen", "People who came in", lambda: world.people_seen)
    metrics.total("actor_trips", "Trips that actors completed", lambda: world.trips)
    contacts = world.contacts
    metrics.total("contacts_actor_person", "Actor-person contacts", lambda: contacts.actor_person)
    metrics.total("contacts_actor_actor", "Actor-actor contacts", lambda: contacts.actor_actor)
    metrics.gauge(
        "doors_waiting", "Doors that are wanted open or closed, and are not", world.doors.waiting
    )
    feet = world.feet
    metrics.total("steps", "Steps that began or were re-aimed", lambda: feet.begun)
    metrics.total("walkers_lost", "Walkers set back onto their feet", lambda: feet.lost)
    metrics.total("stepping_failures", "Ticks in which nobody could step", lambda: feet.failures)
    metrics.gauge(
        "commands_waiting",
        "Commands on actors that wait for what is derived for them",
        lambda: world.commands_waiting,
    )
    metrics.total(
        "inputs_failed",
        "Inputs and movements of actors that failed by a fault of the server",
        lambda: world.failures,
    )
    metrics.gauge(
        "potentials_outdated",
        "Potentials of goals that wait to be derived anew since a door has moved",
        lambda: population.navigator.potentials.outdated_rows,
    )


def _tls(settings: ServerSettings) -> Tls | None:
    """The certificate of people's port, if it has one."""
    if settings.tls_cert is None or settings.tls_key is None:
        return None
    return Tls(settings.tls_cert, settings.tls_key)


def _with_roster(loaded: LoadedScene, settings: ServerSettings) -> LoadedScene:
    """A scene with the actors of its own roster, or with those that it usually has."""
    if loaded.roster is not None:
        return loaded
    roster = default_roster(loaded.scene, settings.actors, settings.seed)
    return replace(loaded, roster=roster)


def _console(world: Zone, hub: Hub, kept: Kept, loaded: LoadedScene, metrics: Metrics) -> Console:
    """Make the console, which all commands of operators go through."""
    overrides = None if loaded.roster is None else loaded.roster.overrides
    console = Console(world, hub.moderation, kept.store, kept.audit, overrides)
    hub.by_commands = doors = DoorCommands(console, kept.directory.again)
    metrics.gauge(
        "door_commands_waiting",
        "Doors that operators who walk about want moved, and that wait",
        lambda: doors.waiting,
    )
    metrics.gauge(
        "commands_in_turn",
        "Operators' lists of commands that are carried out or wait for their turn",
        lambda: console.waiting,
    )
    return console


def _live(
    world: Zone,
    storeys: list[float],
    console: Console,
    metrics: Metrics,
    settings: ServerSettings,
) -> Live:
    """Make what operators see of the world."""
    return Live(world, storeys, console.bulletin, metrics.traffic, hide_names=settings.hide_names)


def _watch_routes(route_requests: RouteRequests, metrics: Metrics) -> None:
    metrics.gauge("routes_waiting", "People who wait for a route", lambda: route_requests.waiting)
    metrics.total(
        "routes_refused",
        "Routes not sought because searches had cost too much",
        lambda: route_requests.refused,
    )
    metrics.total(
        "route_search_seconds",
        "Processor time of searches for routes",
        lambda: route_requests.search_s,
    )

"""Puts the server together and runs it: the one place that knows all of its parts."""

import asyncio
import socket
import time
from collections.abc import AsyncIterator, Callable, Sequence
from concurrent.futures import Executor, ThreadPoolExecutor
from contextlib import AsyncExitStack, asynccontextmanager
from dataclasses import dataclass, replace
from functools import partial

import structlog

from esplanade.actors import Population
from esplanade.planning import LayeredGrid
from esplanade.planning.routes.storey_heights import reached_from, storeys_of
from esplanade.protocol.preset_files import PresetFileError
from esplanade.server.assets import Assets
from esplanade.server.checkpoint.parts import with_faults_told
from esplanade.server.checkpoint.seat_keeper import SeatKeeper
from esplanade.server.checkpoint.writer import CheckpointWriter
from esplanade.server.console.console import Console
from esplanade.server.console.gate import Gate
from esplanade.server.console.preset_folder import read_presets
from esplanade.server.console.presets import Presets
from esplanade.server.console.redoing import redo, remember
from esplanade.server.crowding import warn_of_crowding
from esplanade.server.keeping import Kept, keeping
from esplanade.server.link.local import LocalLink
from esplanade.server.loading import LoadedScene, LoadingError, load_scene
from esplanade.server.metrics import Metrics
from esplanade.server.net.delivery import Delivery
from esplanade.server.net.descriptors import places_for_people
from esplanade.server.net.ground_work import GroundWork
from esplanade.server.net.hub import Hub
from esplanade.server.net.lasting import Lasting, watch
from esplanade.server.net.listener import Listener, connections_wanted
from esplanade.server.net.listening import bound_sockets
from esplanade.server.net.private import private_port
from esplanade.server.net.readiness import Readiness
from esplanade.server.net.route_requests import RouteRequests
from esplanade.server.net.schedule import Schedule
from esplanade.server.net.search_budget import SearchBudget
from esplanade.server.net.ticker import Ticker
from esplanade.server.net.tls import Tls
from esplanade.server.past import Past, read_past, tell_the_lost
from esplanade.server.populating import default_roster, names_of, populate_from
from esplanade.server.rehearsal import rehearse, rehearse_walking
from esplanade.server.roster import Roster
from esplanade.server.settings import ServerSettings
from esplanade.server.warming import kernels_compiled
from esplanade.server.world.audience import Audience
from esplanade.server.world.saved_zone import saved_specs, set_doors
from esplanade.server.world.zone import ROOM_FOR_ACTORS, Zone

log = structlog.get_logger(__name__)


@dataclass(frozen=True)
class Running:
    """A server that people can reach."""

    port: int
    private_port: int
    world: Zone
    metrics: Metrics
    kept: Kept
    console: Console
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
    tls = None
    if settings.tls_cert is not None and settings.tls_key is not None:
        tls = Tls(settings.tls_cert, settings.tls_key)
    loaded, presets = _with_roster(load_scene(settings), settings), _presets(settings)
    assets, mesh = _with_mesh(assets or Assets.load(), loaded)
    metrics = Metrics()
    loop = asyncio.get_running_loop()
    readiness = Readiness(metrics)
    async with AsyncExitStack() as stack:
        thread = stack.enter_context(ThreadPoolExecutor(1, thread_name_prefix="actors"))
        kept = await stack.enter_async_context(keeping(settings, metrics))
        gate = Gate(kept.tokens, kept.audit, loop)
        private = await stack.enter_async_context(private_port(settings, metrics, readiness, gate))
        # This finds out now, not after a minute of compiling, whether the port can be had.
        sockets = await bound_sockets(settings.host, settings.port)
        for each in sockets:
            stack.callback(each.close)
        past = await read_past(kept, settings, loaded)
        population, world, storeys = await loop.run_in_executor(
            thread, build_world, loaded, settings, past
        )
        stack.callback(population.close)
        _watch(world, population, metrics)

        schedule = Schedule(world.tick_s, loop.time())
        searching = stack.enter_context(ThreadPoolExecutor(1, thread_name_prefix="routes"))
        route_requests = RouteRequests(world, searching, SearchBudget())
        _watch_routes(route_requests, metrics)
        audience = Audience(world.rules, world.origin_m, world.times)
        lasting = _lasting(world, past, kept, metrics)
        hub = Hub(
            world,
            audience,
            route_requests,
            settings,
            metrics,
            lambda: schedule.world_time(world.tick, loop.time()),
            {"storeys": storeys, **mesh},
            lasting.seats,
        )
        delivery = Delivery(audience, hub.sessions, settings.tick_rate, hub.stop_watching)
        link = LocalLink()
        metrics.gauge(
            "doors_waiting",
            "Doors that are wanted open or closed, and are not",
            world.doors.waiting,
        )
        console = await _went_on(
            await stack.enter_async_context(_console(world, hub, kept, loaded, metrics, presets)),
            past,
            kept,
            hub,
            thread,
        )
        deriving = stack.enter_context(ThreadPoolExecutor(1, thread_name_prefix="ground"))
        ground_work = GroundWork(world, deriving)
        gate.console = console
        ticker = Ticker(
            world, ground_work, audience, link, hub, delivery, schedule, metrics, thread, console
        ).keeping(lasting)
        await stack.enter_async_context(
            Listener(hub, assets, settings, metrics, places).listening(sockets, tls)
        )
        ticking = asyncio.create_task(ticker.run())
        beside = [asyncio.create_task(route_requests.run(hub.route_found))]
        if tls is not None:
            beside.append(asyncio.create_task(tls.renew()))
        readiness.open()
        try:
            yield Running(_port_of(sockets), private, world, metrics, kept, console, ticking)
        finally:
            readiness.close()
            for task in beside:
                task.cancel()
            await _stop(ticker, ticking, hub, gate)


def _port_of(sockets: Sequence[socket.socket]) -> int:
    port: int = sockets[0].getsockname()[1]
    return port


def build_world(
    loaded: LoadedScene, settings: ServerSettings, past: Past | None = None
) -> tuple[Population, Zone, list[float]]:
    """The world of a loaded scene, ready to tick: its actors, itself, the heights of its storeys.

    It compiles what is not compiled yet, and takes a while.

    Raises
    ------
    LoadingError
        The scene has no room for the actors.
    """
    with kernels_compiled(lambda: rehearse_walking(loaded.rules, settings.tick_s)) as ready_to_plan:
        return _build_warm(loaded, settings, ready_to_plan, past)


def _build_warm(
    loaded: LoadedScene,
    settings: ServerSettings,
    ready_to_plan: Callable[[], None],
    past: Past | None,
) -> tuple[Population, Zone, list[float]]:
    tick_s, seed = settings.tick_s, settings.seed
    try:
        grid = LayeredGrid.from_scene(loaded.scene)
        roster = loaded.roster or default_roster(loaded.scene, settings.actors, seed)
        names = names_of(roster)
        saved = None if past is None else past.zone
        if saved is not None:
            with_faults_told("zone", partial(set_doors, grid), saved)
            if len(saved["specs"]) > len(names) + ROOM_FOR_ACTORS:
                names = {spec.id: spec.name for spec in saved_specs(saved)}
            roster = Roster()  # the saved actors come in when kernels are ready
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
            names,
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
    if past is not None:
        _bring_back(world, past)
    rehearse(loaded.rules, tick_s)
    starts = [(*spawn.position, spawn.z_m) for spawn in loaded.scene.spawns]
    storeys = storeys_of(grid, reached_from(grid, starts))
    return population, world, [round(height, 2) for height in storeys]


def _bring_back(world: Zone, past: Past) -> None:
    """Let a world without anybody go on from its past."""
    if past.ids is not None:
        world.state.begin_ids(*past.ids)
    if past.zone is not None:
        with_faults_told("zone", lambda saved: world.load(saved, past.people), past.zone)
    else:
        for person in past.people:
            world.put(person)
    world.skip_to(past.tick)


async def _stop(ticker: Ticker, ticking: "asyncio.Task[None]", hub: Hub, gate: Gate) -> None:
    gate.console = None
    ticker.stop()
    in_order = False
    try:
        await ticking
        in_order = True
    finally:
        await ticker.keep(in_order=in_order)
        await hub.close()


def _watch(world: Zone, population: Population, metrics: Metrics) -> None:
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


def _with_roster(loaded: LoadedScene, settings: ServerSettings) -> LoadedScene:
    """A scene with the actors of its own roster, or with those that it usually has."""
    if loaded.roster is not None:
        return loaded
    roster = default_roster(loaded.scene, settings.actors, settings.seed)
    return replace(loaded, roster=roster)


def _presets(settings: ServerSettings) -> Presets:
    """The presets that come along with the server."""
    try:
        return Presets(read_presets(settings.presets))
    except PresetFileError as error:
        raise LoadingError(str(error)) from None


@asynccontextmanager
async def _console(
    world: Zone, hub: Hub, kept: Kept, loaded: LoadedScene, metrics: Metrics, presets: Presets
) -> AsyncIterator[Console]:
    """Make the console, which all commands of operators go through."""
    overrides = None if loaded.roster is None else loaded.roster.overrides
    console = Console(world, hub.moderation, kept.store, kept.audit, overrides, presets)
    console.figures.add(
        "tick_p99_ms",
        "ms",
        "Percentile 99 of the last minute's ticks",
        lambda: 1e3 * metrics.ticks.percentile(99, round(60.0 / world.tick_s)),
    )
    metrics.gauge(
        "changes_lasting",
        "Changes of operators that go on: dragged values and ramps",
        lambda: console.lasting.under_way,
    )
    metrics.gauge(
        "schedules_due",
        "Schedules and guards that wait to be carried out",
        lambda: console.scheduler.waiting,
    )
    metrics.gauge(
        "commands_in_turn",
        "Operators' lists of commands that are carried out or wait for their turn",
        lambda: console.waiting,
    )
    await console.load_kept()
    try:
        yield console
    finally:
        await console.close()


def _with_mesh(assets: Assets, loaded: LoadedScene) -> tuple[Assets, dict[str, str]]:
    """The assets with the triangles of a mesh, and what a welcome says of where they are."""
    if loaded.triangles is None:
        return assets, {}
    assets, mesh = assets.with_data("mesh", loaded.triangles)
    return assets, {"mesh": mesh}


def _lasting(world: Zone, past: Past, kept: Kept, metrics: Metrics) -> Lasting:
    """Make what lets the world outlast its process, if the store does."""
    if kept.store.location.in_memory:
        return Lasting(world, kept.store)
    keeper = SeatKeeper(kept.store)
    writer = CheckpointWriter(past.parts, kept.store, past.scene)
    watch(keeper, writer, metrics)
    return Lasting(world, kept.store, keeper, writer)


async def _went_on(console: Console, past: Past, kept: Kept, hub: Hub, thread: Executor) -> Console:
    """The console, with everything where the audit says that it was when the server ended.

    Here all parts of checkpoints are registered.

    Raises
    ------
    StoreError
        A part cannot be read, or the store cannot be used.
    """
    parts = past.parts
    console.begun = kept.started
    hub.restore(past.left)
    parts.part("zone", console.zone.save)
    parts.part("seats", hub.save_seats)
    parts.part("mutes", hub.moderation.save, hub.moderation.load)
    parts.part("console", console.save, console.load)
    if parts.restored is not None:
        await asyncio.get_running_loop().run_in_executor(thread, redo, console, past.tail)
        remember(console, past.tail)
        await tell_the_lost(past, kept)
        log.info("goes on", tick=console.zone.tick, people=len(past.left.waiting))
    return console


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

"""A zone as it is served: what simulates it, who is in it, and what operators do with it."""

import asyncio
from collections.abc import AsyncIterator, Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import AsyncExitStack, asynccontextmanager
from dataclasses import dataclass, field, replace
from functools import partial

from esplanade.actors import Outcome
from esplanade.actors.warming import tables_ahead
from esplanade.server.building import build_world
from esplanade.server.commanding import commanding, live_view
from esplanade.server.console.console import Console
from esplanade.server.console.presets import Presets
from esplanade.server.driving.keeping import drivers_of
from esplanade.server.kept import Kept
from esplanade.server.link.local import LocalLink
from esplanade.server.live.bulletin import Bulletin
from esplanade.server.live.live import Live
from esplanade.server.metrics import Metrics
from esplanade.server.net.actor_planning import ActorPlanning
from esplanade.server.net.delivery import Delivery
from esplanade.server.net.entrance import Entrance
from esplanade.server.net.ground_work import GroundWork
from esplanade.server.net.hub import Hub
from esplanade.server.net.long_lived import LongLived
from esplanade.server.net.route_requests import RouteRequests
from esplanade.server.net.schedule import Schedule
from esplanade.server.net.search_budget import SearchBudget
from esplanade.server.net.surroundings import Surroundings
from esplanade.server.net.ticker import Ticker
from esplanade.server.recording.keeping import recorder_of
from esplanade.server.recovery import read_recovery
from esplanade.server.resuming import persistence_of, resume
from esplanade.server.trajectories.keeping import trajectories_kept
from esplanade.server.watching import watch_routes, watch_world
from esplanade.server.world.actor_travel import ActorTravel
from esplanade.server.world.audience import Audience
from esplanade.server.world.zone import Zone
from esplanade.server.zone_keeping import kept_of
from esplanade.server.zones import ZoneToServe, check_portals


@dataclass(frozen=True)
class Process:
    """The parts of a server that all of its zones share."""

    kept: Kept
    entrance: Entrance
    presets: Presets
    long_lived: LongLived = field(default_factory=LongLived)


class ServedZone:
    """One zone with its hub, its console and its ticker. It ticks from `open` to `close`."""

    def __init__(
        self,
        world: Zone,
        hub: Hub,
        console: Console,
        live: Live,
        metrics: Metrics,
        ticker: Ticker,
        route_requests: RouteRequests,
        travel: ActorTravel | None,
    ) -> None:
        self.world = world
        self.hub = hub
        self.console = console
        self.live = live
        self.metrics = metrics
        self.ticking: asyncio.Task[None] | None = None
        """Runs as long as the zone does; ends early only by a fault. None before it is open."""
        self._finding: asyncio.Task[None] | None = None
        self.travel = travel
        """The ways of actors to other zones, in a world that has any."""
        self._ticker = ticker
        self._route_requests = route_requests

    def open(self, ended: Callable[[], None]) -> None:
        """Begin to tick, and to find routes; `ended` is called when the ticks end."""
        self.ticking = asyncio.create_task(self._ticker.run())
        self._finding = asyncio.create_task(self._route_requests.run(self.hub.wishes.route_found))

        self.ticking.add_done_callback(lambda _: ended())

    def stop(self) -> None:
        """Let the tick that runs be the last."""
        if self._finding is not None:
            self._finding.cancel()
        self._ticker.stop()

    def close_exits(self) -> None:
        """Let nobody go to other zones any more by themselves."""
        self.hub.close_exits()
        if self.travel is not None:
            self.travel.open((), {})

    def keep_from_now(self) -> None:
        """Keep the zone, which has taken the place of one that has ended."""
        self._ticker.keep_from_now()

    async def close(self, *, replaced: bool = False) -> None:
        """Stop, keep what is to outlast the process, and say goodbye to everyone.

        Of one that was replaced the other one is kept. A fault that has ended the ticks is raised.
        """
        self.stop()
        in_order = False
        try:
            if self.ticking is not None:
                await self.ticking
            in_order = not replaced
        finally:
            await self._ticker.keep(in_order=in_order)
            await self.hub.close()

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
async def served_zone(
    zone: ZoneToServe,
    process: Process,
    metrics: Metrics,
    described: Mapping[str, object],
    surroundings: Surroundings | None = None,
    *,
    replaces: bool = False,
) -> AsyncIterator[ServedZone]:
    """Build a zone and all that it is served by; it does not tick yet.

    `described` holds what a welcome says of the scene beside what is in its file; without
    `surroundings` the zone is the whole world. If it `replaces` a zone that runs, it begins without
    what is kept, and is kept once it is told so.

    Raises
    ------
    LoadingError
        The scene has no room for its actors, or nobody gets to one of its portals.
    StoreError
        What is to be kept cannot be.
    """
    settings, loaded = zone.settings, zone.loaded
    loop = asyncio.get_running_loop()
    async with AsyncExitStack() as stack:
        kept = await stack.enter_async_context(kept_of(process.kept, zone.name))
        thread = stack.enter_context(ThreadPoolExecutor(1, thread_name_prefix="actors"))
        recovery = await read_recovery(kept, settings, loaded, goes_on=not replaces)
        if surroundings is not None and recovery.ids is None:
            recovery = replace(recovery, ids=surroundings.ids)
        population, world, storeys = await loop.run_in_executor(
            thread, build_world, loaded, settings, recovery
        )
        stack.callback(population.close)
        await loop.run_in_executor(thread, check_portals, zone, world.grid)
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
            {"storeys": storeys, **described},
            kept.moderation,
            process.entrance,
            schedule.pace,
            persistence.seats,
            surroundings,
        )
        delivery = Delivery(
            audience,
            hub.sessions,
            settings.tick_rate,
            hub.wishes.stop_watching,
            hub.moderation.lines,
        )
        bulletin = Bulletin()
        travel = None if surroundings is None else ActorTravel(world)
        commanded = await stack.enter_async_context(
            commanding(
                world,
                hub.moderation,
                kept,
                loaded,
                metrics,
                process.presets,
                schedule.pace,
                bulletin,
            )
        )
        hub.wishes.by_commands = commanded.doors
        console = await resume(
            commanded.console,
            recovery,
            kept,
            hub,
            persistence,
            thread,
            travel,
        )
        deriving = stack.enter_context(ThreadPoolExecutor(1, thread_name_prefix="ground"))
        ticker = (
            Ticker(
                world,
                GroundWork(world, deriving, tables_ahead(population.navigator)),
                audience,
                LocalLink(),
                hub,
                delivery,
                schedule,
                metrics,
                console,
                ActorPlanning(world, thread, metrics, settings.planning_interval),
            )
            .keeping(persistence)
            .sparing(process.long_lived)
        )
        if travel is not None:
            ticker.with_travel(travel)
            metrics.total("actors_came", "Actors who came from other zones", partial(_came, travel))
        live = live_view(world, storeys, console, hub.moderation, metrics, settings, bulletin)
        ticker.tap = live.tap
        ticker.trajectories = await stack.enter_async_context(
            trajectories_kept(settings, loaded, world, metrics, live.bulletin)
        )
        ticker.drivers = await stack.enter_async_context(drivers_of(settings, world, metrics))
        ticker.recorder = console.state.recorder = await stack.enter_async_context(
            recorder_of(settings, world, zone.name, metrics, live.bulletin)
        )
        yield ServedZone(world, hub, console, live, metrics, ticker, route_requests, travel)


def _came(travel: ActorTravel) -> int:
    return travel.came

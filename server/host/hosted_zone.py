"""One zone as its host runs it, from the claim to the day when it is another host's."""

import asyncio
from collections.abc import AsyncIterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import AsyncExitStack, asynccontextmanager
from dataclasses import dataclass
from functools import partial
from typing import Any

import msgpack
import structlog
from nats.aio.client import Client
from nats.aio.msg import Msg

from esplanade.actors.warming import tables_ahead
from esplanade.server.assets import mesh_address
from esplanade.server.checkpoint.parts import Parts
from esplanade.server.cluster.ownership import NotOwnerError
from esplanade.server.cluster.tenure import Tenure
from esplanade.server.cluster.zone_rows import keep_description
from esplanade.server.commanding import commanding, live_view
from esplanade.server.console.gate import Operated
from esplanade.server.console.presets import Presets
from esplanade.server.host.actor_portals import ActorPortals
from esplanade.server.host.answering import Answering
from esplanade.server.host.checkpointing import Checkpointing
from esplanade.server.host.gateway_batches import GatewayBatches
from esplanade.server.host.guests import HostedGuest, SeatsOfZone
from esplanade.server.host.host_moderation import HostModeration
from esplanade.server.host.hosted_people import HostedPeople
from esplanade.server.host.operated import CONSOLE, recovered, send_out_the_kicked
from esplanade.server.host.owned_store import kept_by_owner
from esplanade.server.host.portals import Portals
from esplanade.server.host.renewal import Renewal
from esplanade.server.host.seat_desk import SeatDesk
from esplanade.server.host.ticking import HostTicker
from esplanade.server.host.zone_recovery import Found, build, digest_of, found_in
from esplanade.server.kept import Kept
from esplanade.server.link.frames_over_nats import FrameSender
from esplanade.server.link.subjects import Subjects
from esplanade.server.link.zone_description import ZoneDescription, encode_description, rules_told
from esplanade.server.live.bulletin import Bulletin
from esplanade.server.metrics import Metrics
from esplanade.server.net.actor_planning import ActorPlanning
from esplanade.server.net.chat_gate import ChatGate
from esplanade.server.net.ground_work import GroundWork
from esplanade.server.net.pace_notices import PaceNotices
from esplanade.server.net.pending_inputs import PendingInputs
from esplanade.server.net.reporting import Reporting
from esplanade.server.net.route_requests import RouteRequests
from esplanade.server.net.schedule import Schedule
from esplanade.server.net.search_budget import SearchBudget
from esplanade.server.net.waiting_lines import WaitingLines
from esplanade.server.net.walk_outs import WalkOuts
from esplanade.server.recording.keeping import recorder_of
from esplanade.server.store.store import Store, StoreError
from esplanade.server.watching import watch_routes, watch_world
from esplanade.server.world.pace import PaceState
from esplanade.server.world.zone import Zone
from esplanade.server.zones import ZoneToServe, check_portals, described_portals

log = structlog.get_logger(__name__)


@dataclass(eq=False)
class HostedZone:
    """A zone that this process owns: `run` goes on until it is told to stop or owns it no more."""

    world: Zone
    tenure: Tenure
    people: HostedPeople
    batches: GatewayBatches
    ticker: HostTicker
    sender: FrameSender
    desk: SeatDesk
    portals: Portals
    checkpoints: Checkpointing
    routes: RouteRequests
    operated: Operated
    """The console and the live views, for operators."""
    broker: Client
    subjects: Subjects

    async def run(self) -> None:
        """Simulate the zone; when it ends in order, what is to be kept of it is in the database.

        Raises
        ------
        Exception
            A fault of ours, with which the zone is given up.
        """
        loop = asyncio.get_running_loop()
        zone = self.tenure.claim.zone

        async def take(message: Msg) -> None:
            self.batches.take_message(message, loop.time())

        inputs = await self.broker.subscribe(self.subjects.inputs(zone), cb=take)
        questions = await self.broker.subscribe(
            self.subjects.questions(zone), cb=self.portals.answer
        )
        work = [
            self.desk.run(lambda found: self.people.take_seats(found, loop.time())),
            self.checkpoints.run(),
            self.routes.run(self.people.route_found),
        ]
        if (actors := self.ticker.actor_portals) is not None:
            of_actors = await self.broker.subscribe(self.subjects.questions(zone), cb=actors.answer)
            work.append(actors.run())
        beside = [asyncio.create_task(each) for each in work]
        ticking = asyncio.create_task(self.ticker.run(self.sender))
        for task in beside:
            task.add_done_callback(self._beside_ended)
        try:
            await ticking
        finally:
            ticking.cancel()
            for task in beside:
                task.cancel()
            await asyncio.gather(ticking, *beside, return_exceptions=True)
            await self.portals.close()
            if actors is not None:
                await actors.close()
            await self.sender.stop()
            if not self.broker.is_closed:
                await inputs.unsubscribe()
                await questions.unsubscribe()
                if actors is not None:
                    await of_actors.unsubscribe()
        if self.tenure.holds:
            try:
                await self.desk.flush()
                await self.checkpoints.write()
            except StoreError as error:
                log.warning("the last checkpoint is not written", zone=zone, why=str(error))

    def _beside_ended(self, task: "asyncio.Task[None]") -> None:
        """Give the zone up where what goes on beside its ticks has ended by itself."""
        if task.cancelled():
            return
        error = task.exception()
        if isinstance(error, NotOwnerError):
            log.warning("the zone is another host's", zone=self.tenure.claim.zone)
            self.tenure.renewed(False)
        elif error is not None:
            log.error("a part of the host has failed", exc_info=error)
            self.ticker.stop()


@dataclass(frozen=True)
class HostProcess:
    """The parts of a host that its zones have, one after the other."""

    store: Store
    """The database, as this process alone has it."""
    kept: Kept
    """Accounts, the audit and all else that the processes of a cluster share."""
    presets: Presets
    broker: Client
    subjects: Subjects


@asynccontextmanager
async def hosted_zone(
    zone: ZoneToServe,
    place: int,
    zones: Sequence[ZoneToServe],
    tenure: Tenure,
    renewal: Renewal,
    process: HostProcess,
    metrics: Metrics,
) -> AsyncIterator[HostedZone]:
    """Build a zone that was claimed, with all that runs it; it does not tick yet.

    `place` is that of the zone among all `zones`.

    Raises
    ------
    LoadingError
        The scene has no room for its actors, or nobody gets to one of its portals.
    StoreError
        The database does not answer, or the zone is another host's already.
    """
    loop, settings = asyncio.get_running_loop(), zone.settings
    claim, store, kept = tenure.claim, process.store, process.kept
    broker, subjects = process.broker, process.subjects
    found = await found_in(store, zone.name, zone.loaded, settings.tick_s)
    async with AsyncExitStack() as stack:
        thread = stack.enter_context(ThreadPoolExecutor(1, thread_name_prefix="actors"))
        population, world, storeys = await loop.run_in_executor(thread, build, zone, place, found)
        stack.callback(population.close)
        await loop.run_in_executor(thread, check_portals, zone, world.grid)
        watch_world(world, population, metrics)
        description = _description(zone, zones, world, storeys)
        await store.write(partial(_keep_description, tenure, encode_description(description)))
        searching = stack.enter_context(ThreadPoolExecutor(1, thread_name_prefix="routes"))
        routes = RouteRequests(world, searching, SearchBudget())
        watch_routes(routes, metrics)
        packing = stack.enter_context(ThreadPoolExecutor(1, thread_name_prefix="checkpoints"))
        owned = await stack.enter_async_context(kept_by_owner(kept, claim))
        answering = Answering(broker, subjects, zone.name)
        desk = SeatDesk(store, claim, round(settings.resume_seconds * 1e6))
        pending, moderated = PendingInputs(metrics), kept.moderation
        people = HostedPeople(world, routes, pending, desk, answering)
        moderated.number_apart(place, len(zones))
        moderation = HostModeration(
            moderated,
            world,
            storeys,
            people.guests,
            SeatsOfZone(people.seat_of),
            people.expel,
            loop.time,
            place,
        )
        stack.callback(moderation.close)
        people.moderation = moderation
        moderation.walk_outs = WalkOuts(
            world, people.guests, routes, pending.move, moderation.has_walked_out
        )
        schedule = Schedule(world.tick_s, loop.time())
        _tell_of_pace(schedule, world, people, desk)
        bulletin = Bulletin()
        console, doors = await stack.enter_async_context(
            commanding(
                world,
                moderation,
                owned,
                zone.loaded,
                metrics,
                process.presets,
                schedule.pace,
                bulletin,
            )
        )
        parts, tail = await recovered(console, moderation.mutes, found, owned, thread)
        lines = WaitingLines[HostedGuest](
            moderation, ChatGate(moderated, storeys), lambda _: False, metrics
        )
        batches = GatewayBatches(
            world,
            people,
            routes,
            pending,
            answering,
            claim.epoch,
            lines,
            doors,
            Reporting(moderated, moderation),
        )
        people.take_seats(found.seats, loop.time())
        send_out_the_kicked(people, tail)
        portals = Portals(
            world,
            people,
            zone.exits,
            {each.name: each.copies for each in zones if each.copies is not None},
            broker,
            subjects,
            store,
            tenure,
            metrics,
            settings.max_clients,
        )
        live = live_view(world, storeys, console, moderation, metrics, settings, bulletin)
        actor_portals = _actor_portals(zone, zones, world, process, tenure, metrics, parts, found)
        # All that is redone before the first tick is derived at once, and from here on outside it.
        deriving = stack.enter_context(ThreadPoolExecutor(1, thread_name_prefix="ground"))
        ticker = HostTicker(
            world,
            GroundWork(world, deriving, tables_ahead(population.navigator)),
            batches,
            people,
            portals,
            answering,
            schedule,
            renewal,
            metrics,
            ActorPlanning(world, thread, metrics, settings.planning_interval),
            console,
            moderation,
            live.tap,
            actor_portals,
        )
        ticker.recorder = console.state.recorder = await stack.enter_async_context(
            recorder_of(settings, world, zone.name, metrics, bulletin)
        )
        sender = FrameSender(broker, subjects, zone.name, ticker.whole)
        digest = digest_of(zone.loaded)
        checkpoints = Checkpointing(world, parts, store, claim, digest, packing, actor_portals)
        if CONSOLE not in found.parts:
            # Recovery finds the commands after a checkpoint by the place that it has in the audit.
            await checkpoints.write()
        _watch(metrics, renewal, batches, sender=sender, desk=desk, checkpoints=checkpoints)
        yield HostedZone(
            world=world,
            tenure=tenure,
            people=people,
            batches=batches,
            ticker=ticker,
            sender=sender,
            desk=desk,
            portals=portals,
            checkpoints=checkpoints,
            routes=routes,
            operated=Operated(console, live),
            broker=broker,
            subjects=subjects,
        )


def _actor_portals(
    zone: ZoneToServe,
    zones: Sequence[ZoneToServe],
    world: Zone,
    process: HostProcess,
    tenure: Tenure,
    metrics: Metrics,
    parts: Parts,
    found: Found,
) -> ActorPortals | None:
    """The portals by which actors go, as the owner before has left them; None where they go from no
    zone to another."""
    if not any(each.actor_exits for each in zones):
        return None
    exits = {name: to for name, to in zone.exits.items() if name in zone.actor_exits}
    made = ActorPortals(world, exits, process.broker, process.subjects, process.store, tenure)
    metrics.total("actors_came", "Actors who came from other zones", lambda: made.travel.came)
    made.restore(parts, found.travellers)
    return made


def _tell_of_pace(schedule: Schedule, world: Zone, people: HostedPeople, desk: SeatDesk) -> None:
    """Tell people of another pace, those too who come; in a pause nobody's seat lapses."""
    loop, pace = asyncio.get_running_loop(), schedule.pace
    notices = PaceNotices(people.guests, lambda: schedule.world_time(world.tick, loop.time()))

    def changed(state: PaceState, now_s: float) -> None:
        desk.keeps_all = state.paused
        notices.tell_all(state, now_s)

    def welcomed(guest: HostedGuest) -> None:
        notices.tell_newcomer(guest, pace.state)
        if people.moderation is not None:
            people.moderation.greet(guest)

    pace.changed.append(changed)
    people.welcomed.append(welcomed)


def _watch(
    metrics: Metrics,
    renewal: Renewal,
    batches: GatewayBatches,
    *,
    sender: FrameSender,
    desk: SeatDesk,
    checkpoints: Checkpointing,
) -> None:
    """Tell in the metrics how a host and the others understand each other."""
    metrics.total("renewals_failed", "Renewals without an answer", lambda: renewal.failures)
    refused = batches.refused
    metrics.total(
        "inputs_refused",
        "Batches and inputs that were stale, doubled or damaged",
        lambda: sum(refused.values()),
    )
    metrics.total(
        "frames_left_out",
        "Frames that did not go out, since the broker was away",
        lambda: sender.left_out,
    )
    metrics.gauge("seats_waiting", "Changes of seats that wait", lambda: desk.waiting)
    metrics.total(
        "checkpoints_failed", "Checkpoints that were not written", lambda: checkpoints.failures
    )


def _keep_description(tenure: Tenure, described: bytes, connection: Any) -> None:
    keep_description(connection, tenure.claim, described)


def _description(
    zone: ZoneToServe, zones: Sequence[ZoneToServe], world: Zone, storeys: Sequence[float]
) -> ZoneDescription:
    scenes = {each.name: each.loaded.scene for each in zones}
    triangles = zone.loaded.triangles
    mesh = None if triangles is None else mesh_address(triangles)
    described = {"storeys": storeys, **described_portals(zone, scenes)}
    if mesh is not None:
        described["mesh"] = mesh
    scene = world.scene.model_dump(mode="json", exclude={"mesh", "portals"})
    return ZoneDescription(
        scene=msgpack.packb({**scene, **described}),
        title=world.scene.name,
        rules=rules_told(world.rules),
        origin_m=world.origin_m,
        resume_seconds=zone.settings.resume_seconds,
        people=zone.settings.max_clients,
        mesh=mesh,
    )

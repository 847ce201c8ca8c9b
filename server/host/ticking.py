"""The ticks of a hosted zone at their times: inputs of gateways in, frames out."""

import asyncio
from time import perf_counter

import structlog

from esplanade.server.host.answering import Answering
from esplanade.server.host.gateway_batches import GatewayBatches
from esplanade.server.host.hosted_people import HostedPeople
from esplanade.server.host.portals import Portals
from esplanade.server.host.renewal import Renewal
from esplanade.server.link.frame_format import encode_frame
from esplanade.server.link.frame_parts import FrameError, FrameKey
from esplanade.server.link.frames_over_nats import Body, FrameSender
from esplanade.server.link.whole_state import WholeState
from esplanade.server.metrics import Metrics
from esplanade.server.net.actor_planning import ActorPlanning
from esplanade.server.net.ground_work import GroundWork
from esplanade.server.net.schedule import Schedule
from esplanade.server.world.zone import Zone

log = structlog.get_logger(__name__)


class HostTicker:
    """Runs the ticks of a zone until told to stop, or until the zone is another host's."""

    def __init__(
        self,
        world: Zone,
        ground_work: GroundWork,
        batches: GatewayBatches,
        people: HostedPeople,
        portals: Portals,
        answering: Answering,
        schedule: Schedule,
        renewal: Renewal,
        metrics: Metrics,
        planning: ActorPlanning,
    ) -> None:
        self._world = world
        self._ground_work = ground_work
        self._batches = batches
        self._people = people
        self._portals = portals
        self._answering = answering
        self._schedule = schedule
        self._renewal = renewal
        self._metrics = metrics
        self._planning = planning
        self._known = WholeState()
        self._known.begin_with_doors(world.doors.states())
        self._told = world.tick
        self._stopping = asyncio.Event()
        metrics.total("ticks", "Ticks of the world", lambda: world.tick)
        metrics.total("ticks_late", "Ticks that began late", lambda: schedule.late_ticks)

    def whole(self) -> tuple[FrameKey, Body]:
        """The whole state of the zone after the newest frame."""
        key = FrameKey(self._renewal.tenure.claim.epoch, self._told, is_whole=True)
        return key, encode_frame(self._known.whole())

    def stop(self) -> None:
        """Let the tick that runs be the last."""
        self._stopping.set()

    async def run(self, sender: FrameSender) -> None:
        """Tick, and send the frame of each tick; whole states are to be had after the first."""
        loop = asyncio.get_running_loop()
        await self._tick(sender)
        await sender.start()
        while not self._stopping.is_set() and self._renewal.tenure.holds:
            due = self._schedule.next_deadline
            if due > loop.time():
                try:
                    async with asyncio.timeout_at(due):
                        await self._stopping.wait()
                except TimeoutError:
                    pass
                continue
            await self._renewal.certain()
            if self._renewal.tenure.holds:
                await self._tick(sender)

    async def _tick(self, sender: FrameSender) -> None:
        loop, start = asyncio.get_running_loop(), perf_counter()
        self._schedule.begin(loop.time())
        self._portals.check(loop.time())
        wanted = self._people.drain(self._batches.lines(), loop.time())
        self._world.begin([*self._planning.inputs(), *wanted, *self._ground_work.drain()])
        frame = self._world.finish(await self._planning.think())
        self._known.take(frame)
        self._told = frame.tick
        self._people.told(frame)
        key = FrameKey(self._renewal.tenure.claim.epoch, frame.tick)
        try:
            await sender.publish(key, encode_frame(frame))
        except FrameError:
            log.exception("a frame cannot be sent", tick=frame.tick)
        await self._answering.send()
        self._metrics.tick_took(perf_counter() - start, self._world.times.seconds)
        self._planning.ticked(self._schedule, loop.time())

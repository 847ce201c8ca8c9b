"""The ticks of a hosted zone at their times: inputs of gateways and operators in, frames out."""

import asyncio
from collections.abc import Sequence
from dataclasses import replace
from time import perf_counter
from typing import TYPE_CHECKING, Final

import structlog

from esplanade.server.console.console import Console
from esplanade.server.host.actor_portals import ActorPortals
from esplanade.server.host.answering import Answering
from esplanade.server.host.gateway_batches import GatewayBatches
from esplanade.server.host.host_moderation import HostModeration
from esplanade.server.host.hosted_people import HostedPeople
from esplanade.server.host.portals import Portals
from esplanade.server.host.renewal import Renewal
from esplanade.server.link.frame_format import encode_frame
from esplanade.server.link.frame_parts import FrameError, FrameKey
from esplanade.server.link.frames_over_nats import Body, FrameSender
from esplanade.server.link.whole_state import WholeState
from esplanade.server.live.tap import Tap
from esplanade.server.metrics import Metrics
from esplanade.server.net.actor_planning import ActorPlanning
from esplanade.server.net.ground_work import GroundWork
from esplanade.server.net.schedule import Schedule, came_by
from esplanade.server.world.frame import Frame
from esplanade.server.world.inputs import Input, Still
from esplanade.server.world.zone import Zone

ALIVE_S: Final = 0.4
"""A world that stands is told of so often, so that gateways know that its host is there."""

if TYPE_CHECKING:
    from esplanade.server.recording.keeping import ZoneRecorder

log = structlog.get_logger(__name__)


class HostTicker:
    """Runs the ticks of a zone until told to stop, or until the zone is another host's."""

    def __init__(  # noqa: PLR0913, PLR0917 (every part of a host meets here)
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
        console: Console,
        moderation: HostModeration,
        tap: Tap,
        actor_portals: ActorPortals | None,
    ) -> None:
        """`actor_portals` is None where actors go from no zone of the world to another."""
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
        self._console = console
        self._moderation = moderation
        self._tap = tap
        self.actor_portals = actor_portals
        self.recorder: ZoneRecorder | None = None
        """Where the ticks go from which a replay runs them again."""
        self._known = WholeState()
        self._known.begin_with_doors(world.doors.states())
        self._told = world.tick
        self._told_s = 0.0
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
        loop, tick_s, pace = asyncio.get_running_loop(), self._world.tick_s, self._schedule.pace
        await self._tick(sender)
        await sender.start()
        while not self._stopping.is_set() and self._renewal.tenure.holds:
            now, due = loop.time(), self._schedule.next_deadline
            if not pace.stands and due > now:
                # A slow world is asked no less often, and another pace holds at once.
                await came_by(self._stopping, min(due, now + tick_s))
                self._console.answer()
                continue
            if pace.stands and await came_by(self._stopping, now + tick_s):
                break
            await self._renewal.certain()
            if not self._renewal.tenure.holds:
                break
            if pace.stands:
                await self._attend(sender)
            else:
                await self._tick(sender)

    async def _attend(self, sender: FrameSender) -> None:
        """Take in what came to a world that stands, in a tick in which nobody moves, if need be."""
        loop = asyncio.get_running_loop()
        given, derived = self._given(still=True), self._ground_work.drain()
        is_due = loop.time() - self._told_s > ALIVE_S
        if given or derived or self._console.waits_for_tick or is_due:
            await self._run(sender, [Still(), *given, *derived])
        else:
            self._metrics.stood()
            self._tap.stand()
            await self._answering.send()
        if self._tap.traces.stood():
            await self._planning.run(self._tap.traces.make_one)

    async def _tick(self, sender: FrameSender) -> None:
        loop = asyncio.get_running_loop()
        self._schedule.begin(loop.time())
        given = [*self._planning.inputs(), *self._given(still=False)]
        await self._run(sender, [*given, *self._ground_work.drain()])
        self._schedule.pace.ticked(loop.time(), self._world.tick, self._world.tick_s)
        room_s = self._planning.ticked(self._schedule, loop.time())
        if self._tap.traces.ticked(room_s):
            # No tick begins meanwhile.
            await self._planning.run(self._tap.traces.make_one)

    def _given(self, *, still: bool) -> list[Input]:
        """Inputs of people and operators for the tick that is about to begin."""
        now_s = asyncio.get_running_loop().time()
        self._portals.check(now_s)
        wanted = self._people.drain(self._batches.lines(), now_s, still=still)
        travellers = () if self.actor_portals is None else self.actor_portals.drain()
        return [*wanted, *self._console.drain(), *travellers]

    async def _run(self, sender: FrameSender, inputs: Sequence[Input]) -> None:
        loop, start = asyncio.get_running_loop(), perf_counter()
        self._world.begin(inputs)
        moved = await self._planning.think()
        frame = self._moderation.numbered(self._world.finish(moved))
        self._console.take(frame)
        if self.actor_portals is not None:
            self.actor_portals.travel.take(frame)
        told = replace(frame, outcomes=[], rate=self._rate())
        self._known.take(told)
        self._told, self._told_s = frame.tick, loop.time()
        self._people.told(frame)
        await self._send(sender, told)
        seconds = perf_counter() - start
        self._metrics.tick_took(seconds, self._world.times.seconds)
        self._tap.take(frame, seconds, self._schedule.late_ticks)
        if self.recorder is not None:
            self.recorder.take(frame, inputs)

    async def _send(self, sender: FrameSender, frame: Frame) -> None:
        key = FrameKey(self._renewal.tenure.claim.epoch, frame.tick)
        try:
            await sender.publish(key, encode_frame(frame))
        except FrameError:
            log.exception("a frame cannot be sent", tick=frame.tick)
        await self._answering.send()

    def _rate(self) -> float:
        """The rate by which gateways let clocks run: a usual one that is not reached is as usual,
        since nobody has chosen it."""
        state = self._schedule.pace.state
        usual = state.factor == 1.0 and not state.paused
        return 1.0 if usual else state.rate

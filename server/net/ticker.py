"""The ticker runs the zone's ticks at their times, and the actors' planning in its own thread."""

import asyncio
from collections.abc import Sequence
from time import perf_counter
from typing import TYPE_CHECKING, Self

import structlog

from esplanade.server.console.console import Console
from esplanade.server.link.local import LocalLink
from esplanade.server.live.tap import Tap
from esplanade.server.metrics import Metrics
from esplanade.server.net.actor_planning import ActorPlanning
from esplanade.server.net.delivery import Delivery
from esplanade.server.net.ground_work import GroundWork
from esplanade.server.net.hub import Hub
from esplanade.server.net.long_lived import LongLived
from esplanade.server.net.persistence import Persistence
from esplanade.server.net.schedule import Schedule, came_by
from esplanade.server.trajectories.keeping import WorldTrajectories
from esplanade.server.world.actor_travel import ActorTravel
from esplanade.server.world.audience import Audience
from esplanade.server.world.inputs import Input, Still
from esplanade.server.world.zone import Zone

if TYPE_CHECKING:
    from esplanade.server.driving.drivers import Drivers
    from esplanade.server.recording.keeping import ZoneRecorder

log = structlog.get_logger(__name__)


class Ticker:
    """Runs until told to stop. While actors are planned, the event loop serves the sessions."""

    def __init__(
        self,
        world: Zone,
        ground_work: GroundWork,
        audience: Audience,
        link: LocalLink,
        hub: Hub,
        delivery: Delivery,
        schedule: Schedule,
        metrics: Metrics,
        console: Console,
        planning: ActorPlanning,
    ) -> None:
        self._world = world
        self._ground_work = ground_work
        self._audience = audience
        self._link = link
        self._hub = hub
        self._delivery = delivery
        self._schedule = schedule
        self._metrics = metrics
        self._console = console
        self._planning = planning
        self.tap: Tap | None = None
        """Where the ticks go that operators see."""
        self.trajectories: WorldTrajectories | None = None
        """Where the ticks go that are written to a file."""
        self.drivers: Drivers | None = None
        """Those who ask policies from outside what their actors do."""
        self.recorder: ZoneRecorder | None = None
        """Where the ticks go from which a replay runs them again."""
        self._stopping = asyncio.Event()
        self._persistence: Persistence | None = None
        self._travel: ActorTravel | None = None
        self._long_lived: LongLived | None = None
        metrics.gauge(
            "walkers_shown",
            "Walkers whose steps are sent, counted for each viewer",
            lambda: audience.walkers_shown,
        )
        metrics.total("ticks", "Ticks of the world", lambda: world.tick)
        pace = schedule.pace
        metrics.gauge("pace_factor", "Pace that is wanted, 1 as usual", lambda: pace.state.factor)
        metrics.gauge(
            "pace_rate", "Seconds of the world in a second, 0 in a pause", lambda: pace.state.rate
        )
        metrics.gauge("paused", "Whether the world is paused", lambda: int(pace.state.paused))
        metrics.total("ticks_late", "Ticks that began late", lambda: schedule.late_ticks)
        metrics.total(
            "ticks_given_up", "Ticks' worth of time lost", lambda: schedule.given_up_ticks
        )

    def keeping(self, persistence: Persistence) -> Self:
        """The same, seeing between ticks to what outlasts the process."""
        self._persistence = persistence
        return self

    def sparing(self, long_lived: LongLived) -> Self:
        """The same, keeping what clients need for long out of the search for garbage."""
        self._long_lived = long_lived
        return self

    def with_travel(self, travel: ActorTravel) -> Self:
        """The same, letting actors go to other zones and come from there."""
        self._travel = travel
        return self

    def stop(self) -> None:
        """Let the tick that runs be the last."""
        self._stopping.set()

    def keep_from_now(self) -> None:
        """Keep the zone, which has taken the place of one that has ended."""
        if self._persistence is not None:
            self._persistence.go_on()

    async def keep(self, *, in_order: bool) -> None:
        """Keep what is to outlast the process, after the last tick."""
        if self._persistence is not None:
            await self._persistence.stop(in_order=in_order)

    async def run(self) -> None:
        loop, tick_s = asyncio.get_running_loop(), self._world.tick_s
        while not self._stopping.is_set():
            now, due = loop.time(), self._schedule.next_deadline
            if self._schedule.pace.stands:
                if not await came_by(self._stopping, now + tick_s):
                    await self._attend()
            elif due > now:
                # A slow world is asked no less often, and another pace holds at once.
                await came_by(self._stopping, min(due, now + tick_s))
                self._console.answer()
            else:
                await self._tick()

    async def _attend(self) -> None:
        """Take in what came to a world that stands, in a tick in which nobody moves, if need be."""
        now = asyncio.get_running_loop().time()
        given = [*self._hub.drain(now, still=True), *self._console.drain(), *self._travellers()]
        derived = self._ground_work.drain()
        if given or derived or self._console.waits_for_tick:
            await self._run([Still(), *given], derived)
        else:
            self._metrics.stood()
            if self.tap is not None:
                self.tap.stand()
        if self.tap is not None and self.tap.traces.stood():
            await self._planning.run(self.tap.traces.make_one)

    async def _tick(self) -> None:
        loop = asyncio.get_running_loop()
        self._schedule.begin(loop.time())
        kept: list[Input] = [] if self._persistence is None else self._persistence.drain()
        given = [
            *kept,
            *self._planning.inputs(),
            *self._hub.drain(loop.time()),
            *self._console.drain(),
        ]
        given += self._travellers()
        if self.drivers is not None:
            given += self.drivers.drain()
        await self._run(given, self._ground_work.drain())
        if self.drivers is not None:
            self.drivers.observe()
        self._schedule.pace.ticked(loop.time(), self._world.tick, self._world.tick_s)
        room_s = self._planning.ticked(self._schedule, loop.time())
        if self.tap is not None and self.tap.traces.ticked(room_s):
            # No tick begins meanwhile.
            await self._planning.run(self.tap.traces.make_one)

    async def _run(self, given: Sequence[Input], derived: Sequence[Input]) -> None:
        loop, start = asyncio.get_running_loop(), perf_counter()
        self._link.send(list(given))
        inputs = [*self._link.inputs(), *derived]
        self._world.begin(inputs)
        actors_moved = await self._planning.think()
        self._link.publish(self._world.finish(actors_moved))
        frames = self._link.frames()
        for frame in frames:
            self._hub.welcome(frame)
            self._console.take(frame)
            if self._travel is not None:
                self._travel.take(frame)
            news = self._audience.take(frame)
            with self._world.times.stage("write"):
                self._delivery.deliver(news, loop.time())
        seconds = perf_counter() - start
        self._metrics.tick_took(seconds, self._world.times.seconds)
        if self.tap is not None:
            for frame in frames:
                self.tap.take(frame, seconds, self._schedule.late_ticks)
        if self.trajectories is not None:
            for frame in frames:
                self.trajectories.take(frame, inputs)
        if self.recorder is not None:
            for frame in frames:
                self.recorder.take(frame, inputs)
        if self._persistence is not None:
            self._persistence.between_ticks(loop.time())
        if self._long_lived is not None:
            for frame in frames:
                came, gone = frame.joined + frame.attached, frame.left + frame.detached
                self._long_lived.between_ticks(len(came), len(gone), frame.people)

    def _travellers(self) -> Sequence[Input]:
        """Inputs by which actors go to other zones, or come from there."""
        return () if self._travel is None else self._travel.drain()

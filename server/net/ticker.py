"""The ticker runs the zone's ticks at their times, and the actors' planning in its own thread."""

import asyncio
from concurrent.futures import Executor
from time import perf_counter

import structlog

from esplanade.server.console.console import Console
from esplanade.server.link.local import LocalLink
from esplanade.server.live.tap import Tap
from esplanade.server.metrics import Metrics
from esplanade.server.net.delivery import Delivery
from esplanade.server.net.ground_work import GroundWork
from esplanade.server.net.hub import Hub
from esplanade.server.net.schedule import Schedule
from esplanade.server.world.audience import Audience
from esplanade.server.world.zone import Zone

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
        thread: Executor,
        console: Console,
    ) -> None:
        self._world = world
        self._ground_work = ground_work
        self._audience = audience
        self._link = link
        self._hub = hub
        self._delivery = delivery
        self._schedule = schedule
        self._metrics = metrics
        self._thread = thread
        self._console = console
        self.tap: Tap | None = None
        """Where the ticks go that operators see."""
        self._stopping = asyncio.Event()
        metrics.gauge(
            "walkers_shown",
            "Walkers whose steps are sent, counted for each viewer",
            lambda: audience.walkers_shown,
        )
        metrics.total("ticks", "Ticks of the world", lambda: world.tick)
        metrics.total("ticks_late", "Ticks that began late", lambda: schedule.late_ticks)
        metrics.total(
            "ticks_given_up", "Ticks' worth of time lost", lambda: schedule.given_up_ticks
        )

    def stop(self) -> None:
        """Let the tick that runs be the last."""
        self._stopping.set()

    async def run(self) -> None:
        while not await self._stopped_by(self._schedule.next_deadline):
            await self._tick()

    async def _stopped_by(self, deadline: float) -> bool:
        try:
            async with asyncio.timeout_at(deadline):
                await self._stopping.wait()
        except TimeoutError:
            pass
        return self._stopping.is_set()

    async def _tick(self) -> None:
        loop = asyncio.get_running_loop()
        start = perf_counter()
        self._schedule.begin(loop.time())
        self._link.send([*self._hub.drain(loop.time()), *self._console.drain()])
        self._world.begin([*self._link.inputs(), *self._ground_work.drain()])
        actors_moved = await loop.run_in_executor(self._thread, self._think)
        self._link.publish(self._world.finish(actors_moved))
        frames = self._link.frames()
        for frame in frames:
            self._hub.welcome(frame)
            self._console.take(frame)
            news = self._audience.take(frame)
            with self._world.times.stage("write"):
                self._delivery.deliver(news, loop.time())
        seconds = perf_counter() - start
        self._metrics.tick_took(seconds, self._world.times.seconds)
        if self.tap is not None:
            for frame in frames:
                self.tap.take(frame, seconds, self._schedule.late_ticks)

    def _think(self) -> bool:
        try:
            return self._world.think()
        except Exception:
            # The people's world goes on; the actors stand until planning works again.
            log.exception("planning failed", tick=self._world.tick)
            self._metrics.planning_failures.inc()
            return False

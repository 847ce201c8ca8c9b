"""Plans the actors of a zone in a thread of their own, as often as ticks leave time for it."""

import asyncio
from collections.abc import Callable
from concurrent.futures import Executor
from typing import TypeVar

import structlog

from esplanade.server.metrics import Metrics
from esplanade.server.net.interval_choice import IntervalChoice
from esplanade.server.net.schedule import Schedule
from esplanade.server.world.inputs import Input, PlanEvery
from esplanade.server.world.zone import Zone

log = structlog.get_logger(__name__)

_Result = TypeVar("_Result")


class ActorPlanning:
    """A ticker takes its `inputs`, then has it `think`, and says when the tick has ended."""

    def __init__(
        self, zone: Zone, thread: Executor, metrics: Metrics, interval: int | None = None
    ) -> None:
        """Each actor is planned once in `interval` ticks; None: as often as there is time."""
        self._zone = zone
        self._thread = thread
        self._metrics = metrics
        self._interval = IntervalChoice(
            zone.planning_interval, interval, zone.usual_planning_interval
        )
        metrics.gauge(
            "planning_interval_ticks",
            "Ticks from one planning of an actor to its next",
            lambda: zone.planning_interval,
        )

    def inputs(self) -> list[Input]:
        """Another interval, if one is wanted."""
        wanted = self._interval.ticks
        return [] if wanted == self._zone.planning_interval else [PlanEvery(wanted)]

    async def think(self) -> bool:
        """Find the next step of every actor, while the event loop does other things.

        Returns whether there are any; if planning fails they stand.
        """
        return await self.run(self._think)

    async def run(self, work: Callable[[], _Result]) -> _Result:
        """Do other work in the thread that plans, so that no planning runs meanwhile."""
        return await asyncio.get_running_loop().run_in_executor(self._thread, work)

    def ticked(self, schedule: Schedule, now_s: float) -> float:
        """Take in that a tick has ended; returns the seconds until the next one is due."""
        room_s = schedule.next_deadline - now_s
        planning_s = self._zone.times.seconds.get("actors", 0.0)
        self._interval.ticked(room_s, planning_s, schedule.period_s)
        return room_s

    def _think(self) -> bool:
        try:
            return self._zone.think()
        except Exception:
            # The people's world goes on; the actors stand until planning works again.
            log.exception("planning failed", tick=self._zone.tick)
            self._metrics.planning_failures.inc()
            return False

"""The schedule says when the next tick is due, without drift and with few ticks to catch up."""

import asyncio
from typing import Final

from esplanade.server.world.pace import Pace

MAX_BEHIND_TICKS: Final = 2
"""Further behind than this, the world gives the lost time up instead of rushing after it."""


class Schedule:
    """Deadlines `period_s` of the world apart. Times are seconds of one monotonic clock.

    A world at twice its pace has them half as far apart. While it stands, its time does too; each
    tick that is run meanwhile takes it on by a period.
    """

    def __init__(self, period_s: float, start: float, pace: Pace | None = None) -> None:
        self._period_s = period_s
        self.pace = pace or Pace()
        self.pace.changed.append(lambda _, now: self._follow(now))
        self._rate = self.pace.state.factor
        self._next = start
        self._left_s: float | None = None
        """World time until the next tick was due when the world began to stand; None if not."""
        self.late_ticks = 0
        """Ticks that began more than half a period after their time."""
        self.given_up_ticks = 0
        """Ticks' worth of time that the world has lost to the clock."""

    @property
    def next_deadline(self) -> float:
        return self._next

    @property
    def period_s(self) -> float:
        """Time between two deadlines by the clock, seconds."""
        return self._period_s / self._rate

    def _follow(self, now: float) -> None:
        """Go by the pace that is wanted now: the next tick comes sooner or later than before."""
        state = self.pace.state
        left_s = (self._next - now) * self._rate if self._left_s is None else self._left_s
        if state.factor != self._rate or state.paused != (self._left_s is not None):
            self._rate = state.factor
            self._next = now + max(0.0, left_s) / self._rate
            self._left_s = min(max(0.0, left_s), self._period_s) if state.paused else None

    def begin(self, now: float) -> None:
        """Begin a tick now, and set the deadline of the one after it."""
        period_s = self.period_s
        if self._left_s is not None:
            self._next = now + period_s
            return
        behind_s = now - self._next
        if behind_s > 0.5 * period_s:
            self.late_ticks += 1
        excess = int(behind_s / period_s) - MAX_BEHIND_TICKS
        if excess > 0:
            self.given_up_ticks += excess
            self._next += excess * period_s
        self._next += period_s

    def world_time(self, tick: int, now: float) -> float:
        """Seconds of the world, tick x period at each tick and running on in between.

        `tick` is the number of ticks begun; the next deadline is that of tick + 1.
        """
        left_s = (self._next - now) * self._rate if self._left_s is None else self._left_s
        return (tick + 1) * self._period_s - left_s


async def came_by(event: asyncio.Event, deadline: float) -> bool:
    """Wait for an event until that time of the loop; returns whether it has come."""
    try:
        async with asyncio.timeout_at(deadline):
            await event.wait()
    except TimeoutError:
        pass
    return event.is_set()

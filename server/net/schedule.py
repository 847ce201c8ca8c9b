"""The schedule says when the next tick is due, without drift and with few ticks to catch up."""

from typing import Final

MAX_BEHIND_TICKS: Final = 2
"""Further behind than this, the world gives the lost time up instead of rushing after it."""


class Schedule:
    """Deadlines `period_s` apart. Times are seconds of one monotonic clock."""

    def __init__(self, period_s: float, start: float) -> None:
        self._period_s = period_s
        self._next = start
        self.late_ticks = 0
        """Ticks that began more than half a period after their time."""
        self.given_up_ticks = 0
        """Ticks' worth of time that the world has lost to the clock."""

    @property
    def next_deadline(self) -> float:
        return self._next

    def begin(self, now: float) -> None:
        """Begin a tick now, and set the deadline of the one after it."""
        behind_s = now - self._next
        if behind_s > 0.5 * self._period_s:
            self.late_ticks += 1
        excess = int(behind_s / self._period_s) - MAX_BEHIND_TICKS
        if excess > 0:
            self.given_up_ticks += excess
            self._next += excess * self._period_s
        self._next += self._period_s

    def world_time(self, tick: int, now: float) -> float:
        """Seconds of the world, tick x period at each tick and running on in between.

        `tick` is the number of ticks begun; the next deadline is that of tick + 1.
        """
        return (tick + 1) * self._period_s - (self._next - now)

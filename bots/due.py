"""Snapshots are counted against the ticks that were due, whether or not anything came.

A count of what comes in tells nothing of a server that stands still: in four seconds of silence
one late snapshot is measured, and eighty that should have come are not (coordinated omission,
G. Tene 2013). So every tick that was due has an age, from the moment when it was due by the
server's clock to the moment when the client had its snapshot or a later one.
"""

from typing import Final

from esplanade.bots.tally import Tally

LATE_TICKS: Final = 2.0
"""A snapshot is late when this many more ticks were due before it came."""

EXACT: Final = 200
"""The newest ticks of a gap are counted one by one, those before them a second at a time."""


class DueTicks:
    """Counts the ticks of one client into a tally. All times are of the local monotonic clock."""

    def __init__(self, tally: Tally, tick_rate: int, welcomed_s: float) -> None:
        """The first snapshot is due two ticks after the welcome at the latest."""
        self._tally = tally
        self._tick_rate = tick_rate
        self._tick_s = 1.0 / tick_rate
        self._rate = 1.0
        self._due_s = welcomed_s + self._tick_s
        self._tick = -1
        self._least_age_s = float("inf")

    def pace(self, rate: float, now_s: float) -> None:
        """The world runs at another rate from now on: so often are ticks due, in a pause none."""
        if rate != self._rate:
            self._rate = rate
            self._due_s = max(self._due_s, now_s)

    def take(self, tick: int, due_s: float, now_s: float) -> None:
        """The snapshot of `tick` has come in, which was due at `due_s` on the local clock.

        A server that has fallen behind may give up time: it counts ticks without a gap, and its
        clock steps back. The local clock does not, and counts what was due meanwhile.
        """
        if tick <= self._tick:
            return
        self._tick = tick
        since = round((due_s - self._due_s) * self._tick_rate * self._rate)
        self._miss(self._due_s, since - 1, now_s)
        self._due_s = due_s if self._rate else now_s
        age_s = max(0.0, now_s - self._due_s)
        self._least_age_s = min(self._least_age_s, age_s)
        self._tally.snapshots_received += 1
        self._tally.series.at(now_s).received += 1
        if age_s > LATE_TICKS * self._tick_s:
            self._tally.snapshots_late += 1
        self._count(self._due_s, age_s)

    def finish(self, now_s: float) -> None:
        """The client goes: what was due and has not come is missing, but for what is on its way."""
        usual_s = self._least_age_s if self._tick >= 0 else 0.0
        waited_s = now_s - usual_s - LATE_TICKS * self._tick_s - self._due_s
        self._miss(self._due_s, int(waited_s * self._tick_rate * self._rate), now_s)

    def _miss(self, before_s: float, ticks: int, now_s: float) -> None:
        """Count `ticks` that were due after `before_s` and were not overtaken before now."""
        if ticks <= 0:
            return
        self._tally.snapshots_missing += ticks
        counted = 0
        while counted < ticks:
            share = max(1, min(self._tick_rate, ticks - EXACT - counted))
            due_s = before_s + (counted + (share + 1) / 2.0) * self._tick_s / self._rate
            self._count(due_s, max(0.0, now_s - due_s), share)
            counted += share

    def _count(self, due_s: float, age_s: float, times: int = 1) -> None:
        self._tally.snapshots_due += times
        self._tally.snapshot_age_s.add(age_s, times)
        self._tally.series.at(due_s).add_age(age_s, times)

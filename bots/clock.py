"""The server's time on this machine, which runs at the pace of the world."""

from collections import deque
from typing import Final, NamedTuple

KEPT: Final = 32
"""This many recent round trips are compared; older ones would hide a drift of the clocks."""

TOLERANCE_S: Final = 0.005
"""Two samples may disagree by this much more, for clocks that drift and readings that round."""


class _Sample(NamedTuple):
    """A round trip, and the server's time at the local time at which it ended."""

    round_trip_s: float
    server_s: float
    local_s: float


class ServerClock:
    """The server's clock, from the quickest of the recent round trips.

    The quicker a round trip, the less can be wrong with halving it: a sample is right within half
    its round trip. Two samples that cannot both be right mean that the server's clock has stepped
    (an overloaded world gives up lost time), and the older ones are forgotten. All times in
    seconds; local ones come from whatever monotonic clock the caller reads.

    Operators change the pace of a world, and its time goes by that; in a pause it stands.
    """

    def __init__(self) -> None:
        self.rate = 1.0
        """Seconds of the world in a second; 0 while it stands."""
        self._samples: deque[_Sample] = deque(maxlen=KEPT)
        self._best = _Sample(float("inf"), 0.0, 0.0)
        self._heard_s = float("-inf")

    def seed(self, server_time_s: float, now_s: float) -> None:
        """A reading without a round trip; only counts until the first pong."""
        if not self._samples:
            self._best = _Sample(float("inf"), server_time_s, now_s)

    def pace(self, rate: float, server_time_s: float, now_s: float) -> None:
        """The world has another rate since that time of its own; told again, nothing changes."""
        if rate == self.rate:
            return
        under_way_s = min((each.round_trip_s for each in self._samples), default=0.0) / 2.0
        self._samples.clear()
        self.rate = rate
        self._best = _Sample(float("inf"), server_time_s + rate * under_way_s, now_s)

    def add(self, sent_s: float, received_s: float, server_time_s: float) -> float:
        """A pong that came `received_s` for the ping of `sent_s`; returns the round trip."""
        round_trip_s = max(0.0, received_s - sent_s)
        new = _Sample(round_trip_s, server_time_s + self.rate * round_trip_s / 2.0, received_s)
        if any(self._disagree(new, other) for other in self._samples):
            self._samples.clear()
        self._samples.append(new)
        # The time of a world that stands grows with each tick that is run all the same.
        self._best = min(self._samples) if self.rate else new
        self._heard_s = received_s
        return round_trip_s

    def at(self, now_s: float) -> float:
        """The server's time at the local time `now_s`."""
        return self._best.server_s + self.rate * (now_s - self._best.local_s)

    def doubt(self, now_s: float, every_s: float) -> bool:
        """Whether a pong is wanted, because something came at an odd time; so often at most."""
        if now_s - self._heard_s < every_s:
            return False
        self._heard_s = now_s
        return True

    def local(self, server_s: float) -> float:
        """The local time at which the server's clock says `server_s`.

        For a world that stands it is the time at which that was learnt last.
        """
        if not self.rate:
            return self._best.local_s
        return self._best.local_s + (server_s - self._best.server_s) / self.rate

    def _disagree(self, one: _Sample, other: _Sample) -> bool:
        """Whether two samples cannot both be right."""
        apart_s = one.server_s - other.server_s - self.rate * (one.local_s - other.local_s)
        doubt_s = self.rate * (one.round_trip_s + other.round_trip_s) / 2.0
        return abs(apart_s) > doubt_s + TOLERANCE_S

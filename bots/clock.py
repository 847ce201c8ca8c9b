"""The server's time on this machine."""

from collections import deque
from typing import Final

KEPT: Final = 32
"""This many recent round trips are compared; older ones would hide a drift of the clocks."""

TOLERANCE_S: Final = 0.005
"""Two samples may disagree by this much more, for clocks that drift and readings that round."""


class ServerClock:
    """Offset to the server's clock, from the quickest of the recent round trips.

    The quicker a round trip, the less can be wrong with halving it: a sample is right within half
    its round trip. Two samples that cannot both be right mean that the server's clock has stepped
    (an overloaded world gives up lost time), and the older ones are forgotten. All times in
    seconds; local ones come from whatever monotonic clock the caller reads.
    """

    def __init__(self) -> None:
        self._samples: deque[tuple[float, float]] = deque(maxlen=KEPT)
        self._offset_s = 0.0
        self._heard_s = float("-inf")

    def seed(self, server_time_s: float, now_s: float) -> None:
        """A reading without a round trip; only counts until the first pong."""
        if not self._samples:
            self._offset_s = server_time_s - now_s

    def add(self, sent_s: float, received_s: float, server_time_s: float) -> float:
        """A pong that came `received_s` for the ping of `sent_s`; returns the round trip."""
        round_trip_s = max(0.0, received_s - sent_s)
        offset_s = server_time_s + round_trip_s / 2.0 - received_s
        if any(
            abs(offset_s - other_s) > (round_trip_s + other_trip_s) / 2.0 + TOLERANCE_S
            for other_trip_s, other_s in self._samples
        ):
            self._samples.clear()
        self._samples.append((round_trip_s, offset_s))
        self._offset_s = min(self._samples)[1]
        self._heard_s = received_s
        return round_trip_s

    def at(self, now_s: float) -> float:
        """The server's time at the local time `now_s`."""
        return now_s + self._offset_s

    def doubt(self, now_s: float, every_s: float) -> bool:
        """Whether a pong is wanted, because something came at an odd time; so often at most."""
        if now_s - self._heard_s < every_s:
            return False
        self._heard_s = now_s
        return True

    def local(self, server_s: float) -> float:
        """The local time at which the server's clock says `server_s`."""
        return server_s - self._offset_s

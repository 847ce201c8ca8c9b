"""When ticks were, by the wall clock: a world may be paused, and go at another pace."""

from bisect import bisect_right
from collections import deque
from typing import Final

TOLERANCE_US: Final = 100_000.0
"""Moments that are told are off by twice as much at most."""
MOST_CORNERS: Final = 4096

Moment = tuple[int, int]
"""A tick, and when it was: microseconds since 1970."""


class Moments:
    """A line through the moments of all ticks, of which only the corners are kept."""

    def __init__(self) -> None:
        self._corners: deque[Moment] = deque(maxlen=MOST_CORNERS)
        self._last: Moment = 0, 0
        self._slopes = 0.0, float("inf")
        """The slopes of lines from the last corner that pass near all ticks since."""

    def take(self, tick: int, at_us: int) -> None:
        """Note when a tick was."""
        if not self._corners or tick <= self._last[0]:
            self._corners.clear()
            self._corners.append((tick, at_us))
            self._last, self._slopes = (tick, at_us), (0.0, float("inf"))
            return
        at_us = max(at_us, self._last[1])  # a clock may be set back
        low, high = self._slopes_to(tick, at_us)
        if max(low, self._slopes[0]) > min(high, self._slopes[1]):
            self._corners.append(self._last)
            self._slopes = self._slopes_to(tick, at_us)
        else:
            self._slopes = max(low, self._slopes[0]), min(high, self._slopes[1])
        self._last = tick, at_us

    def tick_at(self, at_us: int) -> int:
        """The tick that was the latest at a moment, or the first that is known."""
        line = self._line()
        after = bisect_right(line, at_us, key=lambda moment: moment[1])
        if not line:
            return 0
        if after in {0, len(line)}:
            return line[0 if after == 0 else -1][0]
        (tick, from_us), (next_tick, to_us) = line[after - 1], line[after]
        return tick + (next_tick - tick) * (at_us - from_us) // (to_us - from_us)

    def told(self, from_tick: int) -> list[Moment]:
        """The corners of the line from a tick on, the oldest first; between them it is straight."""
        line = self._line()
        first = max(0, bisect_right(line, from_tick, key=lambda moment: moment[0]) - 1)
        return line[first:]

    def _line(self) -> list[Moment]:
        corners = list(self._corners)
        return corners if not corners or corners[-1] == self._last else [*corners, self._last]

    def _slopes_to(self, tick: int, at_us: int) -> tuple[float, float]:
        begin, from_us = self._corners[-1]
        ticks, us = tick - begin, at_us - from_us
        return max(0.0, us - TOLERANCE_US) / ticks, (us + TOLERANCE_US) / ticks

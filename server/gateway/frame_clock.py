"""The clock of a zone as its frames tell it."""

from collections import deque
from typing import Final

KEPT: Final = 100
"""The number of frames that are compared: the quickest of them tells the time best."""


class FrameClock:
    """World time between frames: that of the frame that came quickest, running on since."""

    def __init__(self, tick_s: float) -> None:
        self._tick_s = tick_s
        self._rate = 1.0
        self._ahead_s: deque[float] = deque(maxlen=KEPT)
        self._best_s: float | None = None

    def begin(self) -> None:
        """Forget the frames of an owner of the zone that is not any more."""
        self._ahead_s.clear()
        self._best_s = None

    def take(self, tick: int, now_s: float, rate: float = 1.0) -> None:
        """Note that the frame of a tick has come; from it on, time runs `rate` times as fast."""
        if rate != self._rate:
            self.begin()
            self._rate = rate
        self._ahead_s.append(tick * self._tick_s - rate * now_s)
        self._best_s = max(self._ahead_s)

    def at(self, now_s: float) -> float:
        """World time, seconds; 0 before the first frame."""
        return 0.0 if self._best_s is None else max(0.0, self._best_s + self._rate * now_s)

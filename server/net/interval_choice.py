"""Chooses how many ticks lie between two plannings of an actor, by the room that ticks leave."""

from typing import Final

import numpy as np
import structlog

MOST_TICKS: Final = 4
"""The interval goes up to this at most, however slow the machine is."""
WINDOW_TICKS: Final = 20
"""The room that ticks leave is the median of so many; a single slow tick changes nothing."""
LITTLE_ROOM: Final = 0.1
"""With less room than this part of a tick, actors are planned in fewer ticks."""
ENOUGH_ROOM: Final = 0.3
"""With as much room left if they were planned in more ticks again, they are."""
ENOUGH_WINDOWS: Final = 10
"""There must be room enough in so many windows, one after the other."""
LEAST_PLANNING: Final = 0.1
"""Others are to blame for a lack of room if planning takes less than this part of a tick."""

log = structlog.get_logger(__name__)


class IntervalChoice:
    """The planning interval that is wanted: that of the settings, or one that ticks have time for.

    It goes up by a tick as soon as there is little room, and down only after there was enough for
    ten times as long, reckoned as if all planning took longer by as much as it is done more often.
    """

    def __init__(self, ticks: int, fixed: int | None = None, least: int = 1) -> None:
        """Begin with the interval of a world, and never go below the `least`, or stay at a `fixed`
        one."""
        self.ticks = max(least, ticks) if fixed is None else fixed
        """Ticks from one planning of an actor to its next."""
        self._least = least
        self._is_fixed = fixed is not None
        self._rooms: list[float] = []
        self._shares: list[float] = []
        self._windows = 0

    def ticked(self, room_s: float, planning_s: float, period_s: float) -> None:
        """Take in a tick that planned, and choose anew after some of them.

        Parameters
        ----------
        room_s : time from its end until the next one was due, below 0 if that was late
        planning_s : time that the planning of actors took in it
        period_s : time between two ticks by the clock
        """
        if self._is_fixed:
            return
        self._rooms.append(room_s / period_s)
        self._shares.append(planning_s / period_s)
        if len(self._rooms) < WINDOW_TICKS:
            return
        room, share = float(np.median(self._rooms)), float(np.median(self._shares))
        self._rooms.clear()
        self._shares.clear()
        if room < LITTLE_ROOM:
            self._windows = 0
            if self.ticks < MOST_TICKS and share >= LEAST_PLANNING:
                self.ticks += 1
                log.warning(
                    "the planning interval goes up, since ticks leave too little room",
                    **self._told(room, share),
                )
            return
        more = share / (self.ticks - 1) if self.ticks > 1 else 0.0
        self._windows = self._windows + 1 if room - more >= ENOUGH_ROOM else 0
        if self.ticks > self._least and self._windows >= ENOUGH_WINDOWS:
            self._windows = 0
            self.ticks -= 1
            log.info("the planning interval goes down again", **self._told(room, share))

    def _told(self, room: float, share: float) -> dict[str, int]:
        return {
            "interval_ticks": self.ticks,
            "room_percent": round(100 * room),
            "planning_percent": round(100 * share),
        }

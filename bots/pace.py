"""The time that a replay has reached: by the server's ticks if there are any, else by the clock."""

import asyncio

from esplanade.bots.client import sleep_until
from esplanade.bots.follower import Timeline


class Pace:
    """The shared progress of a replay. Local times are those of the event loop, seconds."""

    def __init__(self, begin_s: float, speedup: float) -> None:
        """`begin_s` is the moment of the recording with which the replay begins, now."""
        self._speedup = speedup
        self._seen_s = asyncio.get_running_loop().time()
        self._seen_recorded_s = begin_s
        self._seen_tick = 0
        self._timeline: Timeline | None = None

    def timeline(self, tick: int, tick_s: float) -> Timeline:
        """The tie between ticks and moments; the first tick ever seen fixes it for everyone."""
        if self._timeline is None:
            self._timeline = Timeline(tick, self.recorded_s, tick_s, self._speedup)
        self.saw(tick)
        return self._timeline

    def saw(self, tick: int) -> None:
        """The server has come to this tick; keeps pace with a server that is slower than time."""
        if self._timeline is not None and tick > self._seen_tick:
            self._seen_tick = tick
            self._seen_s = asyncio.get_running_loop().time()
            self._seen_recorded_s = self._timeline.recorded_s(tick)

    @property
    def recorded_s(self) -> float:
        """The moment of the recording that it is now."""
        since_s = asyncio.get_running_loop().time() - self._seen_s
        return self._seen_recorded_s + since_s * self._speedup

    async def until(self, recorded_s: float, stop: asyncio.Event) -> None:
        """Sleep until that moment of the recording, or until stopped."""
        while not stop.is_set() and (rest_s := recorded_s - self.recorded_s) > 0.0:
            await sleep_until(asyncio.get_running_loop().time() + rest_s / self._speedup, stop)

"""Samples of a zone: where everybody is after a tick, as rows of a table."""

import numpy as np

from esplanade.recordings.samples import SAMPLE, Samples
from esplanade.server.world.state import ACTOR
from esplanade.server.world.zone import Zone


class Sampler:
    """Takes samples of a zone between two ticks, every so many of them."""

    def __init__(self, zone: Zone, every: int) -> None:
        self._zone = zone
        self.every = every

    @property
    def fps(self) -> float:
        """Frames a second."""
        return 1.0 / (self._zone.tick_s * self.every)

    def frame(self, tick: int) -> int:
        """The frame that is due at a tick, or the next one after it."""
        return -(-tick // self.every)

    def is_due(self, tick: int) -> bool:
        """Whether a sample is due after this tick."""
        return tick % self.every == 0

    def samples(self) -> Samples:
        """Everybody, by id; a copy."""
        zone, state = self._zone, self._zone.state
        live = state.live()
        live = live[np.argsort(state.ids[live])]
        found = np.empty(len(live), dtype=SAMPLE)
        found["frame"] = self.frame(zone.tick)
        found["id"] = state.ids[live]
        found["actor"] = state.kinds[live] == ACTOR
        found["t"] = zone.tick * zone.tick_s
        moved_m = state.positions[live] - state.before[live]
        for axis, (place, velocity) in enumerate((("x", "vx"), ("y", "vy"))):
            found[place] = state.positions[live, axis]
            found[velocity] = moved_m[:, axis] / zone.tick_s
        found["z"] = state.heights[live]
        found["heading"] = state.headings[live]
        return found

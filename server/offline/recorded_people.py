"""Recorded people as inputs of ticks: they come in, walk their tracks, and leave."""

import heapq
import math
from typing import NamedTuple

from esplanade.recordings import Crowd, Track
from esplanade.server.world.frame import Frame
from esplanade.server.world.inputs import Input, Join, Leave, Steer
from esplanade.server.world.state import State

NAME_CHARS = 32


class _Walker(NamedTuple):
    track: Track
    last_tick: int


class RecordedPeople:
    """The people of a recording. Its first sample is at time 0 of the world.

    A person is in the world in every tick that ends while the track lasts, and is sent each tick
    from where it stands to where the track is at the tick's end.
    """

    def __init__(self, crowd: Crowd, tick_s: float) -> None:
        self._start_s, self._tick_s = crowd.start_s, tick_s
        self.duration_s = crowd.duration_s
        self._coming = [
            (max(1, math.ceil((track.start_s - self._start_s) / tick_s - 1e-9)), number, track)
            for number, track in enumerate(crowd.tracks, start=1)
        ]
        heapq.heapify(self._coming)
        self._joining: dict[int, _Walker] = {}
        self._walking: dict[int, _Walker] = {}
        self._seq = 0
        self.names: dict[int, str] = {}
        """The names of avatars in the recording, also of those who have left."""
        self.furthest_m = 0.0
        """The greatest distance of anybody from the track so far."""

    def inputs(self, tick: int, state: State) -> list[Input]:
        """The inputs of a tick."""
        found: list[Input] = []
        for avatar, walker in list(self._walking.items()):
            if tick > walker.last_tick:
                found.append(Leave(avatar))
                del self._walking[avatar]
            else:
                found.append(self._steer(avatar, walker.track, tick, state))
        while self._coming and self._coming[0][0] <= tick:
            _, number, track = heapq.heappop(self._coming)
            last = math.floor((track.end_s - self._start_s) / self._tick_s + 1e-9)
            if last >= tick:
                self._joining[number] = _Walker(track, last)
                name = f"Pedestrian {track.id}"[:NAME_CHARS].strip()
                found.append(Join(number, name, (*self._at(track, tick), 0.0)))
        return found

    def take(self, frame: Frame, state: State) -> None:
        """Learn who came in, and how far off everybody is."""
        for ticket, avatar in frame.joined:
            walker = self._joining.pop(ticket, None)
            if walker is not None:
                self._walking[avatar] = walker
                self.names[avatar] = walker.track.id
        for avatar, walker in self._walking.items():
            if avatar in state and frame.tick <= walker.last_tick:
                place = state.positions[state.slot(avatar)].tolist()
                off_m = math.dist(place, self._at(walker.track, frame.tick))
                self.furthest_m = max(self.furthest_m, off_m)

    def _at(self, track: Track, tick: int) -> tuple[float, float]:
        return track.at(self._start_s + tick * self._tick_s)

    def _steer(self, avatar: int, track: Track, tick: int, state: State) -> Steer:
        x, y = state.positions[state.slot(avatar)].tolist()
        to_x, to_y = self._at(track, tick)
        self._seq += 1
        speed_mps = math.hypot(to_x - x, to_y - y) / self._tick_s
        return Steer(avatar, self._seq, math.atan2(to_y - y, to_x - x), speed_mps)

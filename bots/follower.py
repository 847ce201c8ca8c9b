"""Steers along a recorded trajectory by the server's reports; this is arithmetic without sockets.

A command sent now counts some ticks later, and the snapshot in hand is already old. So the
follower works out where the avatar will be when the command begins to count, from the commands
that are still on their way, and asks for the velocity that brings it to where the track is at
the end of that tick.
"""

import math
from collections import deque
from dataclasses import dataclass
from typing import Final, NamedTuple

from esplanade.recordings import Track

GAIN: Final = 0.5
"""Share of an error that one tick takes back. Less is slow, more amplifies rounding to whole cm."""

STILL_M: Final = 0.02
"""A bot that is to stand and is this near stands; rounding would keep it shuffling otherwise."""

MAX_LAG_TICKS: Final = 20
MAX_PENDING: Final = 64

Vector = tuple[float, float]


@dataclass(frozen=True)
class Timeline:
    """The tie between ticks of the server and moments of the recording."""

    base_tick: int
    base_s: float
    """Moment of the recording at the base tick."""
    tick_s: float
    speedup: float

    def recorded_s(self, tick: int) -> float:
        return self.base_s + (tick - self.base_tick) * self.tick_s * self.speedup


class Command(NamedTuple):
    """A `move` to send; `capped` says that the track runs faster than the server allows."""

    seq: int
    direction: float
    speed: float
    capped: bool


class _Sent(NamedTuple):
    seq: int
    tick: int
    velocity: Vector


class Follower:
    """Keeps one avatar on its track, a command a snapshot."""

    def __init__(self, track: Track, timeline: Timeline, max_speed_mps: float) -> None:
        self._track = track
        self._timeline = timeline
        self._max_speed_mps = max_speed_mps
        self._pending: deque[_Sent] = deque(maxlen=MAX_PENDING)
        self._in_force = _Sent(0, 0, (0.0, 0.0))
        self._lag_ticks = 1
        self._seq = 0

    def deviation_m(self, tick: int, position: Vector) -> float | None:
        """Distance to the track at that tick's moment; None before its start and after its end."""
        moment_s = self._timeline.recorded_s(tick)
        if not self._track.start_s <= moment_s <= self._track.end_s:
            return None
        return math.dist(position, self._track.at(moment_s))

    def steer(self, tick: int, ack: int, position: Vector) -> Command | None:
        """Answer to a snapshot; None when the command in force is to go on.

        Parameters
        ----------
        tick : of the snapshot
        ack : newest sequence number that counted in it
        position : own place (x, y) in it, metres
        """
        self._heed(tick, ack)
        begins = tick + self._lag_ticks - 1
        now, then = self._track_at(begins), self._track_at(begins + 1)
        dt = self._timeline.tick_s
        planned = ((then[0] - now[0]) / dt, (then[1] - now[1]) / dt)
        place = self._predict(tick, position)
        error = (now[0] - place[0], now[1] - place[1])
        if planned == (0.0, 0.0) and math.hypot(*error) < STILL_M:
            velocity = (0.0, 0.0)
        else:
            velocity = (planned[0] + GAIN * error[0] / dt, planned[1] + GAIN * error[1] / dt)
        return self._command(tick, velocity, capped=math.hypot(*planned) > self._max_speed_mps)

    def _track_at(self, tick: int) -> Vector:
        return self._track.at(self._timeline.recorded_s(tick))

    def _heed(self, tick: int, ack: int) -> None:
        """Learn from the acknowledgement which command counts now, and how long it took."""
        newly = False
        while self._pending and self._pending[0].seq <= ack:
            self._in_force = self._pending.popleft()
            newly = True
        if newly:
            self._lag_ticks = min(max(tick - self._in_force.tick, 1), MAX_LAG_TICKS)

    def _predict(self, tick: int, position: Vector) -> Vector:
        """The avatar's place at the time when a command that is sent now begins to count."""
        x, y = position
        for ahead in range(1, self._lag_ticks):
            vx, vy = self._in_force.velocity
            for sent in self._pending:
                if sent.tick + self._lag_ticks <= tick + ahead:
                    vx, vy = sent.velocity
            x += vx * self._timeline.tick_s
            y += vy * self._timeline.tick_s
        return x, y

    def _command(self, tick: int, velocity: Vector, *, capped: bool) -> Command | None:
        speed = math.hypot(*velocity)
        if speed > self._max_speed_mps:
            share = self._max_speed_mps / speed
            velocity = (velocity[0] * share, velocity[1] * share)
            speed = self._max_speed_mps
        newest = self._pending[-1] if self._pending else self._in_force
        if self._seq and velocity == newest.velocity:
            return None
        self._seq += 1
        self._pending.append(_Sent(self._seq, tick, velocity))
        return Command(self._seq, math.atan2(velocity[1], velocity[0]), speed, capped)

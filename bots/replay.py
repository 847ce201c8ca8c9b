"""Replays a recorded crowd: each pedestrian is a client that joins, walks its track and leaves."""

import asyncio
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from esplanade.bots.admission import admission
from esplanade.bots.client import Client, until_first, visit
from esplanade.bots.clock import ServerClock
from esplanade.bots.follower import Follower
from esplanade.bots.pace import Pace
from esplanade.bots.tally import Tally
from esplanade.protocol import VERSION
from esplanade.protocol.codec import SNAPSHOT_HEAD_BYTES
from esplanade.protocol.codes import MAX_NAME_CHARS
from esplanade.protocol.messages import Hello, Move
from esplanade.protocol.snapshot import find_position_m
from esplanade.recordings import Track

LEAD_S: Final = 0.5
"""A pedestrian joins this long (real time) before its recorded start, so that it stands at its
first place when its track begins."""

NEAR_M: Final = 0.1
"""A replay promises to be this near to the recorded track at every tick."""


@dataclass(frozen=True)
class ReplayJob:
    """The tracks to be walked in any order, at least one, each of two samples or more."""

    url: str
    tracks: tuple[Track, ...]
    speedup: float
    linger_s: float
    """Time that a pedestrian stands at its last place before it leaves (real time)."""
    trust: Path | None = None
    """The only certificate that is trusted."""
    token: str = ""
    """The token of a bot, by which all of them come in."""

    async def run(self, tally: Tally, stop: asyncio.Event) -> None:
        """Send everyone in at their time, until all have left or `stop` is set."""
        tally.expected = len(self.tracks)
        tracks = sorted(self.tracks, key=lambda track: track.start_s)
        lead_s = LEAD_S * self.speedup
        pace = Pace(tracks[0].start_s - lead_s, self.speedup)
        clock = ServerClock()
        async with asyncio.TaskGroup() as group:
            for track in tracks:
                await pace.until(track.start_s - lead_s, stop)
                if stop.is_set():
                    break
                group.create_task(self._visit(track, pace, clock, tally, stop))

    async def _visit(
        self, track: Track, pace: Pace, clock: ServerClock, tally: Tally, stop: asyncio.Event
    ) -> None:
        name = f"Pedestrian {track.id}"[:MAX_NAME_CHARS].strip()
        hello = Hello(
            name=name,
            version=VERSION,
            at=(*track.at(track.start_s), 0.0),
            admission=admission(self.token),
        )

        async def stay(client: Client) -> None:
            done = asyncio.Event()
            walk = _Walk(client, track, pace, tally, done, self.linger_s * self.speedup)
            await until_first(
                client.read(walk.on_snapshot), client.keep_pinging(), done.wait(), stop.wait()
            )

        await visit(self.url, hello, clock, tally, stay, self.trust)


class _Walk:
    """Walks one pedestrian: measures each snapshot and answers it with a command."""

    def __init__(
        self,
        client: Client,
        track: Track,
        pace: Pace,
        tally: Tally,
        done: asyncio.Event,
        linger_s: float,
    ) -> None:
        welcome = client.welcome
        self._client = client
        self._id = welcome.id
        self._origin = welcome.origin
        self._pace = pace
        self._timeline = pace.timeline(welcome.tick, 1.0 / welcome.tick_rate)
        self._follower = Follower(track, self._timeline, welcome.max_speed)
        self._tally = tally
        self._done = done
        self._leave_s = track.end_s + linger_s

    async def on_snapshot(self, tick: int, ack: int, frame: bytes) -> None:
        self._pace.saw(tick)
        if self._timeline.recorded_s(tick) > self._leave_s:
            self._done.set()
            return
        position = find_position_m(frame[SNAPSHOT_HEAD_BYTES:], self._id, self._origin)
        if position is None:
            return
        deviation_m = self._follower.deviation_m(tick, position)
        if deviation_m is not None:
            self._tally.deviation_m.add(deviation_m)
            self._tally.near += deviation_m <= NEAR_M
        command = self._follower.steer(tick, ack, position)
        if command is not None:
            self._tally.capped += command.capped
            await self._client.send(
                Move(seq=command.seq, direction=command.direction, speed=command.speed)
            )

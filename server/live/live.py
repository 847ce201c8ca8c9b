"""Live views of a zone: takes its ticks in, beat by beat, and tells subscribers what is new."""

import asyncio
import json
from collections.abc import Mapping, Sequence
from typing import Any, Final

import structlog

from esplanade.server.accounts.identity import Identity
from esplanade.server.live.bulletin import Bulletin, Notice
from esplanade.server.live.ground_plan import ground_plan
from esplanade.server.live.map_feed import MapFeed
from esplanade.server.live.names import sees_names
from esplanade.server.live.subscriber import Subscriber
from esplanade.server.live.subscriptions import BEATS_A_SECOND
from esplanade.server.live.tap import Tap, Tick
from esplanade.server.world.zone import Zone

MOST_SUBSCRIBERS: Final = 32
"""Consoles with an open socket; more are refused."""

log = structlog.get_logger(__name__)


class Live:
    """All live views of one zone. Only `tap` and `bulletin` belong to other threads."""

    def __init__(
        self, zone: Zone, storeys_m: Sequence[float], bulletin: Bulletin, *, hide_names: bool
    ) -> None:
        self.zone = zone
        self.storeys_m = list(storeys_m)
        self.hide_names = hide_names
        self.tap = Tap(zone)
        self.bulletin = bulletin
        self.map = MapFeed(zone.origin_m, zone.tick_s)
        self.subscribers: set[Subscriber] = set()
        self.map_frames_dropped = 0
        """Of subscribers that are gone, and of those that are there."""
        self.too_slow = 0
        """Subscribers that were closed since they did not read."""
        self.beats = 0
        self._plan: dict[str, Any] | None = None

    def sees_names(self, by: Identity) -> bool:
        """Whether an operator is told the names of people."""
        return sees_names(by, self.hide_names)

    def plan(self) -> dict[str, Any]:
        """The plan of the scene, without the states of doors."""
        if self._plan is None:
            self._plan = ground_plan(self.zone.scene, self.zone.grid, self.storeys_m)
        return self._plan

    def hello(self, subscriber: Subscriber) -> None:
        """Take a new subscriber in."""
        self.subscribers.add(subscriber)
        subscriber.tell(
            {
                "channel": "hello",
                "tick": self.map.tick,
                "tick_s": self.zone.tick_s,
                "names": subscriber.names,
                "storeys": self.storeys_m,
            }
        )

    def goodbye(self, subscriber: Subscriber) -> None:
        """Let a subscriber go."""
        self.subscribers.discard(subscriber)
        self.map_frames_dropped += subscriber.map_frames_dropped
        self.too_slow += subscriber.too_slow.is_set()

    def beat(self) -> None:
        """Take in what has happened since the last beat, and tell it."""
        self.beats += 1
        for tick in self.tap.fetch():
            self._take(tick)
        for notice in self.bulletin.fetch():
            self._tell_of(notice)
        for subscriber in self.subscribers:
            if subscriber.due("map", self.beats):
                subscriber.offer_map()

    def _take(self, tick: Tick) -> None:
        self.map.take(tick)

    def _tell_of(self, notice: Notice) -> None:
        if notice.change is not None:
            self._publish("changes", {"change": notice.change})
        if notice.about is not None:
            self._publish("changes", {"about": notice.about})

    def _publish(self, channel: str, message: Mapping[str, Any]) -> None:
        """Send one message to all who subscribe to a channel."""
        text = None
        for subscriber in self.subscribers:
            if channel in subscriber.wishes:
                text = text or json.dumps({"channel": channel, **message})
                subscriber.post(text)


async def beating(live_of: Any) -> None:
    """Beat for as long as a server runs; `live_of` gives the live views once there are any."""
    while True:
        await asyncio.sleep(1.0 / BEATS_A_SECOND)
        live = live_of()
        if live is None:
            continue
        try:
            live.beat()
        except Exception:
            # What operators see may be incomplete then; the world is not touched by it.
            log.exception("live views failed")

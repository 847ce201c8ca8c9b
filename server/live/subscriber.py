"""A subscriber is a console with an open socket: what it wants, and what waits for it."""

import asyncio
import json
from collections import deque
from collections.abc import Mapping
from typing import Any, Final

from esplanade.server.live.map_feed import MapFeed
from esplanade.server.live.subscriptions import (
    MOST_SUBSCRIPTIONS,
    MapWish,
    Unsubscribe,
    Wish,
    WishError,
)

MOST_WAITING: Final = 256
"""Messages that may wait for a console that reads slowly; with one more it is closed."""

EARLY: Final = 0.8
"""After this part of its period a subscription may have its turn."""


class Subscriber:
    """The wishes of one console, and what it was not sent yet, on the private port's thread."""

    def __init__(self, *, names: bool) -> None:
        self.names = names
        """Whether it is told the names of people."""
        self.wishes: dict[str, Wish] = {}
        self.missing: set[str] = set()
        """Channels of actors that it was told are not there."""
        self._last: dict[str, int] = {}
        """The beat in which each subscription had its turn last."""
        self.too_slow = asyncio.Event()
        self.map_frames_dropped = 0
        self._messages: deque[str] = deque()
        self._map_due = False
        self._map_tick = 0
        """The tick of the map that it was sent last; 0 before the first."""
        self._wake = asyncio.Event()

    @property
    def waiting(self) -> int:
        """Messages that wait to be written."""
        return len(self._messages)

    def take(self, wish: Wish | Unsubscribe) -> None:
        """Take in what its client wants.

        Raises
        ------
        WishError
            It has too many subscriptions.
        """
        if isinstance(wish, Unsubscribe):
            self.wishes.pop(wish.unsubscribe, None)
            return
        channel = wish.subscribe
        if channel not in self.wishes and len(self.wishes) >= MOST_SUBSCRIPTIONS:
            text = f"{MOST_SUBSCRIPTIONS} subscriptions are possible"
            raise WishError(channel, "too_many", text)
        self.wishes[channel] = wish
        self._last.pop(channel, None)
        self.missing.discard(channel)
        if isinstance(wish, MapWish):
            self._map_tick = 0
            self.offer_map()

    def ready(self, channel: str, beat: int) -> bool:
        """Whether it is the turn of a subscription at this beat; asking takes the turn.

        What comes from ticks may come a beat early, and is not left out for that.
        """
        wish = self.wishes.get(channel)
        if wish is None:
            return False
        if beat - self._last.get(channel, -MOST_WAITING) < round(EARLY * wish.period()):
            return False
        self._last[channel] = beat
        return True

    def post(self, text: str) -> None:
        """Send a message that must not be lost; with too many it counts as too slow."""
        if len(self._messages) >= MOST_WAITING:
            self.too_slow.set()
            return
        self._messages.append(text)
        self._wake.set()

    def tell(self, message: Mapping[str, Any]) -> None:
        """Send a message that is its alone."""
        self.post(json.dumps(message))

    def offer_map(self) -> None:
        """Send the map when the last frame of it is written; two that wait become one."""
        self.map_frames_dropped += self._map_due
        self._map_due = True
        self._wake.set()

    async def next(self, feed: MapFeed) -> list[str | bytes]:
        """Wait for something to send, and take it; the map is packed at the last moment."""
        while not self._messages and not self._map_due:
            self._wake.clear()
            await self._wake.wait()
        if self._messages:
            return [self._messages.popleft()]
        self._map_due = False
        if "map" not in self.wishes:
            return []
        text, block = feed.since(self._map_tick, names=self.names)
        self._map_tick = feed.tick
        return [each for each in (text, block) if each is not None]

"""Events that wait until the script asks for them."""

import asyncio
from collections import deque
from typing import Final

from esplanade.bots.events import Event, SnapshotEvent, StepsEvent

CAPACITY: Final = 1024
"""About fifty seconds of snapshots."""


class Mailbox:
    """A bounded queue of events with one reader.

    When it is full, the oldest snapshot or steps go; if none wait, the oldest event. `dropped`
    counts them. A mailbox that was closed still hands out what waits in it.
    """

    def __init__(self, capacity: int = CAPACITY) -> None:
        self.dropped = 0
        self._capacity = capacity
        self._events: deque[Event] = deque()
        self._changed = asyncio.Event()
        self._closed = False

    def put(self, event: Event) -> None:
        """Add an event without ever waiting."""
        if len(self._events) >= self._capacity:
            self._drop_one()
        self._events.append(event)
        self._changed.set()

    def close(self) -> None:
        """Nothing more will come."""
        self._closed = True
        self._changed.set()

    async def get(self) -> Event | None:
        """The oldest event; waits for one; None once closed and empty."""
        while not self._events:
            if self._closed:
                return None
            self._changed.clear()
            await self._changed.wait()
        return self._events.popleft()

    def _drop_one(self) -> None:
        self.dropped += 1
        for index, event in enumerate(self._events):
            if isinstance(event, SnapshotEvent | StepsEvent):
                del self._events[index]
                return
        self._events.popleft()

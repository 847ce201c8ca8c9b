"""Finds routes for people in a thread of its own, so that no tick waits for them."""

import asyncio
from collections.abc import Callable
from concurrent.futures import Executor

import structlog

from esplanade.protocol.messages import WalkTo
from esplanade.server.world.routes import Route
from esplanade.server.world.zone import Zone

log = structlog.get_logger(__name__)

Found = Callable[[int, WalkTo, Route | None], None]
"""It is called with the avatar's id, its wish, and the route; None where there is no route."""


class RouteRequests:
    """Keeps the latest wish of each person and searches in the order in which people asked."""

    def __init__(self, world: Zone, thread: Executor) -> None:
        self._world = world
        self._thread = thread
        self._wishes: dict[int, WalkTo] = {}
        self._wanted = asyncio.Event()

    @property
    def waiting(self) -> int:
        return len(self._wishes)

    def ask(self, avatar_id: int, wish: WalkTo) -> None:
        self._wishes[avatar_id] = wish
        self._wanted.set()

    def forget(self, avatar_id: int) -> None:
        """Drop the wish of a person who wants something else, or is gone."""
        self._wishes.pop(avatar_id, None)

    async def run(self, found: Found) -> None:
        """Find routes until cancelled."""
        while True:
            await self._wanted.wait()
            while self._wishes:
                await self._next(found)
            self._wanted.clear()

    async def _next(self, found: Found) -> None:
        avatar_id, wish = next(iter(self._wishes.items()))
        loop = asyncio.get_running_loop()
        start = loop.time()
        goal = (wish.x, wish.y, wish.z)
        try:
            find = self._world.route_finder(avatar_id, goal)
            route = await loop.run_in_executor(self._thread, find)
        except Exception:
            log.exception("no route found because of a fault", id=avatar_id, goal=goal)
            route = None
        # While the route was sought, the person may have changed their mind.
        latest = self._wishes.pop(avatar_id, None)
        if latest is wish:
            found(avatar_id, wish, route)
        elif latest is not None:
            # It goes behind the others: changing one's mind often delays nobody else.
            self._wishes[avatar_id] = latest
        # Resting as long as it worked, this never takes more than half a core from the actors.
        await asyncio.sleep(loop.time() - start)

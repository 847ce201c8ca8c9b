"""Finds ways for people in a thread of its own, so that no tick waits for them."""

import asyncio
from collections.abc import Callable
from concurrent.futures import Executor

import structlog

from esplanade.protocol.messages import WalkTo
from esplanade.server.world.routes import Route
from esplanade.server.world.world import World

log = structlog.get_logger(__name__)

Found = Callable[[int, WalkTo, Route | None], None]
"""Called with the avatar's id, its wish, and the way; None where no way leads."""


class RouteRequests:
    """One wish a person, the latest; taken up one by one in the order in which people asked."""

    def __init__(self, world: World, thread: Executor) -> None:
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
        """The person wants something else, or is gone."""
        self._wishes.pop(avatar_id, None)

    async def run(self, found: Found) -> None:
        """Find ways until cancelled."""
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
            way = await loop.run_in_executor(self._thread, find)
        except Exception:
            log.exception("no way found because of a fault", id=avatar_id, goal=goal)
            way = None
        # While the way was sought, the person may have changed their mind.
        latest = self._wishes.pop(avatar_id, None)
        if latest is wish:
            found(avatar_id, wish, way)
        elif latest is not None:
            # Behind the others: whoever changes their mind all the time keeps nobody waiting.
            self._wishes[avatar_id] = latest
        # Resting as long as it worked, this never takes more than half a core from the actors.
        await asyncio.sleep(loop.time() - start)

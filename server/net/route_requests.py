"""Finds routes for people in a thread of its own; no tick waits for it, and nobody for others."""

import asyncio
import math
from collections import OrderedDict
from collections.abc import Callable, Set
from concurrent.futures import Executor
from time import thread_time
from typing import Final, NamedTuple

import structlog

from esplanade.planning import MovedEnd
from esplanade.protocol import ErrorCode, ProtocolError
from esplanade.protocol.messages import WalkTo
from esplanade.server.net.fair_queue import Asker, FairQueue
from esplanade.server.net.search_budget import REQUEST_S, SearchBudget, Share
from esplanade.server.world.routes import Route, RouteSearch
from esplanade.server.world.zone import Zone

LONG_SEARCHES: Final = 3
"""Searches of more than one piece that are under way at once, each of another address."""

ALL_SEARCHES: Final = Share(0.5, 0.1)
"""Time of all searches together: half a core, so that actors have the rest, after a short burst."""

log = structlog.get_logger(__name__)

Found = Callable[[int, WalkTo, Route | None, MovedEnd | None], None]
"""It is called with the avatar's id, its wish, the route, None where there is none, and how the
goal was moved."""


class _Job(NamedTuple):
    asker: Asker
    wish: WalkTo
    search: RouteSearch


class RouteRequests:
    """Keeps the latest wish of each person, and searches for all of them piece by piece.

    Addresses take turns, and so do the people of one address. The first piece of a search is done
    as soon as it is the person's turn: short searches end with it. Those that go on wait for a
    place among `LONG_SEARCHES`, whose pieces alternate with first pieces, and with those of other
    addresses first. So a short search waits for no long one, and beside one other address, however
    much that wants, every second piece of work is for the only search of somebody else.
    """

    def __init__(self, world: Zone, thread: Executor, budget: SearchBudget) -> None:
        self._world = world
        self._thread = thread
        self._budget = budget
        self._wishes: FairQueue[WalkTo] = FairQueue()
        self._long: FairQueue[_Job] = FairQueue()
        self._under_way: OrderedDict[str, _Job] = OrderedDict()
        self._latest: dict[int, WalkTo] = {}
        """The wish of each person that is to be answered, whatever stage it is at."""
        self._wanted = asyncio.Event()
        self._time = ALL_SEARCHES.bucket(0.0)
        self.refused = 0
        """Requests that were refused because searches had cost too much."""
        self.search_s = 0.0
        """Processor seconds of all searches."""

    @property
    def waiting(self) -> int:
        """People who wait for an answer."""
        return len(self._latest)

    def ask(self, asker: Asker, wish: WalkTo) -> None:
        """Seek a route for a person, in place of the one that they wanted before.

        Raises
        ------
        ProtocolError
            This person's searches, or those of their address, have cost too much of late. The text
            says when to ask again; the connection goes on.
        """
        now = asyncio.get_running_loop().time()
        wait_s = self._budget.wait_s(asker, now)
        if wait_s > 0.0:
            self.refused += 1
            text = f"walk_to: too many routes to find; ask again in {math.ceil(10 * wait_s) / 10} s"
            raise ProtocolError(ErrorCode.FLOODING, text, None)
        self._budget.spend(asker, REQUEST_S, now)
        self._long.discard(asker.avatar_id)
        self._latest[asker.avatar_id] = wish
        self._wishes.put(asker, wish)
        self._wanted.set()

    def forget(self, avatar_id: int) -> None:
        """Drop the wish of a person who wants something else, or is gone."""
        self._latest.pop(avatar_id, None)
        self._wishes.discard(avatar_id)
        self._long.discard(avatar_id)

    def forget_all(self, avatar_ids: Set[int]) -> None:
        """Drop the wishes of many people."""
        for avatar_id in self._latest.keys() & avatar_ids:
            self.forget(avatar_id)

    async def run(self, found: Found) -> None:
        """Find routes until cancelled."""
        while True:
            await self._wanted.wait()
            self._wanted.clear()
            while self._wishes or self._long or self._under_way:
                served = await self._first_piece(found)
                await self._next_piece(found, served)

    async def _first_piece(self, found: Found) -> str | None:
        """Begin the search whose turn it is, if any; the address that this was for."""
        turn = self._wishes.pop()
        if turn is None:
            return None
        asker, wish = turn
        try:
            goal = wish.x, wish.y, wish.z
            search = self._world.route_search(asker.avatar_id, goal, strict=wish.strict)
        except Exception:
            log.exception("no route found because of a fault", id=asker.avatar_id)
            self._answer(asker.avatar_id, wish, None, None, found)
            return asker.address
        job = _Job(asker, wish, search)
        if not await self._piece(job, found):
            self._long.put(asker, job)
        return asker.address

    async def _next_piece(self, found: Found, served: str | None) -> None:
        """Go on with a long search, of another address than was just served if there is one."""
        while len(self._under_way) < LONG_SEARCHES and self._long:
            turn = self._long.pop(but_for=self._under_way)
            if turn is None:
                break
            self._under_way[turn[0].address] = turn[1]
        if not self._under_way:
            return
        first = next(iter(self._under_way))
        address = next((one for one in self._under_way if one != served), first)
        job = self._under_way.pop(address)
        if not await self._piece(job, found):
            self._under_way[address] = job

    async def _piece(self, job: _Job, found: Found) -> bool:
        """Do a piece of a search, if it is still wanted; whether that was all of it."""
        avatar_id = job.asker.avatar_id
        if self._latest.get(avatar_id) is not job.wish:
            return True
        loop = asyncio.get_running_loop()
        start = loop.time()
        route: Route | None = None
        try:
            over, seconds = await loop.run_in_executor(self._thread, _timed, job.search.advance)
            route = job.search.route
        except Exception:
            log.exception("no route found because of a fault", id=avatar_id, goal=job.wish)
            over, seconds = True, 0.0
        self.search_s += seconds
        self._budget.spend(job.asker, seconds, loop.time())
        if over:
            self._answer(avatar_id, job.wish, route, job.search.moved, found)
        now = loop.time()
        self._time.spend(now, now - start)
        if (rest_s := self._time.debt_s(now)) > 0.0:
            await asyncio.sleep(rest_s)
        return over or self._latest.get(avatar_id) is not job.wish

    def _answer(
        self,
        avatar_id: int,
        wish: WalkTo,
        route: Route | None,
        moved: MovedEnd | None,
        found: Found,
    ) -> None:
        # While the route was sought, the person may have changed their mind.
        if self._latest.get(avatar_id) is wish:
            del self._latest[avatar_id]
            found(avatar_id, wish, route, moved)


def _timed(work: Callable[[], bool]) -> tuple[bool, float]:
    """Do some work; return its result and the processor seconds that it took in this thread."""
    start = thread_time()
    return work(), thread_time() - start

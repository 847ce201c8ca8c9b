"""Requests for routes: their order, their budget, and what is done with those that are outdated."""

import asyncio
from collections.abc import AsyncIterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import asynccontextmanager
from threading import Event
from typing import cast

import pytest

from esplanade.planning import MovedEnd
from esplanade.protocol import ErrorCode, ProtocolError
from esplanade.protocol.messages import WalkTo
from esplanade.server.net.fair_queue import Asker
from esplanade.server.net.route_requests import RouteRequests
from esplanade.server.net.search_budget import SearchBudget, Share
from esplanade.server.world.routes import Point, Route
from esplanade.server.world.zone import Zone
from tests.patience import PATIENCE_S

Answer = tuple[int, int, Route | None]


class ScriptedSearch:
    """Takes as many pieces as its goal's y says, once the test lets it; fails where x < 0."""

    def __init__(self, world: "ScriptedWorld", avatar_id: int, goal: Point) -> None:
        self.route: Route | None = None
        self.moved: MovedEnd | None = None
        self._world = world
        self._avatar_id = avatar_id
        self._goal = goal
        self._left = int(goal[1])

    def advance(self) -> bool:
        assert self._world.go.wait(PATIENCE_S)
        self._world.pieces.append(self._avatar_id)
        if self._goal[0] < 0.0:
            raise RuntimeError("told to fail")
        self._left -= 1
        self.route = (self._goal,)
        return self._left <= 0


class ScriptedWorld:
    def __init__(self) -> None:
        self.go = Event()
        self.pieces: list[int] = []
        """The avatar whose search each piece belonged to."""

    def route_search(self, avatar_id: int, goal: Point, *, strict: bool = False) -> ScriptedSearch:
        return ScriptedSearch(self, avatar_id, goal)


class Asking:
    """Requests to a scripted world; addresses are letters, pieces the length of a search."""

    def __init__(self, thread: ThreadPoolExecutor, budget: SearchBudget) -> None:
        self.world = ScriptedWorld()
        self.requests = RouteRequests(cast(Zone, self.world), thread, budget)
        self.answers: list[Answer] = []
        self._changed = asyncio.Event()

    def ask(self, address: str, avatar_id: int, pieces: int = 1, x: float = 1.0) -> None:
        self.requests.ask(Asker(address, avatar_id), WalkTo(seq=avatar_id, x=x, y=float(pieces)))

    def found(
        self, avatar_id: int, wish: WalkTo, route: Route | None, moved: MovedEnd | None
    ) -> None:
        self.answers.append((avatar_id, wish.seq, route))
        self._changed.set()

    async def until_answered(self, count: int) -> list[int]:
        """Ids in the order in which they were answered."""
        async with asyncio.timeout(PATIENCE_S):
            while len(self.answers) < count:
                self._changed.clear()
                await self._changed.wait()
        return [avatar_id for avatar_id, *_ in self.answers]


@asynccontextmanager
async def asking(budget: SearchBudget | None = None) -> AsyncIterator[Asking]:
    with ThreadPoolExecutor(1) as thread:
        made = Asking(thread, SearchBudget() if budget is None else budget)
        running = asyncio.create_task(made.requests.run(made.found))
        try:
            yield made
        finally:
            made.world.go.set()
            running.cancel()


async def test_wishes_are_taken_in_turn_the_latest_of_each_person() -> None:
    async with asking() as a:
        a.ask("a", 1)
        await asyncio.sleep(0)
        await asyncio.sleep(0)
        a.ask("a", 2)
        a.ask("a", 3)
        a.ask("a", 1, x=-1.0)
        a.ask("a", 4)
        a.requests.forget(3)
        assert a.requests.waiting == 3
        a.world.go.set()
        assert await a.until_answered(3) == [2, 1, 4]
        assert a.answers[1] == (1, 1, None), "a fault is no route"
        assert a.requests.waiting == 0


async def test_one_person_waits_for_no_crowd_of_another_address() -> None:
    async with asking() as a:
        for avatar_id in range(100):
            a.ask("crowd", avatar_id, pieces=3)
        a.ask("one", 1000, pieces=1)
        a.world.go.set()
        await a.until_answered(1)
        assert a.answers[0][0] == 1000
        assert len(a.world.pieces) <= 5


async def test_a_long_search_alternates_with_those_of_a_crowd() -> None:
    async with asking() as a:
        for avatar_id in range(50):
            a.ask("crowd", avatar_id, pieces=6)
        a.ask("one", 1000, pieces=6)
        a.world.go.set()
        answered = await a.until_answered(2)
        assert 1000 in answered
        # Besides the first pieces of the crowd, no piece of a long search of it comes between.
        assert a.world.pieces.index(1000) <= 3
        last = max(k for k, avatar_id in enumerate(a.world.pieces) if avatar_id == 1000)
        assert last <= 2 * 6 + 3


async def test_short_searches_wait_for_no_long_one() -> None:
    async with asking() as a:
        a.ask("a", 1, pieces=50)
        for avatar_id in range(2, 12):
            a.ask("a", avatar_id)
        a.world.go.set()
        assert await a.until_answered(11) == [*range(2, 12), 1]


async def test_a_new_wish_ends_the_search_for_the_one_before() -> None:
    async with asking() as a:
        a.ask("a", 1, pieces=10**5)
        a.world.go.set()
        async with asyncio.timeout(PATIENCE_S):
            while a.world.pieces.count(1) < 3:  # noqa: ASYNC110 - another thread adds to it
                await asyncio.sleep(0.001)
        a.ask("a", 1, pieces=1, x=2.0)
        await a.until_answered(1)
        assert a.answers == [(1, 1, ((2.0, 1.0, 0.0),))]
        a.ask("a", 2)
        await a.until_answered(2)
        assert a.world.pieces[-1] == 2, "nothing of the first search is left"


async def test_who_has_cost_too_much_is_refused_by_name_and_others_are_not() -> None:
    async with asking(SearchBudget(Share(1e-6, 0.0105), Share(1e-6, 1.0))) as a:
        a.world.go.set()
        for _ in range(11):
            a.ask("a", 1)
        with pytest.raises(ProtocolError) as refusal:
            a.ask("a", 1)
        fault = refusal.value
        assert (fault.code, fault.close) == (ErrorCode.FLOODING, None)
        assert "walk_to" in fault.text
        assert "ask again in" in fault.text
        assert a.requests.refused == 1
        a.ask("a", 2)
        assert 2 in await a.until_answered(2)


async def test_an_address_that_has_cost_too_much_is_refused_as_a_whole() -> None:
    async with asking(SearchBudget(Share(1e-6, 1.0), Share(1e-6, 0.0105))) as a:
        a.world.go.set()
        for avatar_id in range(11):
            a.ask("a", avatar_id)
        with pytest.raises(ProtocolError, match="ask again in"):
            a.ask("a", 11)
        a.ask("b", 5000)
        await a.until_answered(1)


async def test_work_is_charged_to_who_caused_it() -> None:
    async with asking() as a:
        a.world.go.set()
        a.ask("a", 1, pieces=20)
        await a.until_answered(1)
        assert a.requests.search_s > 0.0


async def test_all_searches_together_rest_as_long_as_they_work(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    clock, rested = [0.0], []

    async def rest(seconds: float) -> None:
        rested.append(seconds)
        clock[0] += seconds

    def work(search: ScriptedSearch) -> bool:
        clock[0] += 0.02
        search._left -= 1
        return search._left <= 0

    async with asking() as a:
        monkeypatch.setattr(ScriptedSearch, "advance", work)
        monkeypatch.setattr(asyncio.get_running_loop(), "time", lambda: clock[0])
        monkeypatch.setattr("esplanade.server.net.route_requests.asyncio.sleep", rest)
        a.ask("a", 1, pieces=100)
        while not a.answers:
            await asyncio.wait([asyncio.ensure_future(asyncio.to_thread(lambda: None))])
        monkeypatch.undo()
    assert sum(rested) == pytest.approx(100 * 0.02, abs=2 * 0.1 + 0.05)

import asyncio
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from threading import Event
from typing import cast

from esplanade.protocol.messages import WalkTo
from esplanade.server.net.route_requests import RouteRequests
from esplanade.server.world.routes import Point, Route
from esplanade.server.world.zone import Zone
from tests.patience import PATIENCE_S

Answer = tuple[int, int, Route | None]


class SlowWorld:
    """Finds a way when the test lets it."""

    def __init__(self) -> None:
        self.go = Event()

    def route_finder(self, avatar_id: int, goal: Point) -> Callable[[], Route | None]:
        def find() -> Route | None:
            assert self.go.wait(PATIENCE_S)
            if goal[0] < 0.0:
                raise RuntimeError("told to fail")
            return (goal,)

        return find


async def test_who_changes_their_mind_all_the_time_keeps_nobody_waiting() -> None:
    world, answered = SlowWorld(), asyncio.Event()
    world.go.set()
    asked: list[int] = []
    with ThreadPoolExecutor(1) as thread:
        route_requests = RouteRequests(cast(Zone, world), thread)

        def change_minds(avatar_id: int, goal: Point) -> Callable[[], Route | None]:
            asked.append(avatar_id)
            route_requests.ask(1, WalkTo(seq=len(asked), x=1.0, y=0.0))
            return lambda: (goal,)

        world.route_finder = change_minds  # type: ignore[method-assign]
        route_requests.ask(1, WalkTo(seq=0, x=1.0, y=0.0))
        route_requests.ask(2, WalkTo(seq=0, x=2.0, y=0.0))
        running = asyncio.create_task(route_requests.run(lambda *_: answered.set()))
        async with asyncio.timeout(PATIENCE_S):
            await answered.wait()
        running.cancel()
    assert asked[:2] == [1, 2]


async def test_wishes_are_taken_in_turn_the_latest_of_each_person() -> None:
    world, answers, done = SlowWorld(), [], asyncio.Event()

    def found(avatar_id: int, wish: WalkTo, way: Route | None) -> None:
        answers.append((avatar_id, wish.seq, way))
        if len(answers) == 3:
            done.set()

    with ThreadPoolExecutor(1) as thread:
        route_requests = RouteRequests(cast(Zone, world), thread)
        running = asyncio.create_task(route_requests.run(found))
        route_requests.ask(1, WalkTo(seq=1, x=1.0, y=0.0))
        await asyncio.sleep(0)
        route_requests.ask(2, WalkTo(seq=1, x=2.0, y=0.0))
        route_requests.ask(3, WalkTo(seq=1, x=3.0, y=0.0))
        route_requests.ask(1, WalkTo(seq=2, x=-1.0, y=0.0))
        route_requests.ask(4, WalkTo(seq=1, x=4.0, y=0.0))
        route_requests.forget(3)
        assert route_requests.waiting == 3
        world.go.set()
        async with asyncio.timeout(PATIENCE_S):
            await done.wait()
        running.cancel()
    assert answers == [(2, 1, ((2.0, 0.0, 0),)), (4, 1, ((4.0, 0.0, 0),)), (1, 2, None)]
    assert route_requests.waiting == 0

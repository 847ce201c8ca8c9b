import asyncio
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from threading import Event
from typing import cast

from protocol.messages import WalkTo
from server.net.guidance import Guidance
from server.world.ways import Point, Way
from server.world.world import World

Answer = tuple[int, int, Way | None]


class SlowWorld:
    """Finds a way when the test lets it."""

    def __init__(self) -> None:
        self.go = Event()

    def way_finder(self, avatar_id: int, goal: Point) -> Callable[[], Way | None]:
        def find() -> Way | None:
            assert self.go.wait(20.0)
            if goal[0] < 0.0:
                raise RuntimeError("told to fail")
            return (goal,)

        return find


async def test_who_changes_their_mind_all_the_time_keeps_nobody_waiting() -> None:
    world, answered = SlowWorld(), asyncio.Event()
    world.go.set()
    asked: list[int] = []
    with ThreadPoolExecutor(1) as thread:
        guidance = Guidance(cast(World, world), thread)

        def change_minds(avatar_id: int, goal: Point) -> Callable[[], Way | None]:
            asked.append(avatar_id)
            guidance.ask(1, WalkTo(seq=len(asked), x=1.0, y=0.0))
            return lambda: (goal,)

        world.way_finder = change_minds  # type: ignore[method-assign]
        guidance.ask(1, WalkTo(seq=0, x=1.0, y=0.0))
        guidance.ask(2, WalkTo(seq=0, x=2.0, y=0.0))
        running = asyncio.create_task(guidance.run(lambda *_: answered.set()))
        async with asyncio.timeout(20.0):
            await answered.wait()
        running.cancel()
    assert asked[:2] == [1, 2]


async def test_wishes_are_taken_in_turn_the_latest_of_each_person() -> None:
    world, answers, done = SlowWorld(), [], asyncio.Event()

    def found(avatar_id: int, wish: WalkTo, way: Way | None) -> None:
        answers.append((avatar_id, wish.seq, way))
        if len(answers) == 3:
            done.set()

    with ThreadPoolExecutor(1) as thread:
        guidance = Guidance(cast(World, world), thread)
        running = asyncio.create_task(guidance.run(found))
        guidance.ask(1, WalkTo(seq=1, x=1.0, y=0.0))
        await asyncio.sleep(0)
        guidance.ask(2, WalkTo(seq=1, x=2.0, y=0.0))
        guidance.ask(3, WalkTo(seq=1, x=3.0, y=0.0))
        guidance.ask(1, WalkTo(seq=2, x=-1.0, y=0.0))
        guidance.ask(4, WalkTo(seq=1, x=4.0, y=0.0))
        guidance.forget(3)
        assert guidance.waiting == 3
        world.go.set()
        async with asyncio.timeout(20.0):
            await done.wait()
        running.cancel()
    assert answers == [(2, 1, ((2.0, 0.0, 0),)), (4, 1, ((4.0, 0.0, 0),)), (1, 2, None)]
    assert guidance.waiting == 0

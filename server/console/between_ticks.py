"""Questions that can only be asked between two ticks, and those who wait for a tick to end."""

import asyncio
from collections import deque
from collections.abc import Callable
from typing import Any, Final, TypeVar

from esplanade.server.console.refusals import RefusedError
from esplanade.server.world.zone import Zone

Result = TypeVar("Result")
MOST_QUESTIONS: Final = 64
"""Questions that may wait for the end of a tick; more are refused."""
PATIENCE_S: Final = 30.0
"""A question that was not answered after this time is refused."""


class BetweenTicks:
    """Answers questions when the zone stands between two ticks, and tells when a tick is over."""

    def __init__(self, zone: Zone) -> None:
        self._zone = zone
        self._questions: deque[tuple[Callable[[], Any], asyncio.Future[Any]]] = deque()
        self._awaited: list[tuple[int, asyncio.Future[int]]] = []

    async def ask(self, question: Callable[[], Result]) -> Result:
        """The answer to a question about the zone that can only be asked between two ticks.

        Raises
        ------
        RefusedError
            Too many questions wait, or the world does not tick.
        """
        if len(self._questions) >= MOST_QUESTIONS:
            raise RefusedError.of("busy", f"{MOST_QUESTIONS} questions wait already")
        future: asyncio.Future[Result] = asyncio.get_running_loop().create_future()
        self._questions.append((question, future))
        try:
            async with asyncio.timeout(PATIENCE_S):
                return await future
        except TimeoutError:
            raise RefusedError.of("busy", "the world does not answer") from None

    def answer(self) -> None:
        """Answer the questions that wait; call it between two ticks."""
        for _ in range(len(self._questions)):
            question, future = self._questions.popleft()
            if future.done():
                continue
            try:
                future.set_result(question())
            except Exception as error:  # noqa: BLE001 - it is raised where it was asked
                future.set_exception(error)

    async def after_tick(self, due: int) -> int:
        """Wait until that tick is over; returns the one that is over then."""
        if self._zone.tick >= due:
            return self._zone.tick
        future: asyncio.Future[int] = asyncio.get_running_loop().create_future()
        self._awaited.append((due, future))
        return await future

    def ticked(self, tick: int) -> None:
        """That tick is over."""
        if not self._awaited:
            return
        over = [future for due, future in self._awaited if due <= tick]
        self._awaited = [one for one in self._awaited if one[0] > tick]
        for ended in over:
            if not ended.done():
                ended.set_result(tick)

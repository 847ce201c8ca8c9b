"""Traces of decisions that consoles ask for, made in the actors' thread when a tick is over."""

import time
from collections import deque
from concurrent.futures import Future
from dataclasses import dataclass
from typing import Final

import structlog

from esplanade.actors.blockers import Blocker
from esplanade.actors.traces import Trace
from esplanade.server.world.zone import Zone

MOST_WAITING: Final = 16
"""Requests that may wait for their turn; one more is refused."""
ROOM_S: Final = 0.01
"""A trace is made when the next tick is due in this time or later."""
MOST_PASSED: Final = 10
"""After so many ticks that left no such time it is made all the same."""
KEPT_FOR_S: Final = 60.0
"""After a request ticks keep what is decided for so long, so that the next one has it at once."""

log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True)
class Traced:
    """A decision of an actor, and what was asked of the zone beside it."""

    tick: int
    trace: Trace
    blocker: Blocker | None
    seconds: float
    """The time that it took."""


class TooManyError(Exception):
    """The queue of requests is full."""


class Traces:
    """Requests for traces; `ask` is safe in any thread, the rest is for those who run the ticks."""

    def __init__(self, zone: Zone) -> None:
        self._zone = zone
        self._waiting: deque[tuple[int, Future[Traced | None]]] = deque()
        self._asked_s = -KEPT_FOR_S
        self._passed = 0
        self.watched = False
        """Whether a console is open, which may ask or look at costs at any time."""
        self.made = 0
        self.seconds = 0.0
        """Time that all traces have taken so far."""
        self.refused = 0

    @property
    def waiting(self) -> int:
        """Requests that wait."""
        return len(self._waiting)

    def ask(self, avatar_id: int) -> "Future[Traced | None]":
        """Ask for the last decision of an actor, named by its avatar's id.

        The answer is None if nothing is known of it.

        Raises
        ------
        TooManyError
            Too many wait already.
        """
        if len(self._waiting) >= MOST_WAITING:
            self.refused += 1
            raise TooManyError
        self._asked_s = time.monotonic()
        answer: Future[Traced | None] = Future()
        self._waiting.append((avatar_id, answer))
        return answer

    def ticked(self, room_s: float) -> bool:
        """Note that a tick is over and the next one due in `room_s`; whether to make a trace."""
        if not (self._keeps() and self._waiting):
            return False
        if room_s < ROOM_S and self._passed < MOST_PASSED:
            self._passed += 1
            return False
        self._passed = 0
        return True

    def stood(self) -> bool:
        """The same while the world stands. Requests that no tick will answer are answered now."""
        if not self._keeps():
            while self._waiting:
                _answer(self._waiting.popleft()[1], None)
        return bool(self._waiting)

    def make_one(self) -> None:
        """Make the trace of the actor that was asked for first, for all who still wait for it."""
        asked_for = [self._waiting.popleft() for _ in range(len(self._waiting))]
        waiting = [each for each in asked_for if not each[1].cancelled()]
        if not waiting:
            return
        avatar_id, _ = waiting[0]
        self._waiting.extendleft(reversed([each for each in waiting if each[0] != avatar_id]))
        traced = None
        try:
            traced = self._trace(avatar_id)
        except Exception:
            # An operator's question never ends a world.
            log.exception("a decision cannot be traced", tick=self._zone.tick, avatar=avatar_id)
        for asked, answer in waiting:
            if asked == avatar_id:
                _answer(answer, traced)

    def _keeps(self) -> bool:
        """Let ticks keep what is decided for as long as it may be asked for."""
        recently = time.monotonic() - self._asked_s < KEPT_FOR_S
        return self._zone.keep_decisions(self.watched or recently)

    def _trace(self, avatar_id: int) -> Traced | None:
        if not self._zone.is_actor(avatar_id):
            return None
        begun_s = time.perf_counter()
        trace = self._zone.trace(avatar_id)
        if trace is None:
            return None
        blocker = self._zone.blocker(avatar_id)
        seconds = time.perf_counter() - begun_s
        self.made += 1
        self.seconds += seconds
        return Traced(self._zone.decided_tick, trace, blocker, seconds)


def _answer(answer: "Future[Traced | None]", traced: Traced | None) -> None:
    if answer.set_running_or_notify_cancel():
        answer.set_result(traced)

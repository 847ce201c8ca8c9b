"""Derives what doors and commands change, in a thread of its own, so that no tick waits for it."""

from collections import deque
from collections.abc import Callable, Iterable
from concurrent.futures import Executor, Future
from functools import partial
from time import perf_counter
from typing import Final

import structlog

from esplanade.actors.potential_pool import RenewedPotential
from esplanade.server.world.helped import taken_s
from esplanade.server.world.inputs import DerivedInput, DoorDerived, PotentialDerived
from esplanade.server.world.zone import Zone

DOOR_PAUSE_S: Final = 0.5
"""A door is moved no more often than this; of the wishes that come meanwhile the last counts."""

log = structlog.get_logger(__name__)


class GroundWork:
    """Derives one thing at a time: for doors, for commands on actors, and potentials take turns.

    From now on doors of the world move by the inputs that `drain` returns, and no other way. After
    each piece of work it rests for as much processor time as that took, so that actors have the
    other half of a core, on a busy machine too. Where there is nothing else to do it does the work
    that is `ahead`, one by one; nothing waits for a rest after that.
    """

    def __init__(
        self, world: Zone, thread: Executor, ahead: Iterable[Callable[[], None]] = ()
    ) -> None:
        self._world = world
        self._thread = thread
        self._ahead = deque(ahead)
        self._work: Future[tuple[DerivedInput | None, float]] | None = None
        self._was_ahead = False
        self._rests_until_s = 0.0
        self._kinds: deque[Callable[[], Callable[[], DerivedInput] | None]] = deque(
            [self._door, world.actor_work, self._potential]
        )
        """Kinds of work, the one whose turn it is first."""
        self._begun_at_s: dict[str, float] = {}
        world.derive_outside()

    def drain(self) -> list[DerivedInput]:
        """Return the inputs derived since the last call. Call it between two ticks."""
        done: list[DerivedInput] = []
        if self._work is not None and self._work.done():
            try:
                derived, seconds = self._work.result()
                if derived is not None:
                    done.append(derived)
                self._rests_until_s = perf_counter() + seconds
            except Exception:
                log.exception("the ground cannot be derived because of a fault")
            self._work = None
        if self._work is None and not done:
            rested = perf_counter() >= self._rests_until_s
            if rested or self._was_ahead:
                self._begin(rested=rested)
        return done

    def _begin(self, *, rested: bool) -> None:
        for _ in range(len(self._kinds)):
            next_work = self._kinds.popleft()
            self._kinds.append(next_work)
            derive = next_work()
            if derive is not None:
                self._work = self._thread.submit(_timed, derive)
                self._was_ahead = False
                return
        if self._ahead and rested:
            self._was_ahead = True
            self._work = self._thread.submit(_timed, self._ahead.popleft())

    def _door(self) -> Callable[[], DerivedInput] | None:
        door = self._next_door()
        if door is None:
            return None
        self._begun_at_s[door[0]] = self._now_s()
        return partial(_door, self._world, *door)

    def _potential(self) -> Callable[[], DerivedInput] | None:
        derive = self._world.outdated_potential()
        return None if derive is None else partial(_potential, derive)

    def _next_door(self) -> tuple[str, bool] | None:
        latest_s = self._now_s() - DOOR_PAUSE_S
        for name, is_open in self._world.doors.due():
            if self._begun_at_s.get(name, latest_s) <= latest_s:
                return name, is_open
        return None

    def _now_s(self) -> float:
        return self._world.tick * self._world.tick_s


def _door(world: Zone, name: str, is_open: bool) -> DerivedInput:
    return DoorDerived(world.doors.prepare(name, is_open))


def _potential(derive: Callable[[], RenewedPotential]) -> DerivedInput:
    return PotentialDerived(derive())


def _timed(work: Callable[[], DerivedInput | None]) -> tuple[DerivedInput | None, float]:
    """The result of some work, and the seconds of processor time that it took."""
    start = taken_s()
    return work(), taken_s() - start

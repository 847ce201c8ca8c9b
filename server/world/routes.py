"""Ways for people who want to walk to a point; found a few at a time, beside the planning."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from planning import LayeredGrid, Potential
from server.world.inputs import Seek
from server.world.state import State

ROUTES_PER_TICK: Final = 4
"""Most wave fronts spread in one tick; further wishes wait for their turn."""


@dataclass(frozen=True, slots=True)
class Route:
    """The way to a goal from wherever one is."""

    goal: tuple[float, float]
    layer: int
    potential: Potential


class Routes:
    """One wish per person, the latest; taken up in the order in which people first asked."""

    def __init__(self, state: State, grid: LayeredGrid, clearance_m: float) -> None:
        self._state = state
        self._grid = grid
        self._clearance_m = clearance_m
        self._wishes: dict[int, Seek] = {}
        self._answers: list[tuple[Seek, Route | None]] = []

    @property
    def waiting(self) -> int:
        return len(self._wishes)

    def ask(self, wish: Seek) -> None:
        self._wishes[wish.id] = wish

    def forget(self, avatar_id: int) -> None:
        """The person has changed their mind or is gone."""
        self._wishes.pop(avatar_id, None)
        self._answers = [answer for answer in self._answers if answer[0].id != avatar_id]

    def work(self) -> None:
        """Find the next few ways. Reads state and grid, which nobody may write meanwhile."""
        for wish in list(self._wishes.values())[:ROUTES_PER_TICK]:
            del self._wishes[wish.id]
            self._answers.append((wish, self._find(wish)))

    def answers(self) -> Iterator[tuple[Seek, Route | None]]:
        """What was found since the last call; None where no way leads."""
        answers, self._answers = self._answers, []
        yield from answers

    def _find(self, wish: Seek) -> Route | None:
        if wish.layer >= self._grid.layers:
            return None
        goal = self._grid.nearest_free(wish.goal, wish.layer, self._clearance_m)
        if goal is None:
            return None
        potential = self._grid.potential(goal, wish.layer, self._clearance_m)
        slot = self._state.slot(wish.id)
        here, layer = self._state.positions[[slot]], self._state.layers[[slot]]
        if not np.isfinite(potential.distance(here, layer)[0]):
            return None
        return Route(goal, wish.layer, potential)

"""How people move: the server decides, within speed and walls."""

import numpy as np

from planning import LayeredGrid
from server.world.inputs import Seek, Steer
from server.world.routes import Route, Routes
from server.world.rules import Rules
from server.world.state import PERSON, State


class People:
    """Moves every person by one tick at a time.

    `velocities` is what a person is trying to do, float (capacity, 2), metres a second.
    """

    def __init__(self, state: State, grid: LayeredGrid, rules: Rules, tick_s: float) -> None:
        self._state = state
        self._grid = grid
        self._rules = rules
        self._tick_s = tick_s
        self._velocities = np.zeros((state.capacity, 2))
        self._following: dict[int, Route] = {}
        self.routes = Routes(state, grid, rules.person_clearance_m)

    def stop(self, slot: int) -> None:
        """Stand still, want nothing."""
        self._velocities[slot] = 0.0
        self._following.pop(slot, None)
        self.routes.forget(int(self._state.ids[slot]))

    def steer(self, slot: int, wish: Steer) -> None:
        """Walk in a direction, no faster than the rules allow."""
        self.stop(slot)
        speed = min(wish.speed_mps, self._rules.person_max_speed_mps)
        angle = wish.direction_rad
        self._velocities[slot] = speed * np.cos(angle), speed * np.sin(angle)

    def seek(self, wish: Seek) -> None:
        """Ask for a way to a point; goes on as before until it is found."""
        self.routes.ask(wish)

    def take_routes(self) -> list[Seek]:
        """Set out on the ways that were found; returns the wishes that no way leads to."""
        refused = []
        for wish, route in self.routes.answers():
            if wish.id not in self._state:
                continue
            slot = self._state.slot(wish.id)
            self._velocities[slot] = 0.0
            if route is None:
                self._following.pop(slot, None)
                refused.append(wish)
            else:
                self._following[slot] = route
        return refused

    def move(self) -> None:
        """Everyone's motion of one tick."""
        state = self._state
        self._head_for_goals()
        people = state.of_kind(PERSON)
        state.speeds[people] = 0.0
        moving = people[self._velocities[people].any(axis=1)]
        if not len(moving):
            return
        before, wanted = state.positions[moving], self._velocities[moving]
        state.positions[moving], state.layers[moving] = self._grid.walk(
            before, state.layers[moving], wanted * self._tick_s, self._rules.person_clearance_m
        )
        state.headings[moving] = np.arctan2(wanted[:, 1], wanted[:, 0])
        moved_m = state.positions[moving] - before
        state.speeds[moving] = np.hypot(moved_m[:, 0], moved_m[:, 1]) / self._tick_s

    def _head_for_goals(self) -> None:
        """Velocities of those who follow a route: downhill, and straight within the last cell."""
        speed = min(self._rules.person_walk_speed_mps, self._rules.person_max_speed_mps)
        for slot, route in list(self._following.items()):
            here = self._state.positions[slot]
            way = np.asarray(route.goal) - here
            remaining_m = float(np.hypot(*way))
            layer = self._state.layers[slot : slot + 1]
            if remaining_m > self._grid.cell_m or layer[0] != route.layer:
                velocity = route.potential.direction(here[None], layer)[0] * speed
            else:
                velocity = way / max(remaining_m / speed, self._tick_s)
            if velocity.any():
                self._velocities[slot] = velocity
            else:
                self.stop(slot)

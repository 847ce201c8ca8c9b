"""How people move: the server decides, within speed and walls."""

from collections import deque
from typing import Final

import numpy as np

from esplanade.actors.locomotion.footsteps.course import AHEAD, AHEAD_S
from esplanade.planning import LayeredGrid
from esplanade.server.world.inputs import Follow, Steer
from esplanade.server.world.routes import Point
from esplanade.server.world.rules import Rules
from esplanade.server.world.state import PERSON, Floats, Slots, State

BLOCKED_TICKS: Final = 20
"""Whoever follows a way and gets nowhere for so long gives it up."""


class People:
    """Moves every person by one tick at a time."""

    def __init__(self, state: State, grid: LayeredGrid, rules: Rules, tick_s: float) -> None:
        self._state = state
        self._grid = grid
        self._rules = rules
        self._tick_s = tick_s
        self._walk_speed_mps = min(rules.person_walk_speed_mps, rules.person_max_speed_mps)
        # What each person is trying to do, by slot: a velocity, or the next point of a way.
        self._velocities = np.zeros((state.capacity, 2))
        self._following = np.zeros(state.capacity, dtype=np.bool_)
        self._targets = np.zeros((state.capacity, 2))
        self._blocked = np.zeros(state.capacity, dtype=np.int64)
        self._ways: dict[int, deque[Point]] = {}

    def stop(self, slot: int) -> None:
        """Stand still, want nothing."""
        self._velocities[slot] = 0.0
        self._following[slot] = False
        self._ways.pop(slot, None)

    def steer(self, slot: int, wish: Steer) -> None:
        """Walk in a direction, no faster than the rules allow."""
        self.stop(slot)
        speed = min(wish.speed_mps, self._rules.person_max_speed_mps)
        angle = wish.direction_rad
        self._velocities[slot] = speed * np.cos(angle), speed * np.sin(angle)

    def follow(self, slot: int, wish: Follow) -> None:
        """Walk along a way to its end."""
        self.stop(slot)
        if wish.way:
            self._ways[slot] = deque(wish.way)
            self._following[slot] = True
            self._blocked[slot] = 0
            self._targets[slot] = wish.way[0][:2]

    def move(self) -> None:
        """Everyone's motion of one tick."""
        state = self._state
        self._head_for_targets()
        people = state.of_kind(PERSON)
        state.speeds[people] = 0.0
        state.ahead[people, :, :2] = state.positions[people, None]
        state.ahead[people, :, 2] = state.heights[people, None]
        moving = people[self._velocities[people].any(axis=1)]
        if not len(moving):
            return
        before, wanted = state.positions[moving], self._velocities[moving]
        state.positions[moving], state.heights[moving] = self._grid.walk(
            before, state.heights[moving], wanted * self._tick_s, self._rules.person_clearance_m
        )
        state.layers[moving] = self._grid.layers_at(state.positions[moving], state.heights[moving])
        state.headings[moving] = np.arctan2(wanted[:, 1], wanted[:, 0])
        moved_m = state.positions[moving] - before
        state.speeds[moving] = np.hypot(moved_m[:, 0], moved_m[:, 1]) / self._tick_s
        self._look_ahead(moving, moved_m)
        self._pass_targets()

    def _look_ahead(self, moving: Slots, moved_m: Floats) -> None:
        """Where those who moved so in this tick, (N, 2), get if they go on, to a last target."""
        state = self._state
        here = state.positions[moving]
        way = (AHEAD_S / self._tick_s * moved_m)[:, None] * np.arange(AHEAD)[:, None]
        left_m = np.hypot(*(self._targets[moving] - here).T)
        last = self._following[moving]
        last[last] = [len(self._ways[slot]) == 1 for slot in moving[last].tolist()]
        length = np.maximum(np.hypot(way[..., 0], way[..., 1]), 1e-9)
        share = np.where(last, left_m, np.inf)[:, None] / length
        way *= np.minimum(share, 1.0)[..., None]
        cells = self._grid.on_ground(here, state.heights[moving])[1]
        state.ahead[moving] = self._grid.with_heights(here[:, None] + way, cells)

    def _head_for_targets(self) -> None:
        """Velocities of those who follow a way; the last step to a point ends on it."""
        slots = np.flatnonzero(self._following)
        ways = self._targets[slots] - self._state.positions[slots]
        remaining_m = np.hypot(ways[:, 0], ways[:, 1])
        seconds = np.maximum(remaining_m / self._walk_speed_mps, self._tick_s)
        self._velocities[slots] = ways / seconds[:, None]

    def _pass_targets(self) -> None:
        """Those at a point of their way turn to the next; those at its end or stuck stop."""
        slots = np.flatnonzero(self._following)
        state = self._state
        wanted = np.hypot(self._velocities[slots, 0], self._velocities[slots, 1])
        stuck = state.speeds[slots] < 0.1 * wanted
        self._blocked[slots] = np.where(stuck, self._blocked[slots] + 1, 0)
        for slot in slots[self._blocked[slots] >= BLOCKED_TICKS].tolist():
            self.stop(slot)
        ways = self._targets[slots] - state.positions[slots]
        for slot in slots[np.hypot(ways[:, 0], ways[:, 1]) < 1e-6].tolist():
            way = self._ways.get(slot)
            if way is None:
                continue
            way.popleft()
            if way:
                self._targets[slot] = way[0][:2]
            else:
                self.stop(slot)

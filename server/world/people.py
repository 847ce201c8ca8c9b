"""Moves people: the server decides, within the limits of speed and walls."""

from collections import deque
from collections.abc import Mapping
from itertools import islice
from typing import Any, Final

import numpy as np

from esplanade.actors import ObservedPeople
from esplanade.actors.locomotion.footsteps.course import AHEAD, AHEAD_S
from esplanade.planning import LayeredGrid
from esplanade.server.world.inputs import Follow, Steer
from esplanade.server.world.route_ahead import CORNERS, RouteAhead
from esplanade.server.world.routes import Point
from esplanade.server.world.rules import Rules
from esplanade.server.world.state import PERSON, Floats, Slots, State

BLOCKED_TICKS: Final = 20
"""A person who follows a route but gets nowhere for this long gives it up."""
AT_CORNER_M: Final = 1e-6
"""A person this near to the next point of a route is there."""
HELD_UP_M: Final = 0.01
"""A person who gets no further so near to that point goes on to the one after it: corners may lie
nearer to barriers than bodies get, by the roundings of a way."""
STUCK_SHARE: Final = 0.1
"""A person who moves by less than this part of what they want gets nowhere."""
ROUNDING_M: Final = 1e-3
"""The distances that ways keep from barriers are exact to this."""
_TIMES: Final = np.arange(AHEAD)[:, None]


class People:
    """Moves every person by one tick at a time."""

    def __init__(self, state: State, grid: LayeredGrid, rules: Rules, tick_s: float) -> None:
        self._state = state
        self._grid = grid
        self._rules = rules
        self._tick_s = tick_s
        self._walk_speed_mps = min(rules.person_walk_speed_mps, rules.person_max_speed_mps)
        # The intention of each person, by slot: a velocity, or the next point of a route.
        self._velocities = np.zeros((state.capacity, 2))
        self._following = np.zeros(state.capacity, dtype=np.bool_)
        self._targets = np.zeros((state.capacity, 2))
        self._blocked = np.zeros(state.capacity, dtype=np.int64)
        self._routes: dict[int, deque[Point]] = {}
        self._route_ahead = RouteAhead(state.capacity)
        self._put: tuple[Slots, Floats] | None = None
        """Those who are put somewhere in this tick, and their places."""

    def stop(self, slot: int) -> None:
        """Stand still, without any intention."""
        self._velocities[slot] = self._targets[slot] = 0.0
        self._following[slot] = False
        self._blocked[slot] = 0
        self._routes.pop(slot, None)

    def steer(self, slot: int, wish: Steer) -> None:
        """Walk in a direction, no faster than the rules allow."""
        self.stop(slot)
        speed = min(wish.speed_mps, self._rules.person_max_speed_mps)
        angle = wish.direction_rad
        self._velocities[slot] = speed * np.cos(angle), speed * np.sin(angle)

    def steer_many(self, slots: Slots, directions_rad: Floats, speeds_mps: Floats) -> None:
        """The same for many people, all different."""
        self._following[slots] = False
        if self._routes:
            for slot in self._routes.keys() & set(slots.tolist()):
                del self._routes[slot]
        speeds = np.minimum(speeds_mps, self._rules.person_max_speed_mps)
        self._velocities[slots, 0] = speeds * np.cos(directions_rad)
        self._velocities[slots, 1] = speeds * np.sin(directions_rad)

    def follow(self, slot: int, wish: Follow) -> None:
        """Walk along a route to its end."""
        self.stop(slot)
        if wish.route:
            self._routes[slot] = deque(wish.route)
            self._following[slot] = True
            self._blocked[slot] = 0
            self._targets[slot] = wish.route[0][:2]
            self._route_ahead.set(slot, wish.route)

    def put(self, slots: Slots, places: Floats) -> None:
        """Stand at places (N, 3) at the end of this tick, without any intention."""
        for slot in slots.tolist():
            self.stop(slot)
        self._put = slots, places

    def save(self) -> dict[str, Any]:
        """The intentions of everyone, as plain data and copies of arrays."""
        people = self._state.of_kind(PERSON)
        on_route = [slot for slot in people.tolist() if slot in self._routes]
        return {
            "velocities": self._velocities[people],
            "following": self._following[people],
            "blocked": self._blocked[people],
            "targets": self._targets[people],
            "routes": [[slot, list(self._routes[slot])] for slot in on_route],
            "corners": self._route_ahead.save(on_route),
        }

    def load(self, saved: Mapping[str, Any]) -> None:
        """Let everyone who is in the state mean to do what was saved.

        Raises
        ------
        ValueError, KeyError, TypeError
            It is not what `save` of these people gives.
        """
        people = self._state.of_kind(PERSON)
        for name, column in (
            ("velocities", self._velocities),
            ("following", self._following),
            ("blocked", self._blocked),
            ("targets", self._targets),
        ):
            rows = np.asarray(saved[name], dtype=column.dtype)
            if rows.shape != (len(people), *column.shape[1:]) or not np.isfinite(rows).all():
                raise ValueError(f"{len(people)} people cannot have such {name}")
            column[people] = rows
        self._routes = {
            int(slot): deque((float(x), float(y), float(z)) for x, y, z in route)
            for slot, route in saved["routes"]
        }
        if not self._routes.keys() <= set(people.tolist()):
            raise ValueError("somebody follows a route who is not there")
        self._route_ahead.load(list(self._routes), saved["corners"])

    def observed(self) -> ObservedPeople:
        """People as actors see them in this tick."""
        people = self._state.of_kind(PERSON)
        places = np.column_stack([self._state.positions[people], self._state.heights[people]])
        return ObservedPeople(self._state.ids[people], places)

    def moves(self, slot: int) -> bool:
        """Whether that person has an intention to move."""
        return bool(self._following[slot] or self._velocities[slot].any())

    def move(self) -> None:
        """Move everyone by one tick."""
        self._walk()
        if self._put is not None:
            self._be_put(*self._put)
            self._put = None

    def _be_put(self, slots: Slots, places: Floats) -> None:
        """Let people be at places (N, 3), facing the way that leads there."""
        state = self._state
        moved_m = places[:, :2] - state.positions[slots]
        state.positions[slots], state.heights[slots] = places[:, :2], places[:, 2]
        cells = self._grid.on_ground(state.positions[slots], state.heights[slots])[1]
        state.layers[slots] = self._grid.layers_of(cells)
        distances_m = np.hypot(moved_m[:, 0], moved_m[:, 1])
        state.speeds[slots] = distances_m / self._tick_s
        turned = distances_m > 0.0
        state.headings[slots[turned]] = np.arctan2(moved_m[turned, 1], moved_m[turned, 0])
        self._look_ahead(slots, moved_m, cells)

    def _walk(self) -> None:
        """Move everyone by what they mean to do."""
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
        held_up = moving[self._following[moving] & (self._blocked[moving] > 0)]
        if len(held_up):
            self._squeeze(held_up, before[np.isin(moving, held_up)])
        cells = self._grid.on_ground(state.positions[moving], state.heights[moving])[1]
        state.layers[moving] = self._grid.layers_of(cells)
        state.headings[moving] = np.arctan2(wanted[:, 1], wanted[:, 0])
        moved_m = state.positions[moving] - before
        state.speeds[moving] = np.hypot(moved_m[:, 0], moved_m[:, 1]) / self._tick_s
        self._look_ahead(moving, moved_m, cells)
        self._pass_targets()

    def _squeeze(self, slots: Slots, before: Floats) -> None:
        """Move people who were held up on their routes once more from where they were, (N, 2).

        Ways keep the distances of bodies to a millimetre, and a passage may be narrower by that.
        Whoever gets no further so either stays where they are.
        """
        state = self._state
        wanted = self._velocities[slots] * self._tick_s
        places, heights = self._grid.walk(
            before, state.heights[slots], wanted, self._rules.person_clearance_m - ROUNDING_M
        )
        moved = np.hypot(*(places - before).T) >= STUCK_SHARE * np.hypot(*wanted.T)
        state.positions[slots[moved]] = places[moved]
        state.heights[slots[moved]] = heights[moved]

    def _look_ahead(self, moving: Slots, moved_m: Floats, cells: Slots) -> None:
        """Write the places of people who go on by (N, 2) a tick, or along their routes.

        They are in these cells.
        """
        state = self._state
        here = state.positions[moving]
        places = here[:, None] + (AHEAD_S / self._tick_s * moved_m)[:, None] * _TIMES
        on_route = self._following[moving]
        slots = moving[on_route]
        if len(slots):
            # The tick that ends on a corner is a short one, which is no slower walk.
            left = self._targets[slots] - here[on_route]
            arrived = np.hypot(left[:, 0], left[:, 1]) < AT_CORNER_M
            speeds = np.where(arrived, self._walk_speed_mps, state.speeds[slots])
            places[on_route] = self._route_ahead.places(slots, here[on_route], speeds)
        state.ahead[moving] = self._grid.with_heights(places, cells)

    def _head_for_targets(self) -> None:
        """Set velocities along routes; the last step to a point ends on it."""
        slots = np.flatnonzero(self._following)
        offsets = self._targets[slots] - self._state.positions[slots]
        remaining_m = np.hypot(offsets[:, 0], offsets[:, 1])
        seconds = np.maximum(remaining_m / self._walk_speed_mps, self._tick_s)
        self._velocities[slots] = offsets / seconds[:, None]

    def _pass_targets(self) -> None:
        """Turn people to the next point of their routes; stop those at the end or stuck."""
        slots = np.flatnonzero(self._following)
        state = self._state
        wanted = np.hypot(self._velocities[slots, 0], self._velocities[slots, 1])
        stuck = state.speeds[slots] < STUCK_SHARE * wanted
        self._blocked[slots] = np.where(stuck, self._blocked[slots] + 1, 0)
        for slot in slots[self._blocked[slots] >= BLOCKED_TICKS].tolist():
            self.stop(slot)
        offsets = self._targets[slots] - state.positions[slots]
        left_m = np.hypot(offsets[:, 0], offsets[:, 1])
        for slot in slots[left_m < np.where(stuck, HELD_UP_M, AT_CORNER_M)].tolist():
            route = self._routes.get(slot)
            if route is None:
                continue
            route.popleft()
            if route:
                self._targets[slot] = route[0][:2]
                self._route_ahead.set(slot, (*islice(route, CORNERS), route[-1]))
            else:
                self.stop(slot)

"""Contacts counted pair by pair: everyone against everyone, pairs kept as a set."""

import math

from esplanade.planning.scene.heights import BODIES_OVERLAP_M
from esplanade.server.world.state import ACTOR, State

Pair = tuple[int, int]


class NaiveContacts:
    """The plain twin of `esplanade.server.world.contacts.Contacts`."""

    def __init__(self) -> None:
        self.actor_person = 0
        self.actor_actor = 0
        self._touching: set[Pair] = set()

    def update(self, state: State) -> None:
        touching: set[Pair] = set()
        live = state.live().tolist()
        for one in live:
            for other in live:
                if one == other or state.kinds[one] != ACTOR:
                    continue
                among_actors = state.kinds[other] == ACTOR
                if (among_actors and other < one) or not touch(state, one, other):
                    continue
                pair = int(state.ids[one]), int(state.ids[other])
                touching.add(pair)
                if pair in self._touching:
                    continue
                if among_actors:
                    self.actor_actor += 1
                else:
                    self.actor_person += 1
        self._touching = touching


def touch(state: State, one: int, other: int) -> bool:
    """Whether two bodies on one level touched during the tick."""
    apart_m = abs(float(state.heights[one] - state.heights[other]))
    reach_m = float(state.radii[one] + state.radii[other])
    return apart_m < BODIES_OVERLAP_M and closest_approach(state, one, other) < reach_m


def closest_approach(state: State, one: int, other: int) -> float:
    """Least distance of two bodies during the tick, both moving straight and evenly, metres."""
    x, y = (state.before[one] - state.before[other]).tolist()
    end_x, end_y = (state.positions[one] - state.positions[other]).tolist()
    dx, dy = end_x - x, end_y - y
    square = dx * dx + dy * dy
    share = 0.0 if square == 0.0 else min(max(-(x * dx + y * dy) / square, 0.0), 1.0)
    return math.hypot(x + share * dx, y + share * dy)

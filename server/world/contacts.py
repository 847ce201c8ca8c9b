"""Counts contacts of actors: with people, and with one another."""

import numpy as np

from esplanade.server.world.neighbours import Neighbours
from esplanade.server.world.state import ACTOR, PERSON, Floats, Slots, State

Pair = tuple[int, int]


class Contacts:
    """The contacts so far. A pair in contact counts once, and again only after it has parted."""

    def __init__(self) -> None:
        self.actor_person = 0
        self.actor_actor = 0
        self._touching: set[Pair] = set()

    def update(self, state: State, neighbours: Neighbours) -> None:
        """Take in the motion from the tick before to this one."""
        actors = state.of_kind(ACTOR)
        if not len(actors):
            return
        moved_m = np.hypot(*(state.positions - state.before)[state.alive].T)
        radius_m = state.radii[state.alive].max()
        first, second = neighbours.within(actors, 2.0 * float(radius_m + moved_m.max()))
        both_actors = state.kinds[second] == ACTOR
        once = ~both_actors | (first < second)
        first, second = first[once], second[once]

        close = closest_approach(state, first, second) < state.radii[first] + state.radii[second]
        first, second = first[close], second[close]
        touching: set[Pair] = set()
        for one, other in zip(first.tolist(), second.tolist(), strict=True):
            pair = (int(state.ids[one]), int(state.ids[other]))
            touching.add(pair)
            if pair in self._touching:
                continue
            if state.kinds[other] == PERSON:
                self.actor_person += 1
            else:
                self.actor_actor += 1
        self._touching = touching


def closest_approach(state: State, first: Slots, second: Slots) -> Floats:
    """Least distance of each pair during the tick, both moving straight and evenly; (N,) metres."""
    start = state.before[first] - state.before[second]
    change = state.positions[first] - state.positions[second] - start
    length2 = np.einsum("ij,ij->i", change, change)
    along = -np.einsum("ij,ij->i", start, change) / np.where(length2 > 0.0, length2, 1.0)
    nearest = start + np.clip(along, 0.0, 1.0)[:, None] * change
    distances: Floats = np.hypot(nearest[:, 0], nearest[:, 1])
    return distances

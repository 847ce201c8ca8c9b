"""Measures what actors and people do to each other, tick by tick."""

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.state import Reason
from esplanade.planning.scene.heights import BODIES_OVERLAP_M
from esplanade.server.whatif.measures import CONFLICT_S, ENCOUNTER_M, NEAR_M, TOWARD_MPS
from esplanade.server.world.state import ACTOR, PERSON
from esplanade.server.world.zone import Zone

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
_HINDERED = (int(Reason.GIVING_WAY), int(Reason.WAITING))


class Encounters:
    """The encounters of actors and people since it was made; `take` takes in each tick."""

    def __init__(self, zone: Zone) -> None:
        self._zone = zone
        self._tick_s = zone.tick_s
        self._touching = set(zone.contacts.touching.tolist())
        self._least: dict[tuple[int, int], float] = {}
        """The smallest clearance so far of each encounter that lasts, by actor and person."""
        self._ended: list[float] = []
        self.contacts = self.toward = 0
        self.near_s = self.conflict_s = 0.0
        self.actor_s = self.hindered_s = 0.0

    @property
    def clearances(self) -> list[float]:
        """The smallest clearance of each encounter, metres."""
        return [*self._ended, *self._least.values()]

    def take(self) -> None:
        """Take in the latest tick, in which something moved."""
        state = self._zone.state
        people, actors = state.of_kind(PERSON), state.of_kind(ACTOR)
        self.actor_s += self._tick_s * len(actors)
        hindered = np.isin(state.reasons[actors], _HINDERED)
        self.hindered_s += self._tick_s * int(hindered.sum())
        self._touch()
        offsets = state.positions[actors, None] - state.positions[None, people]
        distances = np.hypot(offsets[..., 0], offsets[..., 1])
        level = np.abs(state.heights[actors, None] - state.heights[None, people]) < BODIES_OVERLAP_M
        touch_m = state.radii[actors, None] + state.radii[None, people]
        meets = level & (distances < ENCOUNTER_M)
        near = level & (distances - touch_m < NEAR_M)
        self.near_s += self._tick_s * int(near.any(axis=0).sum())
        moved = state.positions - state.before
        velocities = (moved[actors, None] - moved[None, people]) / self._tick_s
        conflict = level & _touch_soon(offsets, velocities, touch_m)
        self.conflict_s += self._tick_s * int(conflict.any(axis=0).sum())
        self._meet(state.ids[actors], state.ids[people], meets, distances - touch_m)

    def _meet(
        self, actors: NDArray[np.int64], people: NDArray[np.int64], meets: Bools, clearances: Floats
    ) -> None:
        now = {}
        for row, column in np.argwhere(meets).tolist():
            pair = int(actors[row]), int(people[column])
            now[pair] = min(self._least.get(pair, np.inf), float(clearances[row, column]))
        self._ended += [least for pair, least in self._least.items() if pair not in now]
        self._least = now

    def _touch(self) -> None:
        state = self._zone.state
        touching = set(self._zone.contacts.touching.tolist())
        for pair in sorted(touching - self._touching):
            actor, other = divmod(pair, 2**32)
            slots = state.slots_of([actor, other])
            if (slots < 0).any() or state.kinds[slots[1]] != PERSON:
                continue
            self.contacts += 1
            own, whom = slots.tolist()
            away = state.before[whom] - state.before[own]
            velocity = (state.positions[own] - state.before[own]) / self._tick_s
            toward_mps = float(velocity @ away) / max(1e-9, float(np.hypot(*away)))
            self.toward += toward_mps > TOWARD_MPS
        self._touching = touching


def _touch_soon(offsets: Floats, velocities: Floats, touch_m: Floats) -> Bools:
    """Whether pairs (A, P) of bodies that go on straight come within `touch_m` soon.

    That is the first root of |offset + velocity t| = touch_m, at most `CONFLICT_S`.
    """
    square = (velocities**2).sum(axis=-1)
    along = (offsets * velocities).sum(axis=-1)
    apart = (offsets**2).sum(axis=-1) - touch_m**2
    inside = along**2 - square * apart
    comes = (along < 0.0) & (inside >= 0.0) & (square > 0.0)
    with np.errstate(invalid="ignore", divide="ignore"):
        first_s = (-along - np.sqrt(np.maximum(inside, 0.0))) / square
    soon: Bools = (apart <= 0.0) | (comes & (first_s <= CONFLICT_S))
    return soon

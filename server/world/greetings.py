"""Guides wave back at people who wave near them."""

from collections.abc import Mapping
from typing import Final

import numpy as np

from esplanade.protocol.codes import Gesture
from esplanade.server.world.actor_commands import ActorCommands
from esplanade.server.world.actors import ActorAvatars
from esplanade.server.world.state import Slots, State

NEAR_M: Final = 8.0
"""A guide answers a wave from no further away."""
SAME_FLOOR_M: Final = 1.5
"""It answers nobody whose feet are higher or lower than its own by more than this."""


class Greetings:
    """Finds who answers the waves of a tick: the guide nearest to each person who waves."""

    def __init__(self, state: State, actors: ActorAvatars, commands: ActorCommands) -> None:
        self._state = state
        self._actors = actors
        self._commands = commands

    def answers(self, gestures: Mapping[int, int]) -> dict[int, int]:
        """The gestures by which guides answer those of people, both by the avatars' ids."""
        waving = [one for one, gesture in gestures.items() if gesture == Gesture.WAVE]
        if not waving:
            return {}
        guides = self._state.slots_of(self._guides())
        guides = guides[guides >= 0]
        found = {}
        for person in waving:
            guide = self._nearest(person, guides)
            if guide is not None:
                found[guide] = int(Gesture.WAVE)
        return found

    def _guides(self) -> list[int]:
        """The avatars of all actors that guide people, the oldest first."""
        avatars = (
            self._actors.avatar(actor)
            for actor, spec in self._commands.specs.items()
            if spec.behaviour.kind == "guide"
        )
        return sorted(avatar for avatar in avatars if avatar is not None)

    def _nearest(self, person: int, guides: Slots) -> int | None:
        state = self._state
        if person not in state or not len(guides):
            return None
        slot = state.slot(person)
        apart = state.positions[guides] - state.positions[slot]
        apart_m = np.hypot(apart[:, 0], apart[:, 1])
        apart_m[np.abs(state.heights[guides] - state.heights[slot]) > SAME_FLOOR_M] = np.inf
        nearest = int(np.argmin(apart_m))
        return int(state.ids[guides[nearest]]) if apart_m[nearest] <= NEAR_M else None

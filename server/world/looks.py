"""The looks of avatars: those of actors, what people have chosen and the bodies that follow."""

from typing import Final

from esplanade.actors import ActorSpec
from esplanade.actors.locomotion.body.traits import traits_of
from esplanade.protocol.looks import Look
from esplanade.server.world.state import State

GUIDE: Final = "guide"
"""The kind of behaviour of those who carry a sign."""


def look_of(spec: ActorSpec) -> Look:
    """The look of an actor: what it wears, and the sign of one that guides people."""
    return Look(**spec.look.model_dump(), sign=int(spec.behaviour.kind == GUIDE))


class Looks:
    """Gives avatars looks. A stature that is chosen makes the whole body longer or shorter, so that
    its steps are those of its legs."""

    def __init__(self, state: State, seed: int) -> None:
        """`seed` is the world's, by which bodies are drawn."""
        self._state = state
        self._seed = seed

    def wear(self, slot: int, look: Look) -> None:
        """Let the person in that slot look like this from now on."""
        state = self._state
        state.looks[slot] = look
        state.scales[slot] = 1.0
        if look.stature_cm:
            own_m = traits_of(self._seed, int(state.ids[slot])).stature_m
            state.scales[slot] = look.stature_cm / 100.0 / own_m

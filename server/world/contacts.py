"""Counts contacts of actors: with people, and with one another."""

import numpy as np

from esplanade.server.world.compiled._contact_kernels import Bodies, find_touching
from esplanade.server.world.state import ACTOR, State


class Contacts:
    """The contacts so far. A pair in contact counts once, and again only after it has parted."""

    def __init__(self) -> None:
        self.actor_person = 0
        self.actor_actor = 0
        self.touching = np.empty(0, dtype=np.int64)
        """The pairs of an actor and another body that touched in the latest tick, ascending: the
        actor's id times 2 ** 32, plus that of the other. Each tick has an array of its own."""

    def update(self, state: State) -> None:
        """Take in the motion from the tick before to this one."""
        bodies = Bodies(
            state.ids, state.kinds, state.positions, state.before, state.heights, state.radii
        )
        found = find_touching(bodies, state.live(), ACTOR, self.touching)
        self.touching = found.pairs
        self.actor_person += found.new_with_people
        self.actor_actor += found.new_among_actors

"""The actors' avatars: moved as their population decides."""

from collections.abc import Hashable, Mapping

import numpy as np

from esplanade.actors import Explanation, ObservedPeople, Population
from esplanade.actors.locomotion.footsteps.course import planned_places
from esplanade.server.world.routes import Point
from esplanade.server.world.state import ACTOR, Slots, State


class ActorAvatars:
    """Joins the actors of a population, each known by its id, to avatars in the state."""

    def __init__(
        self,
        state: State,
        population: Population,
        names: Mapping[Hashable, str],
        tick_s: float,
    ) -> None:
        """`names` holds what others see each actor called, by its id."""
        self._state = state
        self._tick_s = tick_s
        self._population = population
        self._names = names
        self._avatars: dict[Hashable, int] = {}
        self._actor_ids: dict[int, Hashable] = {}
        self._slots: Slots = np.zeros(0, dtype=np.int64)
        """Slots of the avatars, in the order of the population's table."""
        self._version = 0
        self.pointing: dict[int, Point] = {}
        """The places that actors point at just now, by their avatars' ids."""

    @property
    def trips(self) -> int:
        return self._population.trips

    @property
    def doors_wanted(self) -> Mapping[str, bool]:
        """Doors that actors wanted moved in the last tick, by name."""
        return self._population.doors_wanted

    def plan(self, people: ObservedPeople) -> bool:
        """The next tick of all actors, if there are any. Heavy: touches only the population."""
        if not len(self._population):
            return False
        self._population.advance(people)
        return True

    def place(self, moved: bool) -> dict[int, Point | None]:
        """Move the avatars; new actors come into the world. If none has moved, all stand.

        Returns the actors that point at something else than before, by their avatars' ids: what
        they point at, None for nothing any more.
        """
        if not moved:
            self._stop()
            return {}
        table = self._population.table
        if table.version != self._version:
            self._match_rows()
        agents, state, slots = table.agents, self._state, self._slots
        state.positions[slots] = agents.positions
        state.layers[slots] = agents.layers
        state.heights[slots] = agents.heights
        state.headings[slots] = self._population.facing()
        state.speeds[slots] = np.hypot(agents.velocities[:, 0], agents.velocities[:, 1])
        state.reasons[slots] = agents.reasons
        state.radii[slots] = agents.parameters["radius_m"]
        places = np.column_stack([agents.positions, agents.heights])
        slice_s = self._population.navigator.plan.slice_s
        state.ahead[slots] = planned_places(agents.planned, slice_s, self._tick_s, places)
        return self._point()

    def explain(self, avatar_id: int) -> Explanation:
        """Why this actor does what it does. Not while `plan` runs."""
        return self._population.explain(self._actor_ids[avatar_id])

    def _stop(self) -> None:
        state = self._state
        actors = state.of_kind(ACTOR)
        state.speeds[actors] = 0.0
        state.ahead[actors, :, :2] = state.positions[actors, None]
        state.ahead[actors, :, 2] = state.heights[actors, None]

    def _point(self) -> dict[int, Point | None]:
        before = self.pointing
        self.pointing = {
            self._avatars[actor_id]: target
            for actor_id, target in self._population.pointing().items()
        }
        return {
            avatar_id: self.pointing.get(avatar_id)
            for avatar_id in before | self.pointing
            if before.get(avatar_id) != self.pointing.get(avatar_id)
        }

    def _match_rows(self) -> None:
        """Give every new actor an avatar, and find the slots of all anew."""
        table = self._population.table
        for row, actor_id in enumerate(table):
            if actor_id not in self._avatars:
                self._add(actor_id, row)
        slots = [self._state.slot(self._avatars[actor_id]) for actor_id in table]
        self._slots = np.array(slots, dtype=np.int64)
        self._version = table.version

    def _add(self, actor_id: Hashable, row: int) -> None:
        agents = self._population.table.agents
        x, y = agents.positions[row].tolist()
        slot = self._state.add(
            ACTOR,
            self._names[actor_id],
            (x, y, float(agents.heights[row])),
            int(agents.layers[row]),
            float(agents.parameters["radius_m"][row]),
        )
        avatar_id = int(self._state.ids[slot])
        self._avatars[actor_id] = avatar_id
        self._actor_ids[avatar_id] = actor_id

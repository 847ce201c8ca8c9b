"""The actors' avatars: moved as their population decides."""

from collections.abc import Hashable, Mapping
from dataclasses import dataclass

import numpy as np

from esplanade.actors import ActorState, Explanation, Population
from esplanade.actors.locomotion.footsteps.course import AHEAD, AHEAD_S
from esplanade.server.world.routes import Point
from esplanade.server.world.state import ACTOR, Floats, State

ActorStates = Mapping[Hashable, ActorState]


@dataclass(frozen=True)
class Body:
    """What others see of an actor."""

    name: str
    radius_m: float


class ActorAvatars:
    """Joins the actors of a population, named by its ids, to avatars in the state."""

    def __init__(
        self, state: State, population: Population, bodies: Mapping[Hashable, Body], tick_s: float
    ) -> None:
        self._state = state
        self._tick_s = tick_s
        self._population = population
        self._bodies = bodies
        self._avatars: dict[Hashable, int] = {}
        self._cast_ids: dict[int, Hashable] = {}
        self.pointing: dict[int, Point] = {}
        """What actors point at just now, by their avatars' ids."""

    @property
    def trips(self) -> int:
        return self._population.trips

    @property
    def doors_wanted(self) -> Mapping[str, bool]:
        """Doors that actors wanted moved in the last tick, by name."""
        return self._population.doors_wanted

    def plan(self, people: Mapping[Hashable, Point]) -> ActorStates:
        """The next tick of all actors. Heavy: touches nothing but the population."""
        return self._population.tick(people) if len(self._population) else {}

    def ground_changed(self) -> None:
        """Something opened or closed: find the ways to goals anew."""
        self._population.ground_changed()

    def place(self, states: ActorStates) -> dict[int, Point | None]:
        """Move the avatars; whoever is new comes into the world. Without states all stand.

        Returns who points at something else than before, by avatars' ids: what at, None for
        nothing any more.
        """
        if not states:
            self._stop()
            return {}
        for cast_id in [c for c in states if c not in self._avatars]:
            self._add(cast_id, states[cast_id])
        actors = states.values()
        state = self._state
        slots = np.array([state.slot(self._avatars[cast_id]) for cast_id in states])
        velocities = np.array([actor.velocity for actor in actors])
        state.positions[slots] = [actor.position for actor in actors]
        state.layers[slots] = [actor.layer for actor in actors]
        state.heights[slots] = [actor.z_m for actor in actors]
        state.headings[slots] = [actor.heading for actor in actors]
        state.speeds[slots] = np.hypot(velocities[:, 0], velocities[:, 1])
        state.reasons[slots] = [actor.reason for actor in actors]
        slice_s = next(iter(actors)).slice_s
        ways = np.stack([actor.way for actor in actors])
        places = np.column_stack([state.positions[slots], state.heights[slots]])
        state.ahead[slots] = course(ways, slice_s, self._tick_s, places)
        return self._point(states)

    def explain(self, avatar_id: int) -> Explanation:
        """Why this actor does what it does. Not while `plan` runs."""
        return self._population.explain(self._cast_ids[avatar_id])

    def _stop(self) -> None:
        state = self._state
        actors = state.of_kind(ACTOR)
        state.speeds[actors] = 0.0
        state.ahead[actors, :, :2] = state.positions[actors, None]
        state.ahead[actors, :, 2] = state.heights[actors, None]

    def _point(self, states: ActorStates) -> dict[int, Point | None]:
        before = self.pointing
        self.pointing = {
            self._avatars[cast_id]: actor.points_at
            for cast_id, actor in states.items()
            if actor.points_at is not None
        }
        return {
            avatar_id: self.pointing.get(avatar_id)
            for avatar_id in before | self.pointing
            if before.get(avatar_id) != self.pointing.get(avatar_id)
        }

    def _add(self, cast_id: Hashable, actor: ActorState) -> None:
        body = self._bodies[cast_id]
        place = (*actor.position, actor.z_m)
        slot = self._state.add(ACTOR, body.name, place, actor.layer, body.radius_m)
        avatar_id = int(self._state.ids[slot])
        self._avatars[cast_id] = avatar_id
        self._cast_ids[avatar_id] = cast_id


def course(ways: Floats, slice_s: float, now_s: float, places: Floats) -> Floats:
    """Where A actors will be from now on: (A, AHEAD, 3).

    Their ways (A, K, 3) were planned for `now_s` ago. They are where limits of speed and of what
    stands there let them be, (A, 3), and get back to their ways within a second.
    """
    times = np.arange(AHEAD) * AHEAD_S
    at = np.minimum((now_s + times) / slice_s, ways.shape[1] - 1.0)
    k = np.minimum(at.astype(np.int64), max(ways.shape[1] - 2, 0))
    share = (at - k)[:, None]
    planned = (1.0 - share) * ways[:, k] + share * ways[:, np.minimum(k + 1, ways.shape[1] - 1)]
    fade = np.maximum(1.0 - times, 0.0)[:, None]
    return np.asarray(planned + fade * (places - planned[:, 0])[:, None])

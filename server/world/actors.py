"""The actors' avatars: moved as their population decides."""

from collections.abc import Hashable, Iterable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from esplanade.actors import Explanation, ObservedPeople, Outcome, Population
from esplanade.actors.blockers import Blocker
from esplanade.actors.locomotion.footsteps.course import planned_places
from esplanade.planning import Body
from esplanade.protocol.looks import NO_LOOK, Look
from esplanade.server.world.frame import Line
from esplanade.server.world.inputs import PlanEvery, PotentialDerived, SteerActors
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
        self._names = dict(names)
        self._looks: dict[Hashable, Look] = {}
        self._avatars: dict[Hashable, int] = {}
        self._actor_ids: dict[int, Hashable] = {}
        self._slots: Slots = np.zeros(0, dtype=np.int64)
        """Slots of the avatars, in the order of the population's table."""
        self._version = 0
        self.pointing: dict[int, Point] = {}
        """The places that actors point at just now, by their avatars' ids."""
        self.steered: dict[Hashable, tuple[float, float]] = {}
        """The velocities, m/s, of actors that do not plan in this tick, by the actors' ids."""

    @property
    def trips(self) -> int:
        return self._population.trips

    @property
    def ended(self) -> Mapping[Outcome, int]:
        """Trips that have ended, by their outcome."""
        return self._population.ended

    @property
    def doors_wanted(self) -> Mapping[str, bool]:
        """Doors that actors wanted moved in the last tick, by name."""
        return self._population.doors_wanted

    def plan(self, people: ObservedPeople) -> bool:
        """The next tick of all actors, if there are any. Heavy: touches only the population."""
        if not len(self._population):
            return False
        if self.steered:
            self._population.steer(self.steered)
        self._population.advance(people)
        return True

    def said(self) -> list[Line]:
        """The sentences that actors have said in the last tick to people whom they lead."""
        return [
            Line(
                self._avatars[actor_id],
                saying.text,
                to=frozenset(who for who in saying.to if isinstance(who, int)),
            )
            for actor_id, saying in self._population.said
            if actor_id in self._avatars
        ]

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
        state.scales[slots] = agents.parameters["height_m"] / Body.height_m
        state.strides[slots] = agents.parameters["stride"]
        places = np.column_stack([agents.positions, agents.heights])
        slice_s = self._population.navigator.plan.slice_s
        ahead, pushed = planned_places(agents.planned, slice_s, self._tick_s, places)
        pushed = pushed[agents.cells[pushed] >= 0]
        if len(pushed):
            grid, paths = self._population.navigator.grid, ahead[pushed, :, :2]
            ahead[pushed] = grid.with_heights(paths, agents.cells[pushed])
        state.ahead[slots] = ahead
        return self._point()

    @property
    def avatars(self) -> Mapping[Hashable, int]:
        """The avatar of each actor that is in the world, by the actor's id."""
        return self._avatars

    def restore(self, avatars: Mapping[str, int], names: Mapping[Hashable, str]) -> None:
        """Give actors the avatars that they had before a restart; those without get new ones."""
        self._names = dict(names)
        for row, actor_id in enumerate(self._population.table):
            if actor_id in avatars:
                self._add(actor_id, row, avatars[str(actor_id)])

    def save(self) -> dict[str, Any]:
        """The avatars of all actors, the names of all, and what is pointed at, as plain data."""
        return {
            "avatars": dict(self._avatars),
            "names": dict(self._names),
            "pointing": {avatar: list(place) for avatar, place in self.pointing.items()},
        }

    def load(self, saved: Mapping[str, Any]) -> None:
        """Know the avatars that were saved, which are in the state already, and no others.

        Raises
        ------
        ValueError, KeyError, TypeError
            It is not what `save` of these actors gives.
        """
        table = self._population.table
        self._names = dict(saved["names"])
        self._avatars = {actor: int(avatar) for actor, avatar in saved["avatars"].items()}
        self._actor_ids = {avatar: actor for actor, avatar in self._avatars.items()}
        self.pointing = {
            int(avatar): (float(x), float(y), float(z))
            for avatar, (x, y, z) in saved["pointing"].items()
        }
        here = [actor for actor in table if actor in self._avatars]
        if len(here) < len(self._avatars) or not set(table.ids) <= self._names.keys():
            raise ValueError("there is an avatar of an actor who is not there")
        self._slots = np.array([self._state.slot(self._avatars[a]) for a in here], dtype=np.int64)
        # Actors without an avatar come into the world with the next tick that moves any.
        self._version = table.version if len(here) == len(table) else -1

    def name(self, actor_id: Hashable, name: str) -> None:
        """Set the name that others see of an actor which comes into the world next."""
        self._names[actor_id] = name

    def wear(self, actor_id: Hashable, look: Look) -> None:
        """Let an actor look like this from now on, or from when it comes into the world."""
        self._looks[actor_id] = look
        avatar_id = self._avatars.get(actor_id)
        if avatar_id is not None:
            self._state.looks[self._state.slot(avatar_id)] = look

    def avatar(self, actor_id: Hashable) -> int | None:
        """The avatar of an actor, by its id; None if it is not in the world yet."""
        return self._avatars.get(actor_id)

    def actor(self, avatar_id: int) -> Hashable | None:
        """The id of the actor whose avatar that is; None if it is nobody's."""
        return self._actor_ids.get(avatar_id)

    def remove(self, ids: Iterable[Hashable]) -> list[int]:
        """Take actors who have left the population out of the world; returns their avatars."""
        left = []
        for actor_id in ids:
            self._names.pop(actor_id, None)
            self._looks.pop(actor_id, None)
            avatar_id = self._avatars.pop(actor_id, None)
            if avatar_id is None:  # it came and went between two plans
                continue
            del self._actor_ids[avatar_id]
            self.pointing.pop(avatar_id, None)
            self._state.remove(avatar_id)
            left.append(avatar_id)
        return left

    def put(self, actor_id: Hashable) -> None:
        """Move an avatar at once to where its actor was put; it does not walk there."""
        avatar_id = self._avatars.get(actor_id)
        if avatar_id is None:
            return
        slot, agents = self._state.slot(avatar_id), self._population.table.agents
        row = self._population.table.row(actor_id)
        self._state.positions[slot] = self._state.before[slot] = agents.positions[row]
        self._state.heights[slot] = agents.heights[row]
        self._state.layers[slot] = agents.layers[row]

    def take(self, item: PotentialDerived | PlanEvery | SteerActors) -> None:
        """Take in by what, or how often, actors are planned from now on, or not in this tick."""
        match item:
            case PotentialDerived():
                self._population.renew_potential(item.potential)
            case PlanEvery():
                self._population.navigator.planning_interval.ticks = item.ticks
            case SteerActors():
                self.steered |= zip(item.actors, item.velocities_mps, strict=True)

    def stand(self, people: ObservedPeople) -> None:
        """A tick in which nothing is planned."""
        self._population.stand(people)

    def explain(self, avatar_id: int) -> Explanation:
        """Why this actor does what it does; who holds it is told by the avatar's id.

        Not while `plan` runs.
        """
        explanation = self._population.explain(self._actor_ids[avatar_id])
        by = explanation.in_the_way
        if by is not None and by.kind == "actor":
            by = by._replace(id=self._avatars.get(by.id))
        return replace(explanation, blocker=self._by_avatar(explanation.blocker), in_the_way=by)

    def blocker(self, avatar_id: int) -> Blocker | None:
        """The blocker of this actor, an actor by the id of its avatar; not while `plan` runs."""
        return self._by_avatar(self._population.blocker(self._actor_ids[avatar_id]))

    def _by_avatar(self, held: Blocker | None) -> Blocker | None:
        if held is None or held.kind != "actor":
            return held
        return replace(held, id=self._avatars.get(held.id))

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

    def _add(self, actor_id: Hashable, row: int, had: int | None = None) -> None:
        agents = self._population.table.agents
        x, y = agents.positions[row].tolist()
        slot = self._state.add(
            ACTOR,
            self._names[actor_id],
            (x, y, float(agents.heights[row])),
            int(agents.layers[row]),
            float(agents.parameters["radius_m"][row]),
            had,
        )
        self._state.looks[slot] = self._looks.get(actor_id, NO_LOOK)
        avatar_id = int(self._state.ids[slot])
        self._avatars[actor_id] = avatar_id
        self._actor_ids[avatar_id] = actor_id

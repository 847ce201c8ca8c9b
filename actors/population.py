"""The population of a zone: all actors with their behaviours, and the navigator of them all."""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.behaviour import Behaviour, BehaviourName, Goal, Perception
from esplanade.actors.navigator import Navigator
from esplanade.actors.parameters import ActorParameters
from esplanade.actors.state import ActorState, Reason
from esplanade.planning import Body, LayeredGrid, Polygon, Potential, Scene
from esplanade.planning.scene.heights import SAME_FLOOR_M

_EXPLAINED_WITHIN_M = 8.0
_STUCK_AFTER_S = 3.0
_PLACING_TRIES = 64


@dataclass(frozen=True)
class Explanation:
    """Why an actor does what it does, for the overlay and the operator."""

    behaviour: BehaviourName
    reason: Reason
    goal: Goal | None
    path: NDArray[np.float64]
    """float64 (K, 4): x, y, z, seconds from now."""
    people: list[NDArray[np.float64]]
    """For each person near: float64 (K, 4) x, y, z, radius of the two-sigma circle, m."""


@dataclass
class _Actor:
    behaviour: Behaviour
    parameters: ActorParameters
    rng: np.random.Generator
    state: ActorState
    goal: Goal | None = None
    arrived: bool = False
    no_path_s: float = 0.0


class Population:
    """All actors of a zone. One call of `tick` a tick; same seed and same people, same walks."""

    def __init__(
        self, grid: LayeredGrid, scene: Scene, tick_s: float = 0.05, seed: int = 0
    ) -> None:
        self.grid = grid
        self.scene = scene
        self.navigator = Navigator(grid, tick_s, seed)
        self.trips = 0
        """Goals reached by all actors so far."""
        self.doors_wanted: dict[str, bool] = {}
        """Doors that behaviours wanted moved in the last tick; who was added last prevails."""
        self._tick = 0
        self._seed = seed
        self._actors: dict[Hashable, _Actor] = {}
        self._entrances: dict[Body, Potential | None] = {}

    def __len__(self) -> int:
        return len(self._actors)

    def add(
        self,
        actor_id: Hashable,
        behaviour: Behaviour,
        parameters: ActorParameters | None = None,
        position: tuple[float, float] | None = None,
        z_m: float = 0.0,
    ) -> ActorState:
        """Put an actor in; without a position it gets a free place, chosen with the seed.

        At a position where it cannot stand it is put on the nearest ground where it can.

        Raises
        ------
        ValueError
            The id is taken, the position is outside, or there is no free place.
        KeyError
            The behaviour names a place that the scene does not have.
        """
        parameters = parameters or ActorParameters()
        self._check_targets(behaviour)
        rng = np.random.default_rng([self._seed, *str(actor_id).encode()])
        if position is None:
            position = self._free_place(parameters, z_m, rng)
        else:
            self.navigator.check_place(position, z_m)
            position = self._ground_near(parameters, position, z_m)
        self.navigator.add_actor(actor_id, position, None, parameters, z_m=z_m)
        state = self.navigator.state(actor_id)
        self._actors[actor_id] = _Actor(behaviour, parameters, rng, state)
        return state

    def remove(self, actor_id: Hashable) -> None:
        """Take an actor out; KeyError when there is none of that id."""
        self.navigator.remove_actor(actor_id)
        del self._actors[actor_id]

    def set_behaviour(self, actor_id: Hashable, behaviour: Behaviour) -> None:
        """Give an actor another behaviour; KeyError for an unknown actor or place."""
        actor = self._actors[actor_id]
        self._check_targets(behaviour)
        actor.behaviour = behaviour
        actor.arrived = False

    def set_parameters(self, actor_id: Hashable, parameters: ActorParameters) -> None:
        """Change an actor's parameters from the next tick on."""
        self.navigator.set_parameters(actor_id, parameters)
        self._actors[actor_id].parameters = parameters

    def tick(self, people: Mapping[Hashable, Goal]) -> dict[Hashable, ActorState]:
        """One tick: behaviours choose goals, then everyone plans and steps. id -> state."""
        time_s = self._tick * self.navigator.tick_s
        self.doors_wanted = {}
        for actor_id, actor in self._actors.items():
            goal = actor.behaviour.update(self._view(actor, people, time_s))
            self.doors_wanted.update(actor.behaviour.moves_doors)
            if goal != actor.goal:
                self.navigator.set_goal(
                    actor_id,
                    None if goal is None else goal[:2],
                    z_m=0.0 if goal is None else goal[2],
                )
                actor.goal = goal
                actor.arrived = False
                actor.no_path_s = 0.0
        self.navigator.observe(people)
        states = self.navigator.tick()
        for actor_id, actor in self._actors.items():
            if actor.behaviour.points_at is not None:
                states[actor_id] = _pointing(states[actor_id], actor.behaviour.points_at)
        for actor_id, state in states.items():
            actor = self._actors[actor_id]
            actor.state = state
            if state.reason is Reason.NO_PATH:
                actor.no_path_s += self.navigator.tick_s
            else:
                actor.no_path_s = 0.0
            if actor.goal is not None and state.reason is Reason.ARRIVED and not actor.arrived:
                actor.arrived = True
                self.trips += 1
        self._tick += 1
        return states

    def ground_changed(self) -> None:
        """The ground has changed, as when a door closes: ways to goals are found anew."""
        self._entrances.clear()
        self.navigator.ground_changed()

    def explain(self, actor_id: Hashable) -> Explanation:
        """Why an actor does what it does; KeyError when there is none of that id."""
        actor = self._actors[actor_id]
        state = actor.state
        near = self.navigator.predicted_near(state.position, state.z_m, _EXPLAINED_WITHIN_M)
        for circles in near:
            circles[:, 3] *= 2.0
        return Explanation(actor.behaviour.name, state.reason, actor.goal, state.path, near)

    def warm_up(self, ready_to_plan: Callable[[], None] = lambda: None) -> None:
        """Make ready all that a tick would have to wait for: kernels, and potentials of places.

        Kernels are compiled by running a small zone of their own, which is not all level: on level
        ground some are not called. Few actors and many are planned for by different ones.
        `ready_to_plan` waits for whoever compiles meanwhile what plans for them.
        """
        step = Polygon(points=((4.5, 4.5), (5.5, 4.5), (5.5, 5.5), (4.5, 5.5)), height_m=0.3)
        walls = [((3.0, 0.0), (3.0, 2.0))]
        scene = Scene.open_space((0.0, 0.0, 6.0, 6.0), walls=walls, polygons=[step])
        navigator = Navigator(scene, self.navigator.tick_s)
        navigator.grid.walk([(1.0, 1.0)], [0], [(0.1, 0.0)], 0.2)
        navigator.grid.nearest_free((3.0, 1.0), 0.0, 0.25)
        navigator.grid.with_heights(np.ones((1, 2, 2)), np.zeros(1, dtype=np.int64))
        potential = Potential(navigator.grid, (5.0, 1.0), 0, 0.25)
        potential.direction([(1.0, 1.0)], [0])
        potential.distance([(1.0, 1.0)], [0])
        navigator.observe({"p": (3.0, 5.05)})
        navigator.tick()
        ready_to_plan()
        navigator.add_actor("a", (1.0, 1.0), (5.0, 1.0))
        navigator.add_actor("b", (5.0, 1.0), (1.0, 1.0))
        for k in range(40):
            navigator.observe({"p": (3.0, 5.0 - 0.05 * k)})
            navigator.tick()
            if k == 30:
                for n in range(10):
                    navigator.add_actor(n, (0.5 + 0.5 * n, 3.5), (1.0, 1.0))
        navigator.close()
        for place in self.scene.places:
            self.navigator.prepare_goal(place.position, place.z_m, ActorParameters())

    def close(self) -> None:
        """End the planning threads."""
        self.navigator.close()

    def _view(self, actor: _Actor, people: Mapping[Hashable, Goal], time_s: float) -> Perception:
        return Perception(
            time_s,
            actor.state.position,
            actor.state.z_m,
            actor.arrived,
            actor.no_path_s >= _STUCK_AFTER_S,
            people,
            self.scene,
            self.grid,
            actor.parameters.body,
            actor.rng,
        )

    def _check_targets(self, behaviour: Behaviour) -> None:
        for target in behaviour.targets():
            if isinstance(target, str):
                self.scene.place(target)

    def _free_place(
        self, parameters: ActorParameters, z_m: float, rng: np.random.Generator
    ) -> tuple[float, float]:
        """Somewhere free, on the floor at that height unless that is nowhere to be found."""
        x0, y0, x1, y1 = self.scene.bounds
        elsewhere = None
        here = [a.state for a in self._actors.values() if abs(a.state.z_m - z_m) < SAME_FLOOR_M]
        taken = np.array([state.position for state in here]).reshape(-1, 2)
        for _ in range(_PLACING_TRIES):
            point = rng.uniform((x0, y0), (x1, y1))
            place = float(point[0]), float(point[1])
            crowded = len(taken) and np.hypot(*(taken - point).T).min() < 2.5 * parameters.radius_m
            if not crowded and self._has_a_way(point, z_m, parameters):
                if abs(self.grid.floor_at(place, z_m) - z_m) < SAME_FLOOR_M:
                    return place
                elsewhere = elsewhere or place
        if elsewhere is not None:
            return elsewhere
        raise ValueError(f"no free place for another actor after {_PLACING_TRIES} tries")

    def _ground_near(
        self, parameters: ActorParameters, position: tuple[float, float], z_m: float
    ) -> tuple[float, float]:
        """The position itself if the body stands there, be it close to a wall."""
        body = parameters.body
        if self.grid.nearest_free(position, z_m, 0.0, body) == position:
            return position
        free = self.grid.nearest_free(position, z_m, body.radius_m, body)
        if free is None:
            raise ValueError("nobody of that body can stand anywhere in this scene")
        return free

    def _has_a_way(
        self, point: NDArray[np.float64], z_m: float, parameters: ActorParameters
    ) -> bool:
        """Whether a body fits there and gets from there to where people come in."""
        body = parameters.body
        if not self.grid.is_free([point], [z_m], body.radius_m + 0.1, body)[0]:
            return False
        if body not in self._entrances:
            self._entrances[body] = self._entrance(body)
        potential = self._entrances[body]
        return potential is None or bool(np.isfinite(potential.distance([point], [z_m])[0]))

    def _entrance(self, body: Body) -> Potential | None:
        """The potential of the place where people come in; None where there is no such place."""
        entries = self.scene.spawns or self.scene.places
        if not entries:
            return None
        entry = entries[0]
        free = self.grid.nearest_free(entry.position, entry.z_m, body.radius_m, body)
        if free is None:
            return None
        return Potential(self.grid, free, entry.z_m, body.radius_m, body=body)


def _pointing(state: ActorState, target: Goal) -> ActorState:
    """The same actor, turned to what it points at."""
    (x, y), (to_x, to_y, _) = state.position, target
    return state._replace(points_at=target, heading=math.atan2(to_y - y, to_x - x))

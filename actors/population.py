"""The population of a zone: all actors with their behaviours, and the navigator of them all."""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.behaviour import Behaviour, BehaviourName, Goal, Perception
from esplanade.actors.navigator import Navigator
from esplanade.actors.parameters import ActorParameters, body_of
from esplanade.actors.potential_pool import RenewedPotential
from esplanade.actors.state import ActorState, Reason
from esplanade.planning import AgentTable, Body, LayeredGrid, Polygon, Potential, RiskModel, Scene
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
    """One array for each person near: float64 (K, 4) x, y, z, radius of the two-sigma circle, m."""


class Population:
    """All actors of a zone. One call of `tick` a tick; same seed and same people, same walks.

    An actor has one identity, its id; its whole state stands in `navigator.table`.
    """

    def __init__(
        self,
        grid: LayeredGrid,
        scene: Scene,
        tick_s: float = 0.05,
        seed: int = 0,
        *,
        person_radius_m: float = 0.25,
    ) -> None:
        self.grid = grid
        self.scene = scene
        self.navigator = Navigator(
            grid, tick_s, seed, risk=RiskModel(person_radius_m=person_radius_m)
        )
        self.trips = 0
        """Goals reached by all actors so far."""
        self.doors_wanted: dict[str, bool] = {}
        """Doors that behaviours wanted moved in the last tick; the actor added last prevails."""
        self._tick = 0
        self._seed = seed
        self._behaviours: dict[Hashable, Behaviour] = {}
        self._generators: dict[Hashable, np.random.Generator] = {}
        self._entrances: dict[Body, Potential | None] = {}

    @property
    def table(self) -> AgentTable:
        """Every actor's state; read it freely between two ticks."""
        return self.navigator.table

    def __len__(self) -> int:
        return len(self._behaviours)

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
        self._behaviours[actor_id] = behaviour
        self._generators[actor_id] = rng
        return self.navigator.state(actor_id)

    def remove(self, actor_id: Hashable) -> None:
        """Take an actor out; KeyError when there is none of that id."""
        self.navigator.remove_actor(actor_id)
        del self._behaviours[actor_id], self._generators[actor_id]

    def set_behaviour(self, actor_id: Hashable, behaviour: Behaviour) -> None:
        """Give an actor another behaviour; KeyError for an unknown actor or place."""
        row = self.table.row(actor_id)
        self._check_targets(behaviour)
        self._behaviours[actor_id] = behaviour
        trips = self.table.trips
        trips.arrived[row] = False
        trips.ask_at_s[row] = -np.inf

    def set_parameters(self, actor_id: Hashable, parameters: ActorParameters) -> None:
        """Change an actor's parameters from the next tick on."""
        self.navigator.set_parameters(actor_id, parameters)

    def tick(self, people: Mapping[Hashable, Goal]) -> dict[Hashable, ActorState]:
        """`advance`, then the states of all actors: id -> state."""
        self.advance(people)
        return {actor_id: self.state(actor_id) for actor_id in self.table}

    def advance(self, people: Mapping[Hashable, Goal]) -> None:
        """One tick: behaviours choose goals, then everyone plans and steps; see `table`.

        A behaviour is asked when its time has come, when its actor has arrived, and while no path
        leads to the goal. Cost in Python: O(behaviours asked).
        """
        self.doors_wanted = {}
        trips, time_s = self.table.trips, self._tick * self.navigator.tick_s
        stuck = trips.no_path_s >= _STUCK_AFTER_S
        due = (time_s >= trips.ask_at_s) | stuck | (trips.arrived != trips.arrived_when_asked)
        rows = np.flatnonzero(due).tolist()
        if rows:
            ids = self.table.ids
            for row in rows:
                self._ask(ids[row], row, bool(stuck[row]), people, time_s)
        self.navigator.observe(people)
        self.navigator.advance()
        self._keep_account()
        self._tick += 1

    def _ask(
        self,
        actor_id: Hashable,
        row: int,
        stuck: bool,
        people: Mapping[Hashable, Goal],
        time_s: float,
    ) -> None:
        """Ask a behaviour where its actor is to go, and send it there."""
        behaviour = self._behaviours[actor_id]
        agents, trips = self.table.agents, self.table.trips
        arrived = bool(trips.arrived[row])
        x, y = agents.positions[row].tolist()
        goal = behaviour.update(
            Perception(
                time_s,
                (x, y),
                float(agents.heights[row]),
                arrived,
                stuck,
                people,
                self.scene,
                self.grid,
                body_of(agents.parameters[row]),
                self._generators[actor_id],
            )
        )
        self.doors_wanted.update(behaviour.moves_doors)
        if goal != self.table.wanted(row):
            self.navigator.set_goal(
                actor_id,
                None if goal is None else goal[:2],
                z_m=0.0 if goal is None else goal[2],
            )
        trips.arrived_when_asked[row] = arrived
        trips.ask_at_s[row] = behaviour.ask_at_s
        trips.points_at[row] = np.nan if behaviour.points_at is None else behaviour.points_at

    def _keep_account(self) -> None:
        """Count the trips that ended in this tick, and the time that goals are out of reach."""
        reasons, trips = self.table.agents.reasons, self.table.trips
        no_path = reasons == Reason.NO_PATH
        trips.no_path_s[:] = np.where(no_path, trips.no_path_s + self.navigator.tick_s, 0.0)
        going = ~np.isnan(trips.wanted[:, 0])
        arrived = going & (reasons == Reason.ARRIVED) & ~trips.arrived
        trips.arrived[:] |= arrived
        self.trips += int(np.count_nonzero(arrived))

    def state(self, actor_id: Hashable) -> ActorState:
        """One actor's state; an actor that points at something is turned to it."""
        state = self.navigator.state(actor_id)
        target = self.table.points_at(self.table.row(actor_id))
        if target is None:
            return state
        return state._replace(points_at=target, heading=_turned_to(state.position, target))

    def facing(self) -> NDArray[np.float64]:
        """Headings that actors show, float64 (A,) rad: those who point at something face it."""
        agents, trips = self.table.agents, self.table.trips
        headings = agents.headings.copy()
        for row in np.flatnonzero(~np.isnan(trips.points_at[:, 0])).tolist():
            headings[row] = _turned_to(
                agents.positions[row].tolist(), trips.points_at[row].tolist()
            )
        return headings

    def pointing(self) -> dict[Hashable, Goal]:
        """The places that actors point at just now, x, y, z in metres by their ids."""
        rows = np.flatnonzero(~np.isnan(self.table.trips.points_at[:, 0])).tolist()
        if not rows:
            return {}
        ids = self.table.ids
        return {ids[row]: target for row in rows if (target := self.table.points_at(row))}

    def ground_changed(self, *, renewed_outside: bool = False) -> None:
        """The ground has changed, as when a door closes: potentials of goals are derived anew.

        With `renewed_outside`, by whoever calls `outdated_potential` and `renew_potential`.
        """
        self._entrances.clear()
        self.navigator.ground_changed(renewed_outside=renewed_outside)

    def outdated_potential(self) -> Callable[[], RenewedPotential] | None:
        """Derives the next potential that is out of date, in any thread; None if there is none."""
        return self.navigator.potentials.outdated()

    def renew_potential(self, renewed: RenewedPotential) -> None:
        """Let actors go by a potential that was derived anew."""
        self.navigator.potentials.renew(renewed)

    def explain(self, actor_id: Hashable) -> Explanation:
        """Why an actor does what it does; KeyError when there is none of that id."""
        behaviour, state = self._behaviours[actor_id], self.navigator.state(actor_id)
        near = self.navigator.predicted_near(state.position, state.z_m, _EXPLAINED_WITHIN_M)
        for circles in near:
            circles[:, 3] *= 2.0
        return Explanation(behaviour.name, state.reason, state.goal, state.path, near)

    def warm_up(self, ready_to_plan: Callable[[], None] = lambda: None) -> None:
        """Make ready all that a tick would have to wait for: kernels, and potentials of places.

        Kernels are compiled by running a small zone of their own, which is not all level: on level
        ground some are not called. Few actors and many are planned for by different ones.
        `ready_to_plan` waits until the kernels that plan have been compiled elsewhere.
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
        goals = [(place.position, place.z_m) for place in self.scene.places]
        self.navigator.prepare_goals(goals, ActorParameters())

    def close(self) -> None:
        """End the planning threads."""
        self.navigator.close()

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
        agents = self.table.agents
        taken = agents.positions[np.abs(agents.heights - z_m) < SAME_FLOOR_M]
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


def _turned_to(position: Sequence[float], target: Sequence[float]) -> float:
    """Heading from a place to a target, radians."""
    return math.atan2(target[1] - position[1], target[0] - position[0])

"""Movers of one crowd: our planner, DetourCrowd, and ORCA, each with the interface of `Mover`."""

from __future__ import annotations

import time
from collections.abc import Sequence
from importlib import import_module
from importlib.util import find_spec
from typing import Any, Final, Protocol

import numpy as np
from benchmarks._detour import NavMeshSettings, y_up, z_up
from benchmarks._node_process import NodeProcess, recast_missing
from benchmarks._scene_triangles import triangles_of
from numpy.typing import NDArray

from esplanade.actors import ActorParameters, Navigator
from esplanade.planning import LayeredGrid, PlanModel, Potential, Scene

Floats = NDArray[np.float64]

SPEED_MPS: Final = 1.3
"""The speed that actors like best; with DetourCrowd also their greatest."""
MAX_SPEED_MPS: Final = 1.7
RADIUS_M: Final = 0.25
ACCELERATION_MPS2: Final = 2.0
HEIGHT_M: Final = 1.8
SETTINGS: Final = NavMeshSettings(RADIUS_M, HEIGHT_M, climb_m=0.3, cell_m=0.125)
AGENT: Final = {
    "radius": RADIUS_M,
    "height": HEIGHT_M,
    "maxAcceleration": ACCELERATION_MPS2,
    "maxSpeed": SPEED_MPS,
    "collisionQueryRange": 12.0 * RADIUS_M,
    "pathOptimizationRange": 30.0 * RADIUS_M,
    "separationWeight": 2.0,
    "updateFlags": 31,
    "obstacleAvoidanceType": 3,
}
"""As in Recast's own demonstration, with everything switched on."""
PERSON: Final = {**AGENT, "maxAcceleration": 1000.0, "maxSpeed": 10.0, "updateFlags": 0}
"""People look at nobody, and go where they are told."""
NEIGHBOUR_M: Final = 5.0
NEIGHBOURS: Final = 10
HORIZON_S: Final = 3.6
"""ORCA looks as far ahead as our search."""
WALL_HORIZON_S: Final = 1.0
JITTER_MPS: Final = 1e-4
"""ORCA's authors shake preferred velocities by this, against symmetries without a way out."""


class Crowd(Protocol):
    """The crowd as it begins: A actors with goals and P people, all on one level."""

    scene: Scene
    grid: LayeredGrid
    tick_s: float
    places: Floats
    """Goals to choose from (G, 2), metres."""
    starts: Floats
    """Of actors (A, 2), metres."""
    goals: NDArray[np.int64]
    """Rows of `places`, (A,)."""
    people: Floats
    """(P, 2), metres."""


class Mover(Protocol):
    """Moves the actors of a crowd."""

    name: str

    def tick(
        self, goals: NDArray[np.int64], changed: NDArray[np.int64], people: Floats, speeds: Floats
    ) -> tuple[Floats, float]:
        """Move all actors by a tick: their places (A, 2), and the processor time in seconds.

        The actors `changed` (N,) have others of the `goals` (A,) than before; people are at (P, 2)
        m and walk at (P, 2) m/s.
        """

    def close(self) -> None:
        """Give back threads and processes."""


class Esplanade:
    """Our planner on one thread: prediction, searches, last checks and steps."""

    def __init__(self, crowd: Crowd, interval: int = 1) -> None:
        self.name = "esplanade" if interval == 1 else f"esplanade, interval {interval}"
        self._places = crowd.places
        plan = PlanModel(threads=1, interval_s=interval * crowd.tick_s)
        self._navigator = Navigator(crowd.grid, crowd.tick_s, plan=plan)
        body = ActorParameters(
            radius_m=RADIUS_M,
            speed_mps=SPEED_MPS,
            max_speed_mps=MAX_SPEED_MPS,
            max_acceleration_mps2=ACCELERATION_MPS2,
        )
        for k, (start, goal) in enumerate(zip(crowd.starts.tolist(), crowd.goals, strict=True)):
            self._navigator.add_actor(k, (start[0], start[1]), self._place(goal), body)

    def tick(
        self, goals: NDArray[np.int64], changed: NDArray[np.int64], people: Floats, speeds: Floats
    ) -> tuple[Floats, float]:
        del speeds  # they are seen from where people have been
        for k in changed.tolist():
            self._navigator.set_goal(k, self._place(goals[k]))
        seen = {f"p{k}": (x, y) for k, (x, y) in enumerate(people.tolist())}
        begun = time.process_time()
        self._navigator.observe(seen)
        self._navigator.advance()
        took = time.process_time() - begun
        return self._navigator.table.agents.positions.copy(), took

    def close(self) -> None:
        self._navigator.close()

    def _place(self, goal: int) -> tuple[float, float]:
        x, y = self._places[goal].tolist()
        return x, y


class DetourCrowd:
    """The crowd of Recast Navigation, which finds its routes on a navigation mesh."""

    name = "DetourCrowd"

    def __init__(self, crowd: Crowd) -> None:
        self._places, self._tick_s = _on_ground(crowd.places), crowd.tick_s
        mesh = triangles_of(crowd.scene)
        self._node = NodeProcess("crowd.mjs")
        begin = {
            "positions": y_up(mesh).ravel().tolist(),
            "indices": list(range(3 * len(mesh))),
            "config": SETTINGS.config(),
            "actors": _on_ground(crowd.starts),
            "goals": [self._places[goal] for goal in crowd.goals],
            "people": _on_ground(crowd.people),
            "agent": AGENT,
            "person": PERSON,
        }
        try:
            self._node.ask({"begin": begin})
        except RuntimeError:
            self._node.close()
            raise

    def tick(
        self, goals: NDArray[np.int64], changed: NDArray[np.int64], people: Floats, speeds: Floats
    ) -> tuple[Floats, float]:
        tick = {
            "goals": [[k, self._places[goals[k]]] for k in changed.tolist()],
            "people": _on_ground(people),
            "velocities": _on_ground(speeds),
            "dt": self._tick_s,
        }
        reply = self._node.ask({"tick": tick})
        return z_up(reply["places"])[:, :2], 1e-3 * float(reply["ms"])

    def close(self) -> None:
        self._node.close()


class Orca:
    """RVO2 by its Python binding: only what it takes to step is timed.

    It has no routes: it is given the direction of ours, outside of what is timed.
    """

    name = "ORCA"

    def __init__(self, crowd: Crowd) -> None:
        self._places = crowd.places
        self._routes = [Potential(crowd.grid, (x, y), 0, RADIUS_M) for x, y in crowd.places]
        self._random = np.random.default_rng(0)
        self._actors = len(crowd.starts)
        made = import_module("pyrvo").RVOSimulator()
        made.set_time_step(crowd.tick_s)
        looks = NEIGHBOUR_M, NEIGHBOURS, HORIZON_S, WALL_HORIZON_S
        made.set_agent_defaults(*looks, RADIUS_M, MAX_SPEED_MPS)
        for x, y in [*crowd.starts.tolist(), *crowd.people.tolist()]:
            made.add_agent((x, y))
        for k in range(self._actors, self._actors + len(crowd.people)):
            made.set_agent_max_neighbors(k, 0)
        x0, y0, x1, y1 = crowd.scene.bounds
        made.add_obstacle([(x0, y0), (x0, y1), (x1, y1), (x1, y0)])  # clockwise: from inside
        for solid in crowd.scene.solids():
            made.add_obstacle(list(solid.points))
        made.process_obstacles()
        self._simulator = made
        self._positions = crowd.starts.copy()

    def tick(
        self, goals: NDArray[np.int64], changed: NDArray[np.int64], people: Floats, speeds: Floats
    ) -> tuple[Floats, float]:
        del changed
        wishes = self._wishes(goals)
        made = self._simulator
        for k, wish in enumerate(wishes.tolist()):
            made.set_agent_pref_velocity(k, tuple(wish))
        walkers = zip(people.tolist(), speeds.tolist(), strict=True)
        for k, (place, velocity) in enumerate(walkers, start=self._actors):
            made.set_agent_position(k, tuple(place))
            made.set_agent_velocity(k, tuple(velocity))
            made.set_agent_pref_velocity(k, tuple(velocity))
        begun = time.process_time()
        made.do_step()
        took = time.process_time() - begun
        found: list[Any] = [made.get_agent_position(k) for k in range(self._actors)]
        self._positions = np.array([place.to_tuple() for place in found])
        return self._positions, took

    def close(self) -> None:
        self._simulator = None

    def _wishes(self, goals: NDArray[np.int64]) -> Floats:
        wishes = np.zeros_like(self._positions)
        for goal in np.unique(goals).tolist():
            rows = np.flatnonzero(goals == goal)
            level = np.zeros(len(rows))
            wishes[rows] = self._routes[goal].direction(self._positions[rows], level)
        shaken = self._random.uniform(-JITTER_MPS, JITTER_MPS, wishes.shape)
        wished: Floats = SPEED_MPS * wishes + shaken
        return wished


def orca_missing() -> str | None:
    """A message about what must be installed first; None if ORCA is there."""
    return None if find_spec("pyrvo") else "ORCA is absent: pip install pyrvo"


def movers_of(crowd: Crowd, intervals: Sequence[int]) -> tuple[list[Mover], list[str]]:
    """Ours at these planning intervals and those of others that are there; why others are not."""
    movers: list[Mover] = [Esplanade(crowd, interval) for interval in intervals]
    absent = [why for why in (recast_missing(), orca_missing()) if why]
    if recast_missing() is None:
        movers.append(DetourCrowd(crowd))
    if orca_missing() is None:
        movers.append(Orca(crowd))
    return movers, absent


def _on_ground(points: Floats) -> list[list[float]]:
    """Points (N, 2) of a level as Recast has them, y up."""
    level: list[list[float]] = y_up(np.column_stack([points, np.zeros(len(points))])).tolist()
    return level

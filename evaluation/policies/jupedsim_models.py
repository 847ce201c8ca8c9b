"""Models of the JuPedSim package, with the parameters they come with, as peers.

JuPedSim moves all of its agents itself. Here only the robot's next step is wanted, among people
who are where they are: so a simulation is made anew for every decision, everyone in it goes on
as they did, and after one tick the robot's way is read off.
"""

import contextlib
from collections.abc import Callable
from importlib import import_module
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.policies.policy import Person, Policy, PolicyError, Task, View

Floats = NDArray[np.float64]

MARGIN_M: Final = 10.0
WALL_M: Final = 0.02
"""JuPedSim has areas, not lines: walls become this thick, to each side."""
SEEN_M: Final = 8.0
AHEAD_S: Final = 2.0
"""People walk toward where they would be then."""
INNER_STEPS: Final = 10
SMALLEST_BODY: Final = (1.0, 0.6, 0.2)
"""Agents that would overlap are refused; they are tried again with these parts of the radius."""
STANDING_MPS: Final = 0.05


class JuPedSim(Policy):
    """One model; `agent` makes the parameters of an agent from place, velocity, speed, radius."""

    def __init__(self, jupedsim: Any, model: Any, agent: Callable[..., Any]) -> None:
        self._jupedsim = jupedsim
        self._model = model
        self._agent = agent
        self._shapely = import_module("shapely")

    def reset(self, task: Task) -> None:
        self._rules = task.rules
        shapely = self._shapely
        x0, y0, x1, y1 = task.replay.bounds
        area = shapely.box(x0 - MARGIN_M, y0 - MARGIN_M, x1 + MARGIN_M, y1 + MARGIN_M)
        walls = shapely.union_all(
            [shapely.LineString(wall).buffer(WALL_M) for wall in task.replay.obstacles.outline]
        )
        parts = getattr(area.difference(walls), "geoms", None) or [area.difference(walls)]
        start = shapely.Point(task.episode.start)
        self._area = min(parts, key=start.distance)
        shapely.prepare(self._area)

    def decide(self, view: View) -> Floats:
        simulation = self._jupedsim.Simulation(
            model=self._model, geometry=self._area, dt=self._rules.tick_s / INNER_STEPS
        )
        stage = simulation.add_direct_steering_stage()
        journey = simulation.add_journey(self._jupedsim.JourneyDescription([stage]))

        def add(
            position: Floats, velocity: Floats, speed_mps: float, radius_m: float, target: Floats
        ) -> int | None:
            for part in SMALLEST_BODY:
                parameters = self._agent(
                    position=_point(position),
                    velocity=_point(velocity),
                    desired_speed=speed_mps,
                    radius=part * radius_m,
                    journey_id=journey,
                    stage_id=stage,
                )
                try:
                    added = int(simulation.add_agent(parameters))
                except RuntimeError:
                    continue
                reachable = self._area.contains(self._shapely.Point(target))
                simulation.agent(added).target = _point(target if reachable else position)
                return added
            return None

        rules = self._rules
        robot = add(
            view.position, view.velocity, rules.speed_mps, rules.robot_radius_m, view.waypoint
        )
        if robot is None:
            way = view.waypoint - view.position
            return np.asarray(way * (rules.speed_mps / max(1e-9, float(np.hypot(*way)))))
        for person in sorted(
            view.people, key=lambda p: float(np.hypot(*(p.position - view.position)))
        ):
            if np.hypot(*(person.position - view.position)) < SEEN_M:
                velocity = _velocity(person, rules.tick_s)
                add(
                    person.position,
                    velocity,
                    max(STANDING_MPS, float(np.hypot(*velocity))),
                    rules.person_radius_m,
                    person.position + AHEAD_S * velocity,
                )
        # Forces between people who overlap can throw one of them out of the area, which ends it.
        with contextlib.suppress(RuntimeError):
            simulation.iterate(INNER_STEPS)
        moved = np.array(simulation.agent(robot).position) - view.position
        return np.asarray(moved / rules.tick_s)


def speed() -> JuPedSim:
    """The collision-free speed model."""
    jupedsim = _require()
    parameters = jupedsim.CollisionFreeSpeedModelAgentParameters
    return JuPedSim(jupedsim, jupedsim.CollisionFreeSpeedModel(), _without_velocity(parameters))


def anticipation() -> JuPedSim:
    """The anticipation velocity model."""
    jupedsim = _require()
    parameters = jupedsim.AnticipationVelocityModelAgentParameters
    return JuPedSim(
        jupedsim, jupedsim.AnticipationVelocityModel(rng_seed=0), _without_velocity(parameters)
    )


def forces() -> JuPedSim:
    """The social force model; the only one of these that takes the velocity of the moment."""
    jupedsim = _require()
    return JuPedSim(jupedsim, jupedsim.SocialForceModel(), jupedsim.SocialForceModelAgentParameters)


def _require() -> Any:
    try:
        return import_module("jupedsim")
    except ImportError:
        raise PolicyError(
            "policies of JuPedSim need the package jupedsim: install it, or everything of "
            "`esplanade[evaluate]`"
        ) from None


def _without_velocity(parameters: Callable[..., Any]) -> Callable[..., Any]:
    def make(*, velocity: object, **others: Any) -> Any:  # noqa: ARG001 - the model has none
        return parameters(**others)

    return make


def _point(values: Floats) -> tuple[float, float]:
    return float(values[0]), float(values[1])


def _velocity(person: Person, tick_s: float) -> Floats:
    if len(person.track) < 2:
        return np.zeros(2)
    return np.asarray((person.track[-1] - person.track[-2]) / tick_s)

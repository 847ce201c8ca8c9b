"""Models of the JuPedSim package with their default parameters, for comparison.

JuPedSim moves all of its agents itself. The evaluation needs only the next step of the robot
among people at given positions. Therefore each decision makes a new simulation, in which everyone
keeps their velocity, runs it for one tick, and takes the motion of the robot.
"""

import contextlib
from collections.abc import Callable
from importlib import import_module
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.policies.policy import Observation, Policy, Task
from esplanade.policies.errors import PolicyError

Floats = NDArray[np.float64]

MARGIN_M: Final = 10.0
"""The walkable area extends this far beyond the bounds of the recording."""
WALL_M: Final = 0.02
"""JuPedSim has areas, not lines: walls extend by this much to each side."""
SEEN_M: Final = 8.0
"""People farther from the robot than this are left out."""
AHEAD_S: Final = 2.0
"""The target of each person is the position predicted for this time ahead."""
INNER_STEPS: Final = 10
"""The number of time steps of JuPedSim in one tick."""
RADIUS_FACTORS: Final = (1.0, 0.6, 0.2)
"""JuPedSim refuses agents that overlap; they are tried with these fractions of their radius."""
STANDING_MPS: Final = 0.05
"""The desired speed of people who stand; it must be positive."""


class JuPedSim(Policy):
    """A policy that uses one model of JuPedSim.

    `agent` makes the parameters of an agent from its position, velocity, speed and radius.
    """

    def __init__(self, jupedsim: Any, model: Any, agent: Callable[..., Any]) -> None:
        self._jupedsim = jupedsim
        self._model = model
        self._agent = agent
        self._shapely = import_module("shapely")

    def reset(self, task: Task) -> None:
        self._rules = task.rules
        shapely = self._shapely
        x0, y0, x1, y1 = task.bounds
        area = shapely.box(x0 - MARGIN_M, y0 - MARGIN_M, x1 + MARGIN_M, y1 + MARGIN_M)
        walls = shapely.union_all(
            [shapely.LineString(wall).buffer(WALL_M) for wall in task.obstacles.outline]
        )
        parts = getattr(area.difference(walls), "geoms", None) or [area.difference(walls)]
        start = shapely.Point(task.start)
        self._area = min(parts, key=start.distance)
        shapely.prepare(self._area)

    def decide(self, observation: Observation) -> Floats:
        simulation = self._jupedsim.Simulation(
            model=self._model, geometry=self._area, dt=self._rules.tick_s / INNER_STEPS
        )
        stage = simulation.add_direct_steering_stage()
        journey = simulation.add_journey(self._jupedsim.JourneyDescription([stage]))

        def add(
            position: Floats, velocity: Floats, speed_mps: float, radius_m: float, target: Floats
        ) -> int | None:
            for factor in RADIUS_FACTORS:
                parameters = self._agent(
                    position=_point(position),
                    velocity=_point(velocity),
                    desired_speed=speed_mps,
                    radius=factor * radius_m,
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
            observation.position,
            observation.velocity,
            rules.speed_mps,
            rules.robot_radius_m,
            observation.waypoint,
        )
        if robot is None:
            offset = observation.waypoint - observation.position
            return np.asarray(offset * (rules.speed_mps / max(1e-9, float(np.hypot(*offset)))))
        for person in sorted(
            observation.people, key=lambda p: float(np.hypot(*(p.position - observation.position)))
        ):
            if np.hypot(*(person.position - observation.position)) < SEEN_M:
                velocity = person.velocity(rules.tick_s)
                add(
                    person.position,
                    velocity,
                    max(STANDING_MPS, float(np.hypot(*velocity))),
                    rules.person_radius_m,
                    person.position + AHEAD_S * velocity,
                )
        # Forces between people who overlap can push one of them out of the area. JuPedSim then
        # ends the simulation with an error, and the robot has moved less far.
        with contextlib.suppress(RuntimeError):
            simulation.iterate(INNER_STEPS)
        moved = np.array(simulation.agent(robot).position) - observation.position
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
    """The social force model; it is the only one of the three that takes current velocities."""
    jupedsim = _require()
    return JuPedSim(jupedsim, jupedsim.SocialForceModel(), jupedsim.SocialForceModelAgentParameters)


def _require() -> Any:
    try:
        return import_module("jupedsim")
    except ImportError:
        raise PolicyError(
            "policies of JuPedSim need the package jupedsim: install it, or everything of "
            "`esplanade[peers]`"
        ) from None


def _without_velocity(parameters: Callable[..., Any]) -> Callable[..., Any]:
    def make(*, velocity: object, **others: Any) -> Any:  # noqa: ARG001 - the model has none
        return parameters(**others)

    return make


def _point(values: Floats) -> tuple[float, float]:
    return float(values[0]), float(values[1])

"""ORCA, optimal reciprocal collision avoidance, by the RVO2 library, for comparison.

Van den Berg et al., "Reciprocal n-body collision avoidance" (2011). Each of two takes half of the
evasion, which recorded people do not do. Each decision makes a new simulation, and takes
only the robot's step from it.
"""

from collections.abc import Mapping
from importlib import import_module
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.policies.policy import Observation, Policy, Task
from esplanade.policies.errors import PolicyError

Floats = NDArray[np.float64]

SEEN_M: Final = 10.0
"""People farther from the robot than this are left out."""
NEIGHBOURS: Final = 16
"""The robot keeps clear of so many people, the nearest ones."""
OFF_AXIS_RAD: Final = 1e-3
"""The wanted velocity is turned by this, so that two who meet head-on do not stop for ever."""
SETTINGS: Final = {"horizon_s": 1.5, "wall_horizon_s": 1.0, "margin_m": 0.3}
"""The options: for how long the robot keeps clear of people and of walls, and the room that it
keeps beyond its own radius. The usual values cost least in a study of four recordings."""


class Orca(Policy):
    """Keeps for some seconds to velocities at which nobody is touched if the other does half."""

    def __init__(self, options: Mapping[str, Any] | None = None) -> None:
        """`options` are some of `SETTINGS`.

        Raises
        ------
        PolicyError
            The package is not installed, or an option is unknown or not a positive number.
        """
        self._settings = SETTINGS | _checked(options or {})
        try:
            self._simulator = import_module("pyrvo").RVOSimulator
        except ImportError:
            raise PolicyError(
                "the policy orca needs the package pyrvo: install it, or everything of "
                "`esplanade[peers]`"
            ) from None

    def reset(self, task: Task) -> None:
        self._rules = task.rules
        self._walls = [[tuple(end) for end in wall] for wall in task.obstacles.outline.tolist()]

    def decide(self, observation: Observation) -> Floats:
        rules, made = self._rules, self._empty()
        robot = made.add_agent(_point(observation.position))
        made.set_agent_radius(robot, rules.robot_radius_m + self._settings["margin_m"])
        made.set_agent_velocity(robot, _point(observation.velocity))
        made.set_agent_pref_velocity(robot, _point(self._wish(observation)))
        for person in observation.people:
            if np.hypot(*(person.position - observation.position)) < SEEN_M:
                other = made.add_agent(_point(person.position))
                made.set_agent_velocity(other, _point(person.velocity(rules.tick_s)))
        made.do_step()
        return np.array(made.get_agent_velocity(robot).to_tuple())

    def _empty(self) -> Any:
        """A simulation of walls alone; one that has had agents does not forget their order."""
        rules, settings = self._rules, self._settings
        made = self._simulator()
        made.set_time_step(rules.tick_s)
        horizons_s = settings["horizon_s"], settings["wall_horizon_s"]
        made.set_agent_defaults(
            SEEN_M, NEIGHBOURS, *horizons_s, rules.person_radius_m, rules.max_speed_mps
        )
        for wall in self._walls:
            made.add_obstacle(wall)
        made.process_obstacles()
        return made

    def _wish(self, observation: Observation) -> Floats:
        offset = observation.waypoint - observation.position
        left_m = float(np.hypot(*offset))
        speed_mps = min(self._rules.speed_mps, left_m / self._rules.tick_s)
        cos, sin = np.cos(OFF_AXIS_RAD), np.sin(OFF_AXIS_RAD)
        turned = np.array([cos * offset[0] - sin * offset[1], sin * offset[0] + cos * offset[1]])
        return np.asarray(turned * (speed_mps / max(left_m, 1e-9)))


def _checked(options: Mapping[str, Any]) -> dict[str, float]:
    for name, value in options.items():
        if name not in SETTINGS:
            raise PolicyError(f"the policy orca has no option {name}; there are {_NAMES}")
        number = isinstance(value, int | float) and not isinstance(value, bool)
        if not number or not 0.0 < value < 100.0:
            raise PolicyError(f"the policy orca: {name}={value!r} is no number from 0 to 100")
    return {name: float(value) for name, value in options.items()}


_NAMES: Final = ", ".join(SETTINGS)


def _point(values: Floats) -> tuple[float, float]:
    return float(values[0]), float(values[1])

"""The project's own actor, whose navigator this simulation drives tick by tick."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from esplanade.actors import ActorParameters, Navigator
from esplanade.evaluation.obstacles import ObstacleSet
from esplanade.evaluation.policies.policy import DebugInfo, Observation, Policy, Task
from esplanade.evaluation.rules import Rules
from esplanade.evaluation.settings import models_of, parameters_of
from esplanade.planning import LayeredGrid, Scene
from esplanade.policies.errors import PolicyError

MARGIN_M: Final = 10.0
"""The ground extends this far beyond the bounds of the recording."""
DRAWN_WITHIN_M: Final = 8.0
"""Predictions are drawn for people within this distance."""
DRAWN_EVERY_S: Final = 0.8
"""Seconds between the predicted circles that are drawn."""
DRAWN_SIGMAS: Final = 2.0
"""The radius of a predicted circle in deviations."""
UNLIMITED_MPS2: Final = 20.0
"""The actor's limit of acceleration where the rules have none."""

_ACTOR: Final = "robot"


class Esplanade(Policy):
    """A policy that asks `actors.Navigator` for the next velocity of a single actor.

    The simulation places the actor in every tick. The grid is made once for a recording, a
    navigator for each episode. Before its first decision the navigator observes the visible past,
    since in a running world it would have observed it too.
    """

    def __init__(self, settings: Mapping[str, Any] | None = None) -> None:
        self._settings = dict(settings or {})
        self._models = models_of(self._settings)
        self._obstacles: ObstacleSet | None = None
        self._navigator: Navigator | None = None

    def reset(self, task: Task) -> None:
        if self._obstacles is not task.obstacles:
            self._grid = LayeredGrid.from_scene(_scene(task))
            self._obstacles = task.obstacles
        if self._navigator is not None:
            self._navigator.close()
        self._navigator = Navigator(
            self._grid,
            tick_s=task.rules.tick_s,
            plan=replace(self._models.plan, threads=1),
            risk=self._models.risk,
            prediction=self._models.prediction,
            rules=self._models.rules,
        )
        self._navigator.add_actor(
            _ACTOR, task.start, task.goal, _parameters(task.rules, self._settings)
        )
        self._first_decision = True

    def decide(self, observation: Observation) -> NDArray[np.float64]:
        navigator = self._running
        if self._first_decision:
            self._observe_past(observation)
            self._first_decision = False
        position, velocity = self._within_bounds(observation.position), observation.velocity
        navigator.place_actor(_ACTOR, position, (float(velocity[0]), float(velocity[1])))
        navigator.observe({person.id: person.position for person in observation.people})
        self._state = navigator.tick()[_ACTOR]
        return np.array(self._state.velocity)

    def debug_info(self) -> DebugInfo:
        circles = [
            np.column_stack([future[::every, :2], DRAWN_SIGMAS * future[::every, 3]])
            for every in [max(1, round(DRAWN_EVERY_S / self._running.plan.slice_s))]
            for future in self._running.predicted_near(self._state.position, 0, DRAWN_WITHIN_M)
        ]
        return DebugInfo(self._state.way[:, :2], np.concatenate([np.zeros((0, 3)), *circles]))

    @property
    def _running(self) -> Navigator:
        if self._navigator is None:
            raise RuntimeError("call reset before the first decision")
        return self._navigator

    def _observe_past(self, observation: Observation) -> None:
        longest = max((len(person.track) for person in observation.people), default=1)
        for back in range(longest, 1, -1):
            self._running.observe(
                {p.id: tuple(p.track[-back]) for p in observation.people if len(p.track) >= back}
            )

    def _within_bounds(self, position: NDArray[np.float64]) -> tuple[float, float]:
        x0, y0, x1, y1 = self._grid.bounds
        x, y = np.clip(position, (x0, y0), (x1, y1)).tolist()
        return x, y


def _scene(task: Task) -> Scene:
    x0, y0, x1, y1 = task.bounds
    bounds = (x0 - MARGIN_M, y0 - MARGIN_M, x1 + MARGIN_M, y1 + MARGIN_M)
    try:
        return Scene.open_space(bounds, task.obstacles.obstacles.as_walls(), name=task.place)
    except ValidationError as error:
        message = error.errors()[0]["msg"]
        raise PolicyError(f"{task.place} cannot be made into a scene: {message}") from None


def _parameters(rules: Rules, settings: Mapping[str, Any]) -> ActorParameters:
    limit_mps2 = rules.max_acceleration_mps2
    given = {
        "radius_m": rules.robot_radius_m,
        "speed_mps": rules.speed_mps,
        "max_speed_mps": rules.max_speed_mps,
        "max_acceleration_mps2": UNLIMITED_MPS2 if limit_mps2 is None else limit_mps2,
    }
    return parameters_of(settings, given)

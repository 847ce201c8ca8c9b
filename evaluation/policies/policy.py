"""The interface of policies: from an observation, a policy decides the robot's velocity."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, ClassVar

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.rules import Rules

if TYPE_CHECKING:  # a policy from outside runs in a process that has nothing of a recording
    from esplanade.evaluation.episodes import Episode
    from esplanade.evaluation.obstacles import ObstacleSet
    from esplanade.evaluation.replay import Replay

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Person:
    """One person within range of the robot's sensor."""

    id: int
    track: Floats
    """The positions tick by tick, the newest last, float64 (n, 2), metres, n >= 1."""

    @property
    def position(self) -> Floats:
        return np.asarray(self.track[-1])

    def velocity(self, tick_s: float) -> Floats:
        """The velocity over the last tick, (2,) m/s; zero for somebody who has just come."""
        if len(self.track) < 2:
            return np.zeros(2)
        return np.asarray((self.track[-1] - self.track[-2]) / tick_s)


@dataclass(frozen=True)
class Observation:
    """The input of a policy at one tick; positions are (2,) metres, velocities (2,) m/s."""

    t: float
    """The seconds since the episode began."""
    position: Floats
    velocity: Floats
    waypoint: Floats
    """The goal, or the next point of the path to it if walls hide the goal."""
    people: list[Person]
    """The people within range."""


@dataclass(frozen=True)
class Task:
    """The trip that a policy is reset for; places are (x, y) in metres.

    Nothing of the future is in it. The reference policies `oracle` and `human` are shown that
    apart, by `Prescient.foresee`.
    """

    rules: Rules
    place: str
    """The name of the recording."""
    obstacles: ObstacleSet
    bounds: tuple[float, float, float, float]
    """The bounds of the recording: x0, y0, x1, y1 in metres."""
    start: tuple[float, float]
    goal: tuple[float, float]


@dataclass(frozen=True)
class DebugInfo:
    """The plan and predictions behind a decision, for drawing."""

    path: Floats = field(default_factory=lambda: np.zeros((0, 2)))
    """The planned path, float64 (K, 2), metres."""
    circles: Floats = field(default_factory=lambda: np.zeros((0, 3)))
    """The circles in which people are predicted: x, y and radius, float64 (n, 3), metres."""


class Policy(ABC):
    """Decides for one robot. No decision may depend on anything before the last `reset`."""

    follows_recording: ClassVar[bool] = False
    """Whether the policy repeats the recorded trajectory; then the limits of speed and
    acceleration do not apply, and there are no reversed trips."""

    def start(self) -> None:  # noqa: B027 - most policies need nothing
        """Begin what the policy needs, such as a process.

        Raises
        ------
        PolicyError
            The policy cannot be used here.
        """

    @abstractmethod
    def reset(self, task: Task) -> None:
        """Begin an episode."""

    @abstractmethod
    def decide(self, observation: Observation) -> Floats:
        """The wanted velocity, float64 (2,), m/s."""

    def debug_info(self) -> DebugInfo:
        """The plan and predictions of the last decision, if the policy has any."""
        return DebugInfo()

    def close(self) -> None:  # noqa: B027 - most policies need nothing
        """End what the policy has started, such as a process. It is not used afterwards."""


class Prescient(Policy):
    """A reference policy, which is shown the whole recording before each episode."""

    @abstractmethod
    def foresee(self, replay: Replay, episode: Episode) -> None:
        """Look at the recording, with its future, and the episode that begins next."""

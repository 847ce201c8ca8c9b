"""The interface of policies: from an observation, a policy decides the robot's velocity."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.episodes import Episode
from esplanade.evaluation.replay import Replay
from esplanade.evaluation.rules import Rules

Floats = NDArray[np.float64]


class PolicyError(Exception):
    """A policy cannot be used here; the message says why, and what helps."""


@dataclass(frozen=True)
class Person:
    """One person within range of the robot's sensor."""

    id: int
    track: Floats
    """The positions tick by tick, the newest last, float64 (n, 2), metres, n >= 1."""

    @property
    def position(self) -> Floats:
        return np.asarray(self.track[-1])


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
    """The episode that a policy is reset for.

    `replay` and `episode` contain the future. Only the reference policies `oracle` and `human` use
    it; all others may use nothing but walls, bounds, start and goal.
    """

    rules: Rules
    replay: Replay
    episode: Episode


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

    @abstractmethod
    def reset(self, task: Task) -> None:
        """Begin an episode."""

    @abstractmethod
    def decide(self, observation: Observation) -> Floats:
        """The wanted velocity, float64 (2,), m/s."""

    def debug_info(self) -> DebugInfo:
        """The plan and predictions of the last decision, if the policy has any."""
        return DebugInfo()

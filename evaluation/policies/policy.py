"""What a policy is: told where it is and who is around, it says how it wants to move."""

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
    """A policy cannot be had here; the message says why and what helps."""


@dataclass(frozen=True)
class Person:
    """Somebody in sight: `track` holds their places tick by tick, newest last, (n, 2), n >= 1."""

    id: int
    track: Floats

    @property
    def position(self) -> Floats:
        return np.asarray(self.track[-1])


@dataclass(frozen=True)
class View:
    """What is known at one tick."""

    t: float
    """Seconds since the episode began."""
    position: Floats
    velocity: Floats
    waypoint: Floats
    """The goal, or where walls hide it, the next point of the way there."""
    people: list[Person]


@dataclass(frozen=True)
class Task:
    """What is known before an episode begins.

    `replay` and `episode` hold the future too. Only reference policies look at it; all others
    take nothing from them but walls and bounds.
    """

    rules: Rules
    replay: Replay
    episode: Episode


@dataclass(frozen=True)
class Thoughts:
    """What a policy expects, to be drawn: its path (K, 2), and circles x, y, radius (n, 3)."""

    path: Floats = field(default_factory=lambda: np.zeros((0, 2)))
    circles: Floats = field(default_factory=lambda: np.zeros((0, 3)))


class Policy(ABC):
    """Decides for one robot at a time. What it decides depends on nothing before `reset`."""

    follows_recording: ClassVar[bool] = False
    """Walks the recorded way itself: limits do not hold, and there are no reversed trips."""

    @abstractmethod
    def reset(self, task: Task) -> None:
        """Begin an episode."""

    @abstractmethod
    def decide(self, view: View) -> Floats:
        """The wanted velocity, (2,) m/s."""

    def thoughts(self) -> Thoughts:
        """What the last decision was made of, if it can be drawn."""
        return Thoughts()

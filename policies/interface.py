"""The interface of policies from outside: what they are given, and what they answer.

Lengths are metres, times seconds, velocities m/s; places and velocities are float64 (2,), x and y
in the frame of the recording.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Person:
    """One person within range of the robot's sensor."""

    id: int
    """A number that stays the same during an episode, and means nothing beyond it."""
    position: Floats
    velocity: Floats
    """Over the last tick; zero for somebody who has just come."""
    radius: float
    past: Floats
    """The positions tick by tick, the newest last, float64 (n, 2), n >= 1."""


@dataclass(frozen=True)
class Observation:
    """The robot's view at one tick."""

    time_s: float
    """The seconds since the episode began."""
    position: Floats
    velocity: Floats
    """That of the last tick, as limits of speed and acceleration let the robot walk."""
    goal: Floats
    waypoint: Floats
    """The goal, or the next point of the shortest path to it if walls hide the goal."""
    people: list[Person]


@dataclass(frozen=True)
class Task:
    """The trip that begins, and the body that is to make it."""

    tick_s: float
    start: Floats
    goal: Floats
    goal_tolerance: float
    """The trip ends this near to the goal."""
    radius: float
    preferred_speed: float
    greatest_speed: float
    greatest_acceleration: float | None
    """None if there is no limit, in m/s²."""
    walls: Floats
    """Straight walls from one end to the other, float64 (M, 2, 2)."""
    bounds: tuple[float, float, float, float]
    """x0, y0, x1, y1 of everything that was recorded."""


class Velocities(Protocol):
    """The one method that a policy must have.

    It may also have `reset(task: Task)`, which is called before each episode, and
    `explain() -> Mapping`, which is called for pictures and may hold `path` (K, 2) and `circles`
    (n, 3), each x, y and radius. Options of the command line are keywords of the constructor.
    """

    def velocity(self, observation: Observation) -> tuple[float, float]:
        """The velocity (2,) at which the robot wants to walk now."""


class Goals(Protocol):
    """The method of a policy that decides where a live actor goes, instead of how, or beside it."""

    def goal(self, observation: Observation) -> tuple[float, ...] | None:
        """The next goal, x and y, or x, y and the height of the floor; None to be asked later.

        It is asked when the actor has no trip, or its trip has ended; `observation.goal` is then
        where the actor stands.
        """

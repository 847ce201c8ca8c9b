"""Several robots among people who were recorded, and may react, tick by tick."""

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.episodes import Episode
from esplanade.evaluation.learning.features import features
from esplanade.evaluation.people import crowd_of
from esplanade.evaluation.rules import Rules
from esplanade.evaluation.simulation import Environment, limit_velocity
from esplanade.evaluation.waypoints import WallMap, Waypoints

Floats = NDArray[np.float64]


class Outcome(StrEnum):
    """The end of a trip."""

    REACHED = "reached"
    TOUCHED = "touched"
    """Somebody, or another robot, was touched."""
    WALL = "wall"
    LATE = "late"


@dataclass
class Robot:
    """One robot on its trip; places and velocities are float64 (2,), metres and m/s."""

    episode: Episode
    goal: Floats
    waypoints: Waypoints
    position: Floats
    velocity: Floats
    waypoint: Floats
    advance_m: float = 0.0
    """The metres by which the last tick has led toward the waypoint."""
    gap_m: float = np.inf
    """The least distance between surfaces to anybody in the last tick."""
    outcome: Outcome | None = None


class Robots:
    """Robots that begin at one tick, each in the place of a recorded person.

    The rules are those of an episode of `evaluate`, but that a trip ends with the first contact.
    A robot whose trip has ended is gone.
    """

    def __init__(self, environment: Environment, rules: Rules, episodes: Sequence[Episode]) -> None:
        self._environment = environment
        self._rules = rules
        reaction = rules.reaction if rules.people == "reacting" else 0.0
        crowd = _crowd_of(environment.replay, reaction, rules.people_seed)
        self._first_tick = episodes[0].first_tick
        self._walk = crowd.begin(self._first_tick, [each.pedestrian for each in episodes])
        self.all = [self._begun(episode) for episode in episodes]
        self._walking = list(self.all)
        self._before: tuple[NDArray[np.int64], Floats] = (self._walk.present, self._walk.positions)
        self._velocities = np.zeros_like(self._before[1])

    @property
    def time_s(self) -> float:
        """The seconds since all began."""
        return (self._walk.tick - self._first_tick) * self._rules.tick_s

    def _begun(self, episode: Episode) -> Robot:
        goal, start = np.array(episode.goal), np.array(episode.start)
        waypoints = _waypoints_to(self._environment.wall_map, episode.goal)
        at = waypoints.next_from(start)
        return Robot(episode, goal, waypoints, start, np.zeros(2), at)

    def features(self, robot: Robot, nearest: int) -> NDArray[np.float32]:
        """The people, and the robots that walked in the last tick, as a robot sees them."""
        others = [each for each in self._walking if each is not robot]
        places, velocities = self._before[1], self._velocities
        if others:
            places = np.concatenate([places, [r.position for r in others]])
            velocities = np.concatenate([velocities, [r.velocity for r in others]])
        return features(
            robot.position,
            robot.velocity,
            robot.waypoint,
            robot.goal,
            self._environment.wall_map.walls,
            places,
            velocities,
            nearest,
        )

    def step(self, wanted: Sequence[Floats | None]) -> None:
        """Walk for one tick; `wanted` has a velocity (2,), m/s, for each robot that still walks."""
        rules, walk = self._rules, self._walk
        going = [robot for robot in self.all if robot.outcome is None]
        self._walking = going
        starts = np.array([robot.position for robot in going])
        for robot, velocity in zip(self.all, wanted, strict=True):
            if robot.outcome is None and velocity is not None:
                robot.velocity = limit_velocity(rules, robot.velocity, velocity)
        moves = np.array([robot.velocity for robot in going])
        radii = np.full((len(going), 1), rules.robot_radius_m)
        stand_ins = [-1 if r.episode.reverse else r.episode.pedestrian for r in going]
        walk.step(np.hstack([starts, moves, radii]), stand_ins)
        present, before = self._before
        stays, now = _matched(present, walk.present)
        changes = walk.positions[now] - before[stays]
        for k, robot in enumerate(going):
            others = np.delete(starts, k, 0), np.delete(moves, k, 0) * rules.tick_s
            self._advance(robot, before[stays], changes, *others)
        self._leave_out_who_pops_in(going)
        self._before = (walk.present, walk.positions)
        stays, now = _matched(present, walk.present)
        self._velocities = np.zeros_like(self._before[1])
        self._velocities[now] = (self._before[1][now] - before[stays]) / rules.tick_s

    def _advance(
        self, robot: Robot, places: Floats, changes: Floats, others: Floats, moves: Floats
    ) -> None:
        """Move a robot, and judge its trip."""
        rules, replay = self._rules, self._environment.replay
        move = robot.velocity * rules.tick_s
        offsets = np.concatenate([places, others]) - robot.position
        passed = np.concatenate([changes, moves]) - move
        robot.gap_m = _closest(offsets, passed) - rules.contact_m
        before = robot.waypoint - robot.position
        robot.advance_m = float(move @ before) / max(1e-9, float(np.hypot(*before)))
        robot.position = robot.position + move
        robot.waypoint = robot.waypoints.next_from(robot.position)
        wall_m = replay.obstacles.distance(robot.position) - rules.robot_radius_m
        if robot.gap_m < 0.0:
            robot.outcome = Outcome.TOUCHED
        elif wall_m < -rules.wall_overlap_m:
            robot.outcome = Outcome.WALL
        elif np.hypot(*(robot.goal - robot.position)) <= rules.goal_tolerance_m:
            robot.outcome = Outcome.REACHED
        elif self.time_s >= rules.time_limit_s - 1e-9:
            robot.outcome = Outcome.LATE

    def _leave_out_who_pops_in(self, going: Sequence[Robot]) -> None:
        """Leave out people who appear beside a robot, which nothing could foresee."""
        walk, first = self._walk, self._environment.replay.first
        new = walk.present[first[walk.present] == walk.tick]
        for person in new.tolist():
            place = self._environment.replay.at(person, walk.tick)
            if min(np.hypot(*(place - r.position)) for r in going) < self._rules.pop_in_m:
                walk.leave_out(person)


def _matched(
    before: NDArray[np.int64], after: NDArray[np.int64]
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """The rows in two ascending lists of the people who are in both."""
    _, first, second = np.intersect1d(before, after, assume_unique=True, return_indices=True)
    return first, second


def _closest(offsets: Floats, passed: Floats) -> float:
    """The least distance while offsets (n, 2) change evenly by `passed` (n, 2), metres."""
    if not len(offsets):
        return np.inf
    squares = np.maximum(np.einsum("ij,ij->i", passed, passed), 1e-12)
    parts = np.clip(-np.einsum("ij,ij->i", offsets, passed) / squares, 0.0, 1.0)
    nearest = offsets + parts[:, None] * passed
    return float(np.sqrt(np.einsum("ij,ij->i", nearest, nearest).min()))


@lru_cache(maxsize=32)
def _waypoints_to(wall_map: WallMap, goal: tuple[float, float]) -> Waypoints:
    """The way to a goal; kept, as learners often walk the same trips one after the other."""
    return Waypoints(wall_map, np.array(goal))


_crowd_of = lru_cache(maxsize=8)(crowd_of)
"""The people of a replay, made once."""

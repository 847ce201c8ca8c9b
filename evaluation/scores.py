"""The score of one episode, and the summary of many."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.contacts import ContactMonitor
from esplanade.evaluation.episodes import Episode
from esplanade.evaluation.replay import Replay
from esplanade.evaluation.rules import Rules

Floats = NDArray[np.float64]

WALKING_MPS = 0.2
"""Below this speed the direction of walking is not defined."""


@dataclass(frozen=True)
class Score:
    """The score of one episode. Units are in the names; nan means that nothing was measured."""

    number: int
    pedestrian: str
    start_s: float
    reverse: bool
    people_touched: int
    moved_toward: bool
    """Whether the robot moved toward the person in at least one contact."""
    clearance_m: float
    near_s: float
    reached: bool
    time_s: float
    time_ratio: float
    path_ratio: float
    wall_contact: bool
    pop_ins: int
    displacement_m: float
    """The sum over people of the greatest distance between where each person was and where that
    person would have been without the robot, metres; 0 if people do not react."""
    acceleration_max_mps2: float
    acceleration_rms_mps2: float
    jerk_rms_mps3: float
    turn_rms_radps: float
    decisions: int
    decision_ms: float
    decision_max_ms: float
    jerk_mean_mps3: float = math.nan
    turning_radpm: float = math.nan
    """The sum of all turns for each metre walked."""
    time_to_collision_s: float = math.nan
    intimate_s: float = math.nan
    personal_s: float = math.nan
    social_s: float = math.nan
    groups_entered: float = math.nan
    force_work_mps: float = math.nan
    stalled_s: float = math.nan
    imposed_delay_s: float = 0.0
    imposed_peak_mps2: float = 0.0
    gave_way: int = 0
    """Of these three `esplanade.evaluation.people.Imposed` says more."""
    fault: str = ""
    """How the policy failed in the middle of the episode; empty if it did not."""

    @property
    def touched(self) -> bool:
        return self.people_touched > 0

    @property
    def failed(self) -> bool:
        return self.touched or not self.reached


def score(
    replay: Replay,
    rules: Rules,
    episode: Episode,
    contacts: ContactMonitor,
    pop_ins: int,
    trajectory: Floats,
    velocities: Floats,
    wall_m: float,
    reached: bool,
    decide_s: Sequence[float],
) -> Score:
    """Score an episode of T ticks.

    Parameters
    ----------
    contacts : the contacts and clearances of the episode
    pop_ins : number of people who were left out because they appeared beside the robot
    trajectory : float64 (T + 1, 2), metres
    velocities : float64 (T, 2), m/s
    wall_m : smallest distance of the robot's centre from a wall, metres
    reached : whether the robot arrived at the goal
    decide_s : the time that each decision took, seconds
    """
    to_go_m = episode.distance_m - rules.goal_tolerance_m
    time_s = len(velocities) * rules.tick_s if reached else np.nan
    straight_s = max(rules.tick_s, to_go_m / rules.speed_mps)
    walked_m = float(np.linalg.norm(np.diff(trajectory, axis=0), axis=1).sum())
    accelerations = np.linalg.norm(np.diff(velocities, axis=0), axis=1) / rules.tick_s
    jerks = np.linalg.norm(np.diff(velocities, n=2, axis=0), axis=1) / rules.tick_s**2
    turns = _turns(velocities)
    return Score(
        number=episode.number,
        pedestrian=replay.ids[episode.pedestrian],
        start_s=episode.first_tick * rules.tick_s,
        reverse=episode.reverse,
        people_touched=len(contacts.touched),
        moved_toward=contacts.active > 0,
        clearance_m=contacts.clearance_m,
        near_s=contacts.near_s,
        reached=reached,
        time_s=time_s,
        time_ratio=time_s / straight_s,
        path_ratio=walked_m / max(1e-9, to_go_m) if reached else np.nan,
        wall_contact=wall_m < rules.robot_radius_m - rules.wall_overlap_m,
        pop_ins=pop_ins,
        displacement_m=0.0,
        acceleration_max_mps2=float(accelerations.max(initial=0.0)),
        acceleration_rms_mps2=_rms(accelerations),
        jerk_rms_mps3=_rms(jerks),
        turn_rms_radps=_rms(turns / rules.tick_s),
        decisions=len(decide_s),
        decision_ms=float(np.mean(decide_s or [0.0])) * 1e3,
        decision_max_ms=float(np.max(decide_s or [0.0])) * 1e3,
        jerk_mean_mps3=float(np.mean(jerks)) if len(jerks) else 0.0,
        turning_radpm=float(turns.sum()) / max(1e-9, walked_m),
    )


def _turns(velocities: Floats) -> Floats:
    """Angles between velocities of neighbouring ticks, radians, if the robot walks at both."""
    walking = np.linalg.norm(velocities, axis=1) > WALKING_MPS
    headings = np.arctan2(velocities[:, 1], velocities[:, 0])
    turns = np.abs((np.diff(headings) + np.pi) % (2.0 * np.pi) - np.pi)
    return np.asarray(turns[walking[1:] & walking[:-1]])


def _rms(values: Floats) -> float:
    return float(np.sqrt(np.mean(values**2))) if len(values) else 0.0


@dataclass(frozen=True)
class Summary:
    """The summary of many episodes; ratios of time and path are over those that arrived."""

    episodes: int
    contacts_percent: float
    moved_toward_percent: float
    clearance_m: float
    near_s: float
    reached_percent: float
    time_ratio: float
    path_ratio: float
    wall_contacts_percent: float
    displacement_m: float
    """The mean over episodes of what the robot imposed on people."""
    acceleration_max_mps2: float
    """The median of the episodes' greatest accelerations."""
    turn_rms_radps: float
    decision_ms: float
    decision_max_ms: float
    faults_percent: float
    """Episodes that ended because the policy failed."""


def summarise(scores: Sequence[Score]) -> Summary:
    """Summarise the scores of at least one episode."""
    decisions = max(1, sum(s.decisions for s in scores))
    return Summary(
        episodes=len(scores),
        contacts_percent=_percent([s.touched for s in scores]),
        moved_toward_percent=_percent([s.moved_toward for s in scores]),
        clearance_m=float(np.mean([s.clearance_m for s in scores])),
        near_s=float(np.mean([s.near_s for s in scores])),
        reached_percent=_percent([s.reached for s in scores]),
        time_ratio=_mean([s.time_ratio for s in scores if s.reached]),
        path_ratio=_mean([s.path_ratio for s in scores if s.reached]),
        wall_contacts_percent=_percent([s.wall_contact for s in scores]),
        displacement_m=float(np.mean([s.displacement_m for s in scores])),
        acceleration_max_mps2=float(np.median([s.acceleration_max_mps2 for s in scores])),
        turn_rms_radps=float(np.mean([s.turn_rms_radps for s in scores])),
        decision_ms=sum(s.decision_ms * s.decisions for s in scores) / decisions,
        decision_max_ms=max(s.decision_max_ms for s in scores),
        faults_percent=_percent([bool(s.fault) for s in scores]),
    )


def _percent(found: Sequence[bool]) -> float:
    return 100.0 * sum(found) / len(found)


def _mean(values: Sequence[float]) -> float:
    return float(np.mean(values)) if values else float("nan")

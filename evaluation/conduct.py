"""The conduct of a robot among people over one episode, by the figures of the guidelines.

A. Francis et al., "Principles and guidelines for evaluating social robot navigation algorithms"
(2023), collect these figures; `guidelines` has the source of each.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.policies.policy import Person
from esplanade.evaluation.rules import Rules
from esplanade.pedestrians.compiled._force_kernels import evasion
from esplanade.pedestrians.model import SocialForce

Floats = NDArray[np.float64]

COLLISION_CAP_S: Final = 10.0
"""A collision later than this counts as one in so many seconds."""
INTIMATE_M, PERSONAL_M, SOCIAL_M = 0.45, 1.2, 3.6
"""The ends of the proxemic zones, between surfaces."""
GROUP_M: Final = 1.5
GROUP_S: Final = 2.0
"""Two people are a group who have been within `GROUP_M` of each other for so long."""
FORCES_WITHIN_M: Final = 5.0
STALLED_MPS: Final = 0.1
_MODEL: Final = SocialForce(unseen=1.0)
_NUMBERS: Final = _MODEL.numbers(tick_s=1.0)


@dataclass(frozen=True)
class Figures:
    """The figures of one episode; units are in the names."""

    time_to_collision_s: float
    intimate_s: float
    personal_s: float
    social_s: float
    groups_entered: int
    force_work_mps: float
    stalled_s: float


class Conduct:
    """Takes account of a robot's steps, and of the people around it at the beginning of each."""

    def __init__(self, rules: Rules) -> None:
        self._rules = rules
        self._collision_s = COLLISION_CAP_S
        self._zones_s = np.zeros(3)
        self._groups: set[tuple[int, int]] = set()
        self._work_mps = 0.0
        self._stalled_s = 0.0

    def step(self, people: Sequence[Person], position: Floats, velocity: Floats) -> None:
        """Take account of a tick in which the robot moves from `position` at `velocity`, (2,)."""
        tick_s = self._rules.tick_s
        self._stalled_s += tick_s * (float(np.hypot(*velocity)) < STALLED_MPS)
        if not people:
            return
        offsets = np.array([person.position for person in people]) - position
        moving = np.array([person.velocity(tick_s) for person in people])
        away = np.hypot(*offsets.T)
        until_s = collisions(offsets, moving - velocity, self._rules.contact_m)
        self._collision_s = min(self._collision_s, float(until_s.min()))
        apart = float(away.min()) - self._rules.contact_m
        ends = np.array([INTIMATE_M, PERSONAL_M, SOCIAL_M])
        zone = int(np.searchsorted(ends, apart, side="right"))
        if zone < len(ends):
            self._zones_s[zone] += tick_s
        near = away < FORCES_WITHIN_M
        own = np.broadcast_to(velocity, moving[near].shape)
        on_robot = forces(offsets[near], own, moving[near]).sum(axis=0)
        on_people = forces(-offsets[near], moving[near], own)
        both = float(np.hypot(*on_robot)) + float(np.hypot(*on_people.T).sum())
        self._work_mps += tick_s * both
        close = [person for person, far in zip(people, away, strict=True) if far < GROUP_M]
        self._groups |= groups_around(close, position, self._rules)

    def figures(self) -> Figures:
        """The figures of the steps so far."""
        intimate_s, personal_s, social_s = self._zones_s.tolist()
        return Figures(
            self._collision_s,
            intimate_s,
            personal_s,
            social_s,
            len(self._groups),
            self._work_mps,
            self._stalled_s,
        )


def collisions(offsets: Floats, velocities: Floats, contact_m: float) -> Floats:
    """Seconds until bodies at `offsets` (n, 2) that move at these velocities (n, 2) are touched.

    Both are relative, in metres and m/s. It is inf for those that never are, 0 for those that are.
    """
    squared = (velocities**2).sum(axis=1)
    closing = (offsets * velocities).sum(axis=1)
    room = (offsets**2).sum(axis=1) - contact_m**2
    inside = closing**2 - squared * room
    meets = (closing < 0.0) & (inside >= 0.0) & (squared > 1e-12)
    later = (-closing - np.sqrt(np.where(meets, inside, 0.0))) / np.where(meets, squared, 1.0)
    return np.where(room <= 0.0, 0.0, np.where(meets, later, np.inf))


def forces(offsets: Floats, own: Floats, others: Floats) -> Floats:
    """The social forces on bodies by bodies at `offsets` (n, 2) from them, float64 (n, 2), m/s².

    `own` and `others` are their velocities, (n, 2). They are the evasions of people who react, to
    all sides alike.
    """
    rows = np.concatenate([offsets, own, others], axis=1).tolist()
    found = [
        evasion(x, y, vx, vy, other_vx, other_vy, 0.0, _NUMBERS)
        for x, y, vx, vy, other_vx, other_vy in rows
    ]
    return _MODEL.strength_mps2 * np.array(found).reshape(-1, 2)


def groups_around(people: Sequence[Person], position: Floats, rules: Rules) -> set[tuple[int, int]]:
    """The pairs of people who are a group and between whom the robot is at `position` (2,)."""
    ticks = round(GROUP_S / rules.tick_s)
    known = [person for person in people if len(person.track) >= ticks]
    found = set()
    for n, one in enumerate(known):
        for other in known[n + 1 :]:
            apart = np.hypot(*(one.track[-ticks:] - other.track[-ticks:]).T)
            if apart.max() < GROUP_M and _between(one, other, position, rules.robot_radius_m):
                found.add((min(one.id, other.id), max(one.id, other.id)))
    return found


def _between(one: Person, other: Person, position: Floats, radius_m: float) -> bool:
    """Whether a disc meets the line from one person to another, and not beyond either."""
    along = other.position - one.position
    length_m = max(1e-9, float(np.hypot(*along)))
    offset = position - one.position
    share = float(offset @ along) / length_m**2
    aside_m = abs(along[0] * offset[1] - along[1] * offset[0]) / length_m
    return bool(0.0 < share < 1.0 and aside_m < radius_m)

"""The behaviour of walking after somebody."""

from __future__ import annotations

import math

from esplanade.actors.behaviour import Behaviour, Goal, Perception
from esplanade.planning.scene.heights import SAME_FLOOR_M

LOOK_S = 0.5
"""It looks this often where the other one is."""
STRAY_M = 1.0
"""It goes on to where the other one was until that is further off than this."""


class Follow(Behaviour):
    """Walk after a person or an actor, and stay at a distance; stand while nobody is there."""

    name = "follow"

    def __init__(
        self, *, actor: str | None = None, person: int | None = None, distance_m: float = 2.0
    ) -> None:
        if (actor is None) == (person is None):
            raise ValueError("follow an actor or a person: give one of them")
        self._actor = actor
        self._person = person
        self._distance_m = distance_m
        self._goal: Goal | None = None

    def update(self, view: Perception) -> Goal | None:
        """Where the other one is, or was a moment ago; None when it is near, or nowhere."""
        self.ask_at_s, self.sets_out = view.time_s + LOOK_S, False
        where = view.people.get(self._person) if self._actor is None else view.actor_at(self._actor)
        if where is None:
            self._goal = None
            return None
        level = abs(where[2] - view.z_m) < SAME_FLOOR_M
        away_m = math.dist(where[:2], view.position) if level else math.inf
        # It sets out a little later than it stops, so that it does not do both all the time.
        if away_m <= self._distance_m * (1.25 if self._goal is None else 1.0):
            self._goal = None
        elif self._goal is None or view.stuck or self._strayed_m(where) > self._slack_m(away_m):
            self._goal, self.sets_out = where, True
        return self._goal

    def _strayed_m(self, where: Goal) -> float:
        """How far the other one is from where this one goes."""
        if self._goal is None or abs(where[2] - self._goal[2]) >= SAME_FLOOR_M:
            return math.inf
        return math.dist(where[:2], self._goal[:2])

    def _slack_m(self, away_m: float) -> float:
        """Each new goal costs a potential of its own; from afar it need not be so exact."""
        return STRAY_M if math.isinf(away_m) else max(STRAY_M, 0.5 * away_m)

"""Why an actor does what it does."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.behaviour import BehaviourName, Goal
from esplanade.actors.blockers import Blocker
from esplanade.actors.outcomes import InTheWay, Outcome
from esplanade.actors.state import Reason
from esplanade.actors.tours import Tour
from esplanade.planning import MovedEnd


@dataclass(frozen=True)
class Explanation:
    """Why an actor does what it does, for the overlay and the operator."""

    behaviour: BehaviourName
    reason: Reason
    goal: Goal | None
    path: NDArray[np.float64]
    """float64 (K, 4): x, y, z, seconds from now."""
    people: list[NDArray[np.float64]]
    """One array for each person near: float64 (K, 4) x, y, z, radius of the two-sigma circle, m."""
    since_s: float = 0.0
    """For how long the reason has been that, seconds."""
    blocker: Blocker | None = None
    """The blocker of the actor, as far as that can be told."""
    outcome: Outcome | None = None
    """How the trip ended; None while it goes on, and without a goal."""
    in_the_way: InTheWay | None = None
    """The person, actor, door or wall for which the trip did not end at the goal."""
    moved: MovedEnd | None = None
    """How the goal was moved to where the body fits; refused if the goal is strict."""
    tour: Tour | None = None
    """The tour on which the actor leads people."""

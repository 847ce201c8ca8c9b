"""Computer-run actors: parameters, behaviours, and the navigator that moves them together."""

from actors.behaviour import Behaviour, GoTo, Guide, Idle, Patrol, View, Wander
from actors.cast import Cast, Explanation
from actors.navigator import Navigator
from actors.parameters import ActorParameters
from actors.state import ActorState, Reason

__all__ = [
    "ActorParameters",
    "ActorState",
    "Behaviour",
    "Cast",
    "Explanation",
    "GoTo",
    "Guide",
    "Idle",
    "Navigator",
    "Patrol",
    "Reason",
    "View",
    "Wander",
]

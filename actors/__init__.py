"""Computer-run actors: parameters, behaviours, and the navigator that moves them together."""

from esplanade.actors.behaviour import Behaviour, GoTo, Guide, Idle, Patrol, Perception, Wander
from esplanade.actors.navigator import Navigator
from esplanade.actors.parameters import ActorParameters
from esplanade.actors.people import ObservedPeople
from esplanade.actors.population import Explanation, Population
from esplanade.actors.state import ActorState, Reason

__all__ = [
    "ActorParameters",
    "ActorState",
    "Behaviour",
    "Explanation",
    "GoTo",
    "Guide",
    "Idle",
    "Navigator",
    "ObservedPeople",
    "Patrol",
    "Perception",
    "Population",
    "Reason",
    "Wander",
]

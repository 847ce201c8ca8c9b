"""Computer-run actors: parameters, behaviours, and the navigator that moves them together."""

from esplanade.actors.actor_spec import ActorSpec
from esplanade.actors.behaviour import Behaviour, GoTo, Guide, Idle, Patrol, Perception, Wander
from esplanade.actors.behaviour_spec import BehaviourSpec
from esplanade.actors.explanation import Explanation
from esplanade.actors.navigator import Navigator
from esplanade.actors.outcomes import InTheWay, Outcome
from esplanade.actors.overrides import Overrides, Scope
from esplanade.actors.parameter_records import ParameterError, ParameterFault
from esplanade.actors.parameters import ActorParameters
from esplanade.actors.people import ObservedPeople
from esplanade.actors.placing import Newcomer
from esplanade.actors.population import Population
from esplanade.actors.state import ActorState, Reason

__all__ = [
    "ActorParameters",
    "ActorSpec",
    "ActorState",
    "Behaviour",
    "BehaviourSpec",
    "Explanation",
    "GoTo",
    "Guide",
    "Idle",
    "InTheWay",
    "Navigator",
    "Newcomer",
    "ObservedPeople",
    "Outcome",
    "Overrides",
    "ParameterError",
    "ParameterFault",
    "Patrol",
    "Perception",
    "Population",
    "Reason",
    "Scope",
    "Wander",
]

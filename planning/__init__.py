"""Getting somewhere: scenes, layered grids, potentials, prediction, risk, search, perturbation.

Pure mathematics: no sockets, no clock, no random numbers of its own.
"""

from esplanade.planning.agents._passage_kernels import PASSAGE
from esplanade.planning.agents.agent_table import AgentTable, SavedAgentsError
from esplanade.planning.agents.agents import PARAMETERS, Agents, Decisions
from esplanade.planning.agents.batch import Batch, PlanModel
from esplanade.planning.agents.rules import RuleModel
from esplanade.planning.agents.search import SearchForm, SearchResult, SearchStatus, uncertain_bfp
from esplanade.planning.grid.grid import LayeredGrid
from esplanade.planning.people._prediction_kernels import Prediction
from esplanade.planning.people.prediction import PredictionModel, TrackHistory
from esplanade.planning.people.risk import RiskField, RiskModel
from esplanade.planning.people.spread import GAUSSIAN, PEOPLE, Spread
from esplanade.planning.routes.find_path import LayeredPath, PathStatus, find_path
from esplanade.planning.routes.moved_ends import MovedEnd, MoveReason
from esplanade.planning.routes.potential import Potential
from esplanade.planning.routes.wave_front import Wave
from esplanade.planning.scene.bodies import Body
from esplanade.planning.scene.scene import (
    Door,
    Place,
    Polygon,
    Portal,
    Ramp,
    Scene,
    Spawn,
    Stairs,
    Wall,
)

__all__ = [
    "GAUSSIAN",
    "PARAMETERS",
    "PASSAGE",
    "PEOPLE",
    "AgentTable",
    "Agents",
    "Batch",
    "Body",
    "Decisions",
    "Door",
    "LayeredGrid",
    "LayeredPath",
    "MoveReason",
    "MovedEnd",
    "PathStatus",
    "Place",
    "PlanModel",
    "Polygon",
    "Portal",
    "Potential",
    "Prediction",
    "PredictionModel",
    "Ramp",
    "RiskField",
    "RiskModel",
    "RuleModel",
    "SavedAgentsError",
    "Scene",
    "SearchForm",
    "SearchResult",
    "SearchStatus",
    "Spawn",
    "Spread",
    "Stairs",
    "TrackHistory",
    "Wall",
    "Wave",
    "find_path",
    "uncertain_bfp",
]

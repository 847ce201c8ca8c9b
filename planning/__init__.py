"""Getting somewhere: scenes, layered grids, potentials, prediction, risk, search, perturbation.

Pure mathematics: no sockets, no clock, no random numbers of its own.
"""

from planning._crowd import PARAMETERS, Crowd, Decisions
from planning._passage_kernels import PASSAGE
from planning._prediction_kernels import Prediction
from planning.batch import Batch, PlanModel
from planning.bodies import Body
from planning.find_path import LayeredPath, PathStatus, find_path
from planning.grid import LayeredGrid
from planning.potential import Potential, Wave
from planning.prediction import PredictionModel, TrackHistory
from planning.risk import RiskField, RiskModel
from planning.scene import Door, Place, Polygon, Ramp, Scene, Spawn, Stairs, Wall
from planning.search import SearchForm, SearchResult, SearchStatus, uncertain_bfp
from planning.spread import GAUSSIAN, PEOPLE, Spread

__all__ = [
    "GAUSSIAN",
    "PARAMETERS",
    "PASSAGE",
    "PEOPLE",
    "Batch",
    "Body",
    "Crowd",
    "Decisions",
    "Door",
    "LayeredGrid",
    "LayeredPath",
    "PathStatus",
    "Place",
    "PlanModel",
    "Polygon",
    "Potential",
    "Prediction",
    "PredictionModel",
    "Ramp",
    "RiskField",
    "RiskModel",
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

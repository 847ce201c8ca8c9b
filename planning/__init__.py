"""Getting somewhere: scenes, layered grids, potentials, prediction, risk, search, perturbation.

Pure mathematics: no sockets, no clock, no random numbers of its own.
"""

from planning._crowd import PARAMETERS, Crowd, Decisions
from planning._prediction_kernels import Prediction
from planning.batch import Batch, PlanModel
from planning.grid import LayeredGrid
from planning.potential import Potential, Wave
from planning.prediction import PredictionModel, TrackHistory, gaussian_density
from planning.risk import RiskField, RiskModel
from planning.scene import Place, Polygon, Scene, Spawn, Wall
from planning.search import SearchForm, SearchResult, SearchStatus, uncertain_bfp

__all__ = [
    "PARAMETERS",
    "Batch",
    "Crowd",
    "Decisions",
    "LayeredGrid",
    "Place",
    "PlanModel",
    "Polygon",
    "Potential",
    "Prediction",
    "PredictionModel",
    "RiskField",
    "RiskModel",
    "Scene",
    "SearchForm",
    "SearchResult",
    "SearchStatus",
    "Spawn",
    "TrackHistory",
    "Wall",
    "Wave",
    "gaussian_density",
    "uncertain_bfp",
]

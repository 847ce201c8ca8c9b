"""Getting somewhere: scenes, layered grids, potentials, prediction, risk, search, perturbation.

Pure mathematics: no sockets, no clock, no random numbers of its own.
"""

from planning.grid import LayeredGrid
from planning.potential import Potential, Wave
from planning.scene import Place, Polygon, Scene, Spawn, Wall

__all__ = [
    "LayeredGrid",
    "Place",
    "Polygon",
    "Potential",
    "Scene",
    "Spawn",
    "Wall",
    "Wave",
]

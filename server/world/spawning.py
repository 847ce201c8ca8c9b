"""Places where new people come into the world."""

import math
from typing import Final

import numpy as np

from esplanade.planning import LayeredGrid, Scene, Spawn
from esplanade.server.world.routes import Point

DRAWS: Final = 8
"""Places around a spawn point that are tried before the nearest free one to it is taken."""


class NoRoomError(ValueError):
    """A scene without any free place."""


class Spawning:
    """Free places for newcomers, drawn with the world's seed."""

    def __init__(
        self, scene: Scene, grid: LayeredGrid, clearance_m: float, seed: np.random.SeedSequence
    ) -> None:
        self._scene = scene
        self._grid = grid
        self._clearance_m = clearance_m
        self.random = np.random.default_rng(seed)
        """The chance by which newcomers are placed."""
        x0, y0, x1, y1 = scene.bounds
        middle = ((x0 + x1) / 2.0, (y0 + y1) / 2.0)
        if grid.nearest_free(middle, 0.0, clearance_m) is None:
            raise NoRoomError(f"scene {scene.name!r} has no free place to stand")

    def place(self, at: Point | None, anywhere: bool = True) -> Point:
        """The free place nearest to the wished one, or to one around a spawn point.

        Without `anywhere`, a wished place only chooses the spawn point: the one nearest to it.
        """
        if at is not None and anywhere:
            return self._free(at)
        if not self._scene.spawns:
            x0, y0, x1, y1 = self._scene.bounds
            x, y = self.random.uniform((x0, y0), (x1, y1))
            return self._free((float(x), float(y), 0.0))
        return self._around(self._spawn(at))

    def _spawn(self, at: Point | None) -> Spawn:
        spawns = self._scene.spawns
        if at is None:
            return spawns[int(self.random.integers(len(spawns)))]
        return min(spawns, key=lambda spawn: math.dist((*spawn.position, spawn.z_m), at))

    def _around(self, spawn: Spawn) -> Point:
        """A free place within the spawn's radius, drawn evenly; the nearest to it if none is."""
        for _ in range(DRAWS):
            angle = self.random.uniform(0.0, 2.0 * np.pi)
            distance_m = spawn.radius_m * np.sqrt(self.random.uniform())
            x = spawn.position[0] + distance_m * np.cos(angle)
            y = spawn.position[1] + distance_m * np.sin(angle)
            place = self._free((float(x), float(y), spawn.z_m))
            if math.dist(place[:2], spawn.position) <= spawn.radius_m:
                return place
        return self._free((*spawn.position, spawn.z_m))

    def _free(self, at: Point) -> Point:
        x, y, z = at
        free = self._grid.nearest_free((x, y), z, self._clearance_m)
        if free is None:  # there was one when the world began
            raise NoRoomError(f"scene {self._scene.name!r} has no free place left to stand")
        return (*free, self._grid.floor_at(free, z))

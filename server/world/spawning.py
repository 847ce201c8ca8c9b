"""Places where new people come into the world."""

import numpy as np

from esplanade.planning import LayeredGrid, Scene
from esplanade.server.world.routes import Point


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
        self._random = np.random.default_rng(seed)
        x0, y0, x1, y1 = scene.bounds
        middle = ((x0 + x1) / 2.0, (y0 + y1) / 2.0)
        if grid.nearest_free(middle, 0.0, clearance_m) is None:
            raise NoRoomError(f"scene {scene.name!r} has no free place to stand")

    def place(self, at: Point | None) -> Point:
        """The free place nearest to the wished one, or to a spawn point's."""
        x, y, z = self._draw() if at is None else at
        free = self._grid.nearest_free((x, y), z, self._clearance_m)
        if free is None:  # there was one when the world began
            raise NoRoomError(f"scene {self._scene.name!r} has no free place left to stand")
        return (*free, self._grid.floor_at(free, z))

    def _draw(self) -> Point:
        if not self._scene.spawns:
            x0, y0, x1, y1 = self._scene.bounds
            x, y = self._random.uniform((x0, y0), (x1, y1))
            return float(x), float(y), 0.0
        spawn = self._scene.spawns[int(self._random.integers(len(self._scene.spawns)))]
        angle = self._random.uniform(0.0, 2.0 * np.pi)
        distance_m = spawn.radius_m * np.sqrt(self._random.uniform())
        x = spawn.position[0] + distance_m * np.cos(angle)
        y = spawn.position[1] + distance_m * np.sin(angle)
        return float(x), float(y), spawn.z_m

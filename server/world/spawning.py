"""Where new people come into the world."""

import numpy as np

from planning import LayeredGrid, Scene


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
        for layer in range(grid.layers):
            free = grid.nearest_free(middle, layer, clearance_m)
            if free is not None:
                self._fallback = (free, layer)
                break
        else:
            raise NoRoomError(f"scene {scene.name!r} has no free place to stand")

    def place(self, at: tuple[float, float, int] | None) -> tuple[tuple[float, float], int]:
        """Position and layer: the free place nearest to the wished one, or a spawn point's."""
        (x, y), layer = self._draw() if at is None else ((at[0], at[1]), at[2])
        layer = min(layer, self._grid.layers - 1)
        free = self._grid.nearest_free((x, y), layer, self._clearance_m)
        return (free, layer) if free is not None else self._fallback

    def _draw(self) -> tuple[tuple[float, float], int]:
        if not self._scene.spawns:
            x0, y0, x1, y1 = self._scene.bounds
            x, y = self._random.uniform((x0, y0), (x1, y1))
            return (float(x), float(y)), int(self._random.integers(self._grid.layers))
        spawn = self._scene.spawns[int(self._random.integers(len(self._scene.spawns)))]
        angle = self._random.uniform(0.0, 2.0 * np.pi)
        distance_m = spawn.radius_m * np.sqrt(self._random.uniform())
        x = spawn.position[0] + distance_m * np.cos(angle)
        y = spawn.position[1] + distance_m * np.sin(angle)
        return (float(x), float(y)), self._grid.layer_near(spawn.position, spawn.z_m)

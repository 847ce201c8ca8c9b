"""Places for actors who come in: where they are wished, or anywhere free."""

from __future__ import annotations

import math
from collections.abc import Hashable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.behaviour import Behaviour
from esplanade.actors.parameters import ActorParameters
from esplanade.planning import Body, LayeredGrid, Potential, Scene
from esplanade.planning.grid.clearances import kind_of
from esplanade.planning.scene.heights import SAME_FLOOR_M

_TRIES = 64
_MOST_BESIDE = 4000
"""Places that are tried around one."""
_GOLDEN_RAD = math.pi * (3.0 - math.sqrt(5.0))
Place = tuple[float, float, float]
"""x, y and the height that is meant, metres."""


@dataclass(frozen=True)
class Newcomer:
    """An actor that is to come in."""

    id: Hashable
    behaviour: Behaviour
    parameters: ActorParameters
    place: Place | None = None
    """None for a free place, chosen with the seed."""
    z_m: float = 0.0
    """The height of the floor on which such a place is sought first."""
    near: bool = False
    """Whether the nearest free ground is meant where somebody stands at the place."""


class Placing:
    """Finds places on a grid; from all of them a way leads to where people come in."""

    def __init__(self, grid: LayeredGrid, scene: Scene) -> None:
        self._grid = grid
        self._scene = scene
        self._entrances: dict[Body, Potential | None] = {}

    def ground_changed(self) -> None:
        """Forget which ground is connected."""
        self._entrances.clear()

    def near(self, body: Body, place: Place) -> Place:
        """The place itself if the body stands there, be it close to a wall; else the nearest.

        Raises
        ------
        ValueError
            The body can stand nowhere.
        """
        x, y, z_m = place
        if self._grid.nearest_free((x, y), z_m, 0.0, body) == (x, y):
            return place
        free = self._grid.nearest_free((x, y), z_m, body.radius_m, body)
        if free is None:
            raise ValueError("nobody of that body can stand anywhere in this scene")
        return (*free, z_m)

    def beside(
        self, body: Body, place: Place, taken: NDArray[np.float64], passed: dict[Place, int]
    ) -> Place:
        """The ground nearest to a place that is free of those in `taken` (N, 4), x, y, z, radius.

        `passed` counts what was tried around each place, so that many who come to one find theirs
        in turn.

        Raises
        ------
        ValueError
            There is none near.
        """
        x, y, z_m = place
        x0, y0, x1, y1 = self._scene.bounds
        apart_m = 2.5 * body.radius_m
        level = taken[np.abs(taken[:, 2] - z_m) < SAME_FLOOR_M]
        for k in range(passed.get(place, 0), _MOST_BESIDE):
            # Sunflower seeds: evenly apart, the nearest first.
            away_m, angle = apart_m * math.sqrt(k), k * _GOLDEN_RAD
            point = np.array((x + away_m * math.cos(angle), y + away_m * math.sin(angle)))
            if not (x0 <= point[0] <= x1 and y0 <= point[1] <= y1):
                continue
            crowded = _crowded(point, level, 1.25 * body.radius_m)
            here = float(point[0]), float(point[1])
            if (
                not crowded
                and self._has_a_way(point, z_m, body)
                and abs(self._grid.floor_at(here, z_m) - z_m) < SAME_FLOOR_M
            ):
                passed[place] = k + 1
                return (*here, z_m)
        raise ValueError(f"no free ground near ({x:g}, {y:g}) at height {z_m:g}")

    def anywhere(
        self, body: Body, z_m: float, taken: NDArray[np.float64], rng: np.random.Generator
    ) -> Place:
        """Somewhere free, away from those in `taken` (N, 4), x, y, z, radius.

        It is on the floor at that height unless that is nowhere to be found.

        Raises
        ------
        ValueError
            There is no free place, or none was found.
        """
        x0, y0, x1, y1 = self._scene.bounds
        elsewhere = None
        level = taken[np.abs(taken[:, 2] - z_m) < SAME_FLOOR_M]
        for _ in range(_TRIES):
            point = rng.uniform((x0, y0), (x1, y1))
            place = float(point[0]), float(point[1])
            crowded = _crowded(point, level, 1.5 * body.radius_m)
            if not crowded and self._has_a_way(point, z_m, body):
                if abs(self._grid.floor_at(place, z_m) - z_m) < SAME_FLOOR_M:
                    return (*place, z_m)
                elsewhere = elsewhere or (*place, z_m)
        if elsewhere is not None:
            return elsewhere
        raise ValueError(f"no free place for another actor after {_TRIES} tries")

    def _has_a_way(self, point: NDArray[np.float64], z_m: float, body: Body) -> bool:
        """Whether a body fits there and gets from there to where people come in."""
        if not self._grid.is_free([point], [z_m], body.radius_m + 0.1, body)[0]:
            return False
        kind = kind_of(body)
        if kind not in self._entrances:
            self._entrances[kind] = self._entrance(kind)
        potential = self._entrances[kind]
        return potential is None or bool(np.isfinite(potential.distance([point], [z_m])[0]))

    def _entrance(self, kind: Body) -> Potential | None:
        """The potential of the place where people come in; None where there is no such place."""
        entries = self._scene.spawns or self._scene.places
        if not entries:
            return None
        entry = entries[0]
        free = self._grid.nearest_free(entry.position, entry.z_m, kind.radius_m, kind)
        if free is None:
            return None
        return Potential(self._grid, free, entry.z_m, kind.radius_m, body=kind)


def _crowded(point: NDArray[np.float64], bodies: NDArray[np.float64], room_m: float) -> bool:
    """Whether a point is nearer than `room_m` to one of the bodies (N, 4), x, y, z, radius."""
    away_m = np.hypot(bodies[:, 0] - point[0], bodies[:, 1] - point[1])
    return bool((away_m < bodies[:, 3] + room_m).any())

"""Who gets where: what a body reaches from the spawns of a scene."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from esplanade.planning import LayeredGrid, Scene
from esplanade.planning.routes.find_path import PathStatus, find_path
from esplanade.planning.scene.bodies import Body
from esplanade.planning.scene.heights import SAME_SURFACE_M
from esplanade.planning.traversal.stability import Stability
from esplanade.planning.traversal.traversability import Traversability
from esplanade.planning.traversal.wavefront import UNREACHED, spread_wave
from esplanade.scenery.values import Point

_SHELTERED = 4.0
"""What a cell under a roof counts for."""


@dataclass(frozen=True)
class Reach:
    """What of a scene one body reaches."""

    standing: float
    """Share of all floor in which it could stand."""
    reached: float
    """Share of that where it gets to from the spawns."""
    places_missed: tuple[str, ...]
    spawns_blocked: tuple[str, ...]
    """Spawns where it cannot stand, as `spawns.0`."""


def reach_of(grid: LayeredGrid, scene: Scene, body: Body) -> Reach:
    """Send a body from every spawn to every place.

    Without spawns, avatars come in anywhere: the largest region is taken that hangs together.
    """
    traversability = grid.traversability.of(body)
    stands = stands_in(traversability)
    seeds = spawn_cells(traversability, scene)
    reached = reached_cells(traversability, seeds)
    if not seeds and reached.any():
        seeds = (int(reached.argmax()),)
    starts = centres(traversability)[[seed for seed in seeds if seed >= 0]]
    missed = [
        place.name
        for place in scene.places
        if not any(_leads(grid, start, (*place.position, place.z_m), body) for start in starts)
    ]
    blocked = [f"spawns.{i}" for i, seed in enumerate(seeds) if seed < 0]
    floor = int(np.isfinite(grid.layered.floors).sum())
    return Reach(
        float(stands.sum() / max(1, floor)),
        float(reached.sum() / max(1, stands.sum())),
        tuple(missed),
        tuple(blocked),
    )


def spawn_cells(traversability: Traversability, scene: Scene) -> tuple[int, ...]:
    """The cell where a body comes in, for each spawn; -1: there is no room for it."""
    return tuple(
        cell_near(traversability, (*spawn.position, spawn.z_m), spawn.radius_m)
        for spawn in scene.spawns
    )


def reached_cells(traversability: Traversability, seeds: Sequence[int]) -> NDArray[np.bool_]:
    """Where one gets from some cells, bool (N,); without any, the largest region."""
    if not seeds:
        return largest_region(traversability)
    reached = np.zeros(len(traversability.steps), dtype=np.bool_)
    for seed in seeds:
        if seed >= 0 and not reached[seed]:
            reached |= spread_wave(traversability, seed) != UNREACHED
    return reached


def _leads(grid: LayeredGrid, start: NDArray[np.float64], goal: Point, body: Body) -> bool:
    x, y, z = (float(value) for value in start)
    return find_path(grid, (x, y, z), goal, body=body).status is PathStatus.FOUND


def centres(traversability: Traversability) -> NDArray[np.float64]:
    """x, y, z of every cell, float64 (N, 3), metres; z is nan where there is no floor."""
    a = traversability.arrays
    return np.stack(
        [
            a.x0 + (a.places["column"] + 0.5) * a.cell_m,
            a.y0 + (a.places["row"] + 0.5) * a.cell_m,
            a.floors.astype(np.float64),
        ],
        axis=1,
    )


def cell_near(traversability: Traversability, point: Point, within_m: float) -> int:
    """The nearest cell in which the body can stand; -1: none within that distance on the map."""
    away = centres(traversability) - point
    on_map = np.hypot(away[:, 0], away[:, 1])
    near = np.flatnonzero(
        stands_in(traversability)
        & (on_map <= within_m + traversability.arrays.cell_m)
        & (np.abs(away[:, 2]) <= SAME_SURFACE_M)
    )
    if not len(near):
        return -1
    return int(near[np.hypot(on_map[near], away[near, 2]).argmin()])


def stands_in(traversability: Traversability) -> NDArray[np.bool_]:
    """Cells in which the body can stand, bool (N,)."""
    return np.asarray(traversability.classes != Stability.FORBIDDEN)


def largest_region(traversability: Traversability) -> NDArray[np.bool_]:
    """The most cells that one body can walk between, bool (N,); none if it stands nowhere.

    Cells under a roof count for more, so that the rooms of a building come before its roof.
    """
    stands, links = stands_in(traversability), traversability.arrays.links
    steps = (traversability.steps[:, None] >> np.arange(8)) & 1 == 1
    steps &= stands[:, None] & stands[links]
    starts, directions = np.nonzero(steps)
    count = len(stands)
    graph = coo_matrix(
        (np.ones(len(starts), dtype=np.bool_), (starts, links[starts, directions])),
        shape=(count, count),
    )
    labels = connected_components(graph, directed=False)[1]
    worth = np.where(np.isfinite(traversability.arrays.ceilings), _SHELTERED, 1.0) * stands
    sizes = np.bincount(labels, weights=worth, minlength=1)
    return np.asarray(stands & (labels == sizes.argmax()))

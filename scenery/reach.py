"""Reachability of a scene: the cells and places that a body reaches from the spawns."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from esplanade.planning import LayeredGrid, Scene
from esplanade.planning.routes.find_path import LayeredPath, PathStatus, find_path
from esplanade.planning.scene.bodies import Body
from esplanade.planning.scene.heights import SAME_SURFACE_M
from esplanade.planning.traversal.stability import Stability
from esplanade.planning.traversal.traversability import Traversability
from esplanade.planning.traversal.wavefront import UNREACHED, number_regions, spread_wave
from esplanade.scenery.values import Point

_ROOFED_CELL_WEIGHT = 4.0
"""The weight of a cell under a roof in the choice of the largest region."""


@dataclass(frozen=True)
class Reach:
    """The part of a scene that one body reaches."""

    standing: float
    """The share of all floor on which the body can stand."""
    reached: float
    """The share of that which the body reaches from the spawns."""
    places_missed: tuple[str, ...]
    """The names of the places that it does not reach."""
    spawns_blocked: tuple[str, ...]
    """The spawns at which it cannot stand, such as `spawns.0`."""
    places_moved: Mapping[str, str]
    """The places that it reaches only nearby, as it does not fit there: how far, and why."""


def reach_of(grid: LayeredGrid, scene: Scene, body: Body) -> Reach:
    """Find what a body reaches, with a path from some spawn to each place.

    In a scene without spawns avatars enter anywhere, so the largest connected region is taken.
    """
    traversability = grid.traversability.of(body)
    stands = can_stand(traversability)
    seeds = spawn_cells(traversability, scene)
    reached = reached_cells(traversability, seeds)
    if not seeds and reached.any():
        seeds = (int(reached.argmax()),)
    starts = centres(traversability, np.array([seed for seed in seeds if seed >= 0], np.int64))
    missed, moved = [], {}
    for place in scene.places:
        path = _path_from_any(grid, starts, (*place.position, place.z_m), body)
        if path is None:
            missed.append(place.name)
        elif path.goal_moved is not None:
            moved[place.name] = str(path.goal_moved)
    blocked = [f"spawns.{i}" for i, seed in enumerate(seeds) if seed < 0]
    floor = int(np.isfinite(grid.layered.floors).sum())
    return Reach(
        float(stands.sum() / max(1, floor)),
        float(reached.sum() / max(1, stands.sum())),
        tuple(missed),
        tuple(blocked),
        moved,
    )


def spawn_cells(traversability: Traversability, scene: Scene) -> tuple[int, ...]:
    """The cell at which a body enters, for each spawn; -1 if there is no room for it."""
    return tuple(
        cell_near(traversability, (*spawn.position, spawn.z_m), spawn.radius_m)
        for spawn in scene.spawns
    )


def reached_cells(traversability: Traversability, seeds: Sequence[int]) -> NDArray[np.bool_]:
    """The cells that are reached from some cells, bool (N,); without any, the largest region."""
    if not seeds:
        return largest_region(traversability)
    reached = np.zeros(len(traversability.steps), dtype=np.bool_)
    for seed in seeds:
        if seed >= 0 and not reached[seed]:
            reached |= spread_wave(traversability, seed) != UNREACHED
    return reached


def _path_from_any(
    grid: LayeredGrid, starts: NDArray[np.float64], goal: Point, body: Body
) -> LayeredPath | None:
    """A path from the first of some places (K, 3) from which one leads to a goal."""
    for x, y, z in starts.tolist():
        path = find_path(grid, (x, y, z), goal, body=body)
        if path.status is PathStatus.FOUND:
            return path
    return None


def centres(
    traversability: Traversability, cells: NDArray[np.integer] | None = None
) -> NDArray[np.float64]:
    """The centres of some cells (M,), or of all N, float64 (M, 3) or (N, 3), metres.

    z is nan where there is no floor.
    """
    a = traversability.arrays
    places, floors = (a.places, a.floors) if cells is None else (a.places[cells], a.floors[cells])
    found = np.empty((len(floors), 3))
    found[:, 0] = a.x0 + (places["column"] + 0.5) * a.cell_m
    found[:, 1] = a.y0 + (places["row"] + 0.5) * a.cell_m
    found[:, 2] = floors
    return found


def cell_near(traversability: Traversability, point: Point, within_m: float) -> int:
    """The nearest cell in which the body can stand.

    It is -1 if there is none within the distance `within_m` on the map on the same floor.
    """
    away = centres(traversability) - point
    on_map = np.hypot(away[:, 0], away[:, 1])
    near = np.flatnonzero(
        can_stand(traversability)
        & (on_map <= within_m + traversability.arrays.cell_m)
        & (np.abs(away[:, 2]) <= SAME_SURFACE_M)
    )
    if not len(near):
        return -1
    return int(near[np.hypot(on_map[near], away[near, 2]).argmin()])


def can_stand(traversability: Traversability) -> NDArray[np.bool_]:
    """Whether the body can stand in each cell, bool (N,)."""
    return np.asarray(traversability.classes != Stability.FORBIDDEN)


def largest_region(traversability: Traversability) -> NDArray[np.bool_]:
    """The largest connected region that a body can walk, bool (N,).

    Cells under a roof have a greater weight, so that the rooms of a building are preferred to its
    roof. No cell is set if the body cannot stand anywhere.
    """
    regions = number_regions(traversability)
    stands = np.flatnonzero(regions >= 0)
    roofed = np.isfinite(traversability.arrays.ceilings[stands])
    worth = np.where(roofed, _ROOFED_CELL_WEIGHT, 1.0)
    sizes = np.bincount(regions[stands], weights=worth, minlength=1)
    return np.asarray(regions == sizes.argmax())

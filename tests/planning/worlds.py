"""Small worlds that the planning tests are set in."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar

import numba
import numpy as np
import pytest
from hypothesis import settings
from hypothesis import strategies as st
from numpy.typing import ArrayLike, NDArray

from esplanade.planning import (
    PEOPLE,
    LayeredGrid,
    PlanModel,
    Polygon,
    Prediction,
    RiskField,
    RiskModel,
    RuleModel,
    Scene,
    Spawn,
)
from esplanade.planning.agents._bottleneck_kernels import Lane
from esplanade.planning.agents._reservation_kernels import Reservations, index_paths
from esplanade.planning.agents._task_kernels import Task, World
from esplanade.planning.agents.search import make_reservations

COMPILED = not numba.config.DISABLE_JIT
"""False in the leg that runs kernels as plain Python, a hundred times slower."""
STEP_S = 0.4
RULES = RuleModel().row[0]
"""The rules as they are by default, for kernels."""
SLICES = PlanModel().slices

Case = TypeVar("Case")
Line = tuple[tuple[float, float], tuple[float, float]]


slow_if_plain = pytest.mark.skipif(not COMPILED, reason="too slow where kernels are not compiled")
"""For tests whose kernels others run uncompiled too."""


def scaled(compiled: int, plain: int) -> int:
    """The amount of something to test: less where kernels are not compiled."""
    return compiled if COMPILED else plain


def of_all(cases: Sequence[Case]) -> Sequence[Case]:
    """All cases of a test, or the first where kernels are not compiled."""
    return cases[: scaled(len(cases), 1)]


def holds(compiled: int, plain: int) -> settings:
    """Settings for this many examples, the same in every run."""
    return settings(max_examples=scaled(compiled, plain), deadline=None, derandomize=True)


def open_grid(
    side_m: float = 8.0,
    walls: Sequence[Line] = (),
    polygons: Sequence[Polygon] = (),
    cell_m: float = 0.25,
) -> LayeredGrid:
    """A square of bare ground, on whose roofs nobody can stand."""
    scene = Scene.open_space((0.0, 0.0, side_m, side_m), walls=walls, polygons=polygons)
    # Roofs that cannot be reached from a spawn are left out.
    spawns = (Spawn(position=(0.1, 0.1)),)
    return LayeredGrid.from_scene(scene.model_copy(update={"spawns": spawns}), cell_m)


UPPER_M = 3.3
"""Height of the upper floor of `two_floors`."""


def two_floors(side_m: float = 8.0) -> LayeredGrid:
    """A square of ground and another one above all of it, with no way between them."""
    ring = ((0.0, 0.0), (side_m, 0.0), (side_m, side_m), (0.0, side_m))
    slab = Polygon(points=ring, offset_m=3.0, height_m=0.3, kind="floor")
    return LayeredGrid.from_scene(Scene(bounds=(0.0, 0.0, side_m, side_m), polygons=(slab,)))


def as_rows(grid: LayeredGrid, values: NDArray[np.generic], layer: int = 0) -> NDArray[np.generic]:
    """Values by cell (N,) as rows and columns (ny, nx) of a layer."""
    a = grid.layered
    out = np.empty((a.ny, a.nx), dtype=values.dtype)
    of_layer = (a.places["layer"] == layer) & (a.places["row"] < a.ny) & (a.places["column"] < a.nx)
    assert of_layer.sum() == out.size, "the layer has tiles that nobody can stand in"
    out[a.places["row"][of_layer], a.places["column"][of_layer]] = values[of_layer]
    return out


def walking(
    positions: Sequence[Sequence[float]],
    velocities: Sequence[Sequence[float]],
    slices: int = SLICES,
    slice_s: float = STEP_S / 2,
    sigma_0_m: float = 0.05,
    growth_mps: float = 0.17,
) -> Prediction:
    """People who go straight on, eqs. (2) and (3) without any walls."""
    start = np.array(positions, dtype=np.float64).reshape(-1, 2)
    v = np.array(velocities, dtype=np.float64).reshape(-1, 2)
    seconds = slice_s * np.arange(slices + 1)
    means = start[:, None] + seconds[None, :, None] * v[:, None]
    sigmas = np.broadcast_to(sigma_0_m + growth_mps * seconds, means.shape[:2]).copy()
    each = np.broadcast_to(v[:, None], means.shape).copy()
    return Prediction(means, each, sigmas, np.zeros(sigmas.shape), v.copy())


def field_of(grid: LayeredGrid, prediction: Prediction, slices: int = SLICES) -> RiskField:
    """The risk field of a prediction, defaults throughout."""
    field = RiskField(grid, RiskModel(), slices, PEOPLE)
    field.fill(prediction)
    return field


def reserved(
    grid: LayeredGrid,
    paths: NDArray[np.float64] | None = None,
    radii_m: Sequence[float] = (0.25,),
    ranks: Sequence[int] = (0,),
    heights: ArrayLike | None = None,
    fastest_m: float = 0.34,
) -> Reservations:
    """Reservations of some actors; by default of one that stands far outside everyone's way."""
    if paths is None:
        paths = np.full((1, SLICES + 1, 2), -1e3)
    levels = np.zeros(len(paths)) if heights is None else heights
    reservations = make_reservations(
        grid,
        paths,
        np.repeat(np.array(levels, dtype=np.float64)[:, None], paths.shape[1], axis=1),
        np.array(radii_m, dtype=np.float64),
        np.array(ranks, dtype=np.int64),
        fastest_m,
    )
    index_paths(reservations)
    return reservations


def world_of(grid: LayeredGrid, field: RiskField, reservations: Reservations) -> World:
    """The world that kernels look things up in."""
    rules, person_m = reservations.rules, field.model.person_radius_m
    return World(grid.arrays, field.arrays, reservations, rules, STEP_S, person_m)


def task(
    start: tuple[float, float],
    goal: tuple[float, float],
    velocity: tuple[float, float] = (0.0, 0.0),
    **changes: object,
) -> Task:
    """The default actor's question; row 0 asks."""
    return Task(
        me=0,
        body=0,
        contact=0,
        cell=-1,
        x=start[0],
        y=start[1],
        vx=velocity[0],
        vy=velocity[1],
        goal_x=goal[0],
        goal_y=goal[1],
        radius_m=0.25,
        speed_mps=1.3,
        max_speed_mps=1.7,
        max_acceleration_mps2=2.0,
        goal_tolerance_m=0.2,
        contact_closing_s=0.3,
        risk_weight=25.0,
        foresight_s=20.0,
        closing_weight=0.1,
        turn_weight=0.1,
        wall_weight=0.3,
        wall_room_m=0.15,
        hurry_weight=2.0,
        max_expansions=400,
        on_edges=0.0,
        edge_cells=24.0,
        lane=Lane(0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 20.0, 4.0, 1.0),
        hold=False,
    )._replace(**changes)


def standing(grid: LayeredGrid, question: Task, z_m: float = 0.0) -> Task:
    """The question as asked from where it stands on a grid."""
    cells = grid.on_ground([(question.x, question.y)], [z_m])[1]
    return question._replace(cell=int(cells[0]))


def points(low: float, high: float) -> st.SearchStrategy[tuple[float, float]]:
    """Points of a square, whole centimetres."""
    whole = st.integers(round(low * 100), round(high * 100)).map(lambda v: v / 100)
    return st.tuples(whole, whole)


def lines(low: float, high: float, most: int) -> st.SearchStrategy[list[Line]]:
    """Up to so many walls that have a length."""
    line = st.tuples(points(low, high), points(low, high)).filter(lambda line: line[0] != line[1])
    return st.lists(line, max_size=most)

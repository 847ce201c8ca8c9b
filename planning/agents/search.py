"""Best-first search in CT-space: Lei & Li, sec. 4.1, fig. 5."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum, IntEnum
from typing import Final

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.agents import _search_kernels as kernels
from esplanade.planning.agents._branch_kernels import BRANCH_ROWS, Moves
from esplanade.planning.agents._cost_kernels import room_for_near
from esplanade.planning.agents._perturb_kernels import path_cost
from esplanade.planning.agents._reservation_kernels import Reservations
from esplanade.planning.agents._search_kernels import Workspace
from esplanade.planning.agents._task_kernels import SUB, Task, World
from esplanade.planning.agents.rules import RuleModel
from esplanade.planning.grid.grid import LayeredGrid
from esplanade.planning.people.risk import RiskField
from esplanade.planning.routes.potential import Potential

_RULES: Final = RuleModel()
_LEAST_BUCKET_M = 1.2
_BUCKETS_AN_ACTOR = 4
"""Clearing many more buckets than that would cost more than they save."""


class SearchStatus(IntEnum):
    """The outcome of a search."""

    FOUND = kernels.FOUND
    """The goal or the horizon was reached."""
    PARTIAL = kernels.PARTIAL
    """The budget of expansions ran out, or every path ends before the horizon: the best so far."""
    NO_PATH = kernels.NO_PATH
    """Not even the first move is possible, or no path leads to the goal."""


class SearchForm(Enum):
    """The key by which nodes are taken from the queue."""

    PRINTED = "printed"
    """U(q') = potential(q') + Risk(q'), as in fig. 5: greedy, forgets the risk already taken."""
    ACCUMULATED = "accumulated"
    """f = time and risk so far + time of the path that is left; actors use this."""


def compass_moves() -> Moves:
    """Moves of the accumulated form; their `speeds` are parts of an actor's preferred speed.

    A part above one stands for the greatest speed. Straight on comes at three speeds, so that an
    actor may hurry or slow down; staying put is always possible and not listed. Far ahead it is
    enough to go straight on, or 25 or 45 degrees to either side.
    """
    rows = [(0.0, 1.0), (0.0, 0.5), (0.0, 2.0)]
    straight = len(rows)
    coarse = straight + 4
    for degrees in (25, 45, 10, 80, 180):
        signs = (1, -1) if degrees < 180 else (1,)
        rows.extend((math.radians(sign * degrees), 1.0) for sign in signs)
    for degrees in (25, 60):
        rows.extend((math.radians(sign * degrees), 2.0) for sign in (1, -1))
    headings, parts = np.array(rows).T
    return Moves(np.cos(headings), np.sin(headings), parts.copy(), straight, coarse, True)


def lattice_moves(cell_m: float, step_s: float, max_speed_mps: float) -> Moves:
    """The eight neighbours of a cell, one step later each; a diagonal costs sqrt(2) the speed.

    Neighbours that would need more than the greatest speed are left out.
    """
    headings, speeds = [], []
    for eighth in range(8):
        speed = cell_m * (math.sqrt(2.0) if eighth % 2 else 1.0) / step_s
        if speed <= max_speed_mps + 1e-9:
            headings.append(eighth * math.pi / 4.0)
            speeds.append(speed)
    return Moves(np.cos(headings), np.sin(headings), np.array(speeds), 0, len(speeds), False)


def make_workspace(max_expansions: int, branching: int) -> Workspace:
    """Memory for one search at a time, some 100 bytes a node."""
    nodes = max_expansions * branching + 2
    table = 1 << max(10, (2 * nodes - 1).bit_length())
    return Workspace(
        np.zeros(nodes, dtype=kernels.NODE),
        np.zeros(nodes, dtype=np.int64),
        np.zeros(nodes),
        np.zeros(nodes, dtype=np.int64),
        np.zeros(nodes, dtype=np.int64),
        np.zeros(nodes, dtype=np.int64),
        np.zeros(nodes + 1),
        np.zeros(nodes + 1, dtype=np.int64),
        np.zeros(table, dtype=np.int64),
        np.zeros(table),
        np.zeros(table, dtype=np.int64),
        np.zeros(1, dtype=np.int64),
        room_for_near(),
        np.zeros((BRANCH_ROWS, branching)),
        np.zeros((2, branching), dtype=np.int64),
        np.zeros(nodes),
        np.zeros(3, dtype=np.int64),
    )


def make_reservations(
    grid: LayeredGrid,
    paths: NDArray[np.float64],
    heights: NDArray[np.float64],
    radii_m: NDArray[np.float64],
    ranks: NDArray[np.int64],
    fastest_m: float,
    rules: RuleModel = _RULES,
) -> Reservations:
    """Room for the planned paths of A actors, (A, K, 2) and (A, K); `index_paths` fills its index.

    No actor has a course yet, and none is held up. `fastest_m` is the greatest distance that an
    actor gets from one slice, or tick, to the next.
    """
    x0, y0, x1, y1 = grid.bounds
    widest = float(radii_m.max()) if len(radii_m) else 0.0
    across = math.sqrt((x1 - x0) * (y1 - y0) / (_BUCKETS_AN_ACTOR * max(1, len(paths))))
    bucket = max(_LEAST_BUCKET_M, across)
    nx = max(1, math.ceil((x1 - x0) / bucket))
    ny = max(1, math.ceil((y1 - y0) / bucket))
    actors, slices = paths.shape[:2]
    return Reservations(
        rules.row,
        paths,
        heights,
        radii_m,
        ranks,
        np.zeros((actors, 2)),
        np.zeros(actors, dtype=np.bool_),
        np.zeros(actors, dtype=np.bool_),
        np.zeros((slices, nx * ny + 1), dtype=np.int64),
        np.zeros((slices, actors), dtype=np.int64),
        x0,
        y0,
        bucket,
        widest,
        fastest_m,
        nx,
        ny,
    )


@dataclass(frozen=True)
class SearchResult:
    """A path through CT-space and how it was found."""

    status: SearchStatus
    path: NDArray[np.float64]
    """(K, 2) positions, `step_s` / 2 apart, beginning with the start; metres."""
    expansions: int
    cost_s: float
    """Cost of the path as the search added it up; the key of its last node in the printed form."""


def uncertain_bfp(
    field: RiskField,
    potential: Potential,
    task: Task,
    moves: Moves,
    reservations: Reservations,
    step_s: float,
    form: SearchForm = SearchForm.ACCUMULATED,
    bound: float = math.inf,
    illegal: NDArray[np.float64] | None = None,
) -> SearchResult:
    """Search one path from `task`'s start: Uncertain_BFP of fig. 5.

    The horizon is the risk field's last slice. Nodes are configurations (layer, cell, step) that
    keep their exact position; with `lattice_moves`, a start at a cell's centre and unbounded
    acceleration they are cells, as printed. A caller that already has a path only wants one that
    costs less than `bound` (seconds): nodes that get below it only if the rest is much easier than
    on that path are not looked at. A caller whose path has become illegal gives that path, (K, 2)
    like the result: the search goes on from the steps of it that are still legal.

    Raises
    ------
    ValueError
        The field's number of slices is odd, it was filled for shorter steps, the step is not
        positive, or the start is not finite.
    """
    slices = field.slices
    if slices % SUB or slices < SUB:
        raise ValueError(f"the risk field must hold a multiple of {SUB} slices, it holds {slices}")
    if not step_s > 0.0:
        raise ValueError(f"step_s must be positive, got {step_s}")
    furthest_m = max(task.max_speed_mps, math.hypot(task.vx, task.vy)) * step_s
    if furthest_m > field.arrays.slack_m:
        raise ValueError(
            f"a step leads {furthest_m:g} m, the risk field was filled for "
            f"{field.arrays.slack_m:g} m"
        )
    if not (math.isfinite(task.x) and math.isfinite(task.y)):
        raise ValueError(f"the start must be finite, got ({task.x}, {task.y})")
    world = World(
        field.grid.arrays,
        field.arrays,
        reservations,
        reservations.rules,
        step_s,
        field.model.person_radius_m,
    )
    path = np.zeros((slices + 1, 2))
    workspace = make_workspace(task.max_expansions, len(moves.speeds) + 1)
    kernels.begin_search(task, workspace)
    expected, begun = bound, 0
    if illegal is not None:
        cost = path_cost(world, potential.values, task, illegal, workspace.near)
        expected, begun = cost.seconds, cost.legal_steps
        kernels.lay_known(world, potential.values, task, illegal, begun, workspace)
    outcome = kernels.search(
        world,
        potential.values,
        moves,
        task,
        form is SearchForm.ACCUMULATED,
        bound,
        expected,
        begun,
        workspace,
        path,
    )
    return SearchResult(SearchStatus(outcome.status), path, outcome.expansions, outcome.cost)

"""A whole tick in one call, for few actors, on bare arrays."""

import numpy as np
from numpy.typing import NDArray

from planning._crowd import Crowd, Decisions
from planning._decide_kernels import decide
from planning._geometry_kernels import SegmentIndex
from planning._jit import kernel
from planning._precedence_kernels import prepare
from planning._prediction_kernels import Prediction
from planning._risk_kernels import index_people
from planning._search_kernels import Moves, Workspace
from planning._step_kernels import resolve
from planning._task_kernels import World


@kernel
def plan_and_step(
    world: World,
    index: SegmentIndex,
    guides: NDArray[np.float32],
    no_guide: NDArray[np.float32],
    moves: Moves,
    prediction: Prediction,
    last_wider: int,
    around: tuple[float, float, float, float],
    crowd: Crowd,
    tick_s: float,
    order: NDArray[np.int64],
    workspace: Workspace,
    decisions: Decisions,
    new_positions: NDArray[np.float64],
    new_cells: NDArray[np.int64],
) -> None:
    """What `Batch.tick` does on several threads, one after the other.

    To hand a zone's arrays to compiled code takes longer than what it then does for one actor: so
    they are handed over once.
    """
    index_people(prediction, last_wider, around, 0, 1, world.risk)
    prepare(world, guides, crowd, tick_s, order)
    decide(
        world,
        guides,
        no_guide,
        moves,
        prediction,
        crowd,
        tick_s,
        0,
        len(order),
        workspace,
        decisions,
    )
    resolve(world, index, crowd, order, tick_s, decisions, new_positions, new_cells)

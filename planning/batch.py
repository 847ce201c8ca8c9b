"""One tick of planning for all actors of a zone, in compiled batches on several threads."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from planning._crowd import Crowd, Decisions
from planning._decide_kernels import decide
from planning._precedence_kernels import prepare
from planning._prediction_kernels import Prediction
from planning._risk_kernels import index_people
from planning._search_kernels import Workspace
from planning._step_kernels import resolve
from planning._task_kernels import SUB, World
from planning._tick_kernels import plan_and_step
from planning.grid import LayeredGrid
from planning.risk import RiskField, RiskModel
from planning.search import compass_moves, make_reservations, make_workspace
from planning.spread import GAUSSIAN, Spread

_PORTION = 32
"""So many actors are decided for at a time, at most."""
_WORTH_A_THREAD = 4
"""So many actors keep a thread busy for longer than it takes to hand the work over."""


@dataclass(frozen=True)
class PlanModel:
    """How far and how finely the actors of a zone plan."""

    step_s: float = 0.4
    """Time step of the search (delta), seconds; the risk field has two slices in each."""
    steps: int = 9
    """Steps to the horizon."""
    threads: int = 2
    """Threads that share the work; the result does not depend on their number."""

    @property
    def slices(self) -> int:
        """Slices of the risk field after now."""
        return self.steps * SUB

    @property
    def slice_s(self) -> float:
        """Time between slices, seconds."""
        return self.step_s / SUB


class Batch:
    """Plans and steps for all actors of a zone at once.

    Cost of a tick: O(people × slices) for the index of people, O(actors × expansions ×
    moves × people near) for the searches; both are spread over the threads.
    """

    def __init__(
        self, grid: LayeredGrid, plan: PlanModel, risk: RiskModel, spread: Spread = GAUSSIAN
    ) -> None:
        self.grid = grid
        self.plan = plan
        self.field = RiskField(grid, risk, plan.slices, spread)
        self._moves = compass_moves()
        self._no_guide = np.full((len(grid.layered.floors), 3), np.inf, dtype=np.float32)
        self._pool = ThreadPoolExecutor(plan.threads, thread_name_prefix="planning")
        self._budget = 0
        self._workspaces: list[Workspace] = []

    def close(self) -> None:
        """End the threads."""
        self._pool.shutdown()

    def _on_threads(self, work: Callable[[int], None], threads: int) -> None:
        """Call work(k) for every k at once and wait for all; their errors come up here."""
        for done in [self._pool.submit(work, k) for k in range(threads)]:
            done.result()

    def _workspaces_for(self, budget: int) -> list[Workspace]:
        if budget > self._budget:
            branching = len(self._moves.speeds) + 1
            self._budget = budget
            self._workspaces = [make_workspace(budget, branching) for _ in range(self.plan.threads)]
        return self._workspaces

    def tick(
        self,
        crowd: Crowd,
        guides: NDArray[np.float32],
        prediction: Prediction,
        tick_s: float,
    ) -> tuple[Decisions, NDArray[np.float64], NDArray[np.int64]]:
        """Decide for everyone and take the step.

        Parameters
        ----------
        crowd : state of A actors after the finished tick
        guides : float32 (G, N, 3), the potentials that `crowd.guide_slots` points into
        prediction : people's future, as many slices as the plan has
        tick_s : length of the tick, seconds

        Returns
        -------
        The decisions, and float64 (A, 2) positions and int64 (A,) cells after the tick.
        """
        actors = len(crowd.positions)
        threads = min(self.plan.threads, 1 + actors // _WORTH_A_THREAD)
        slices = self.plan.slices + 1
        decisions = Decisions(
            np.empty((actors, slices, 2)),
            np.zeros((actors, 2)),
            np.zeros(actors, dtype=np.int64),
            np.zeros(actors, dtype=np.int64),
            np.zeros(actors, dtype=np.int64),
            np.zeros(actors, dtype=np.bool_),
        )
        new_positions = np.empty((actors, 2))
        new_cells = np.empty(actors, dtype=np.int64)
        if not actors:
            return decisions, new_positions, new_cells
        x0, y0 = crowd.positions.min(axis=0).tolist()
        x1, y1 = crowd.positions.max(axis=0).tolist()
        around = (x0, y0, x1, y1)
        # Who is told to be slower from now on still has to brake.
        speeds = np.hypot(crowd.velocities[:, 0], crowd.velocities[:, 1])
        fastest_mps = max(float(crowd.parameters["max_speed_mps"].max()), float(speeds.max()))
        self.field.make_room(prediction, fastest_mps * self.plan.step_s)
        last_wider = self.field.last_wider(self.plan.slice_s)
        reservations = make_reservations(
            self.grid,
            np.empty((actors, slices, 2)),
            np.zeros((actors, slices)),
            crowd.parameters["radius_m"].copy(),
            np.empty(actors, dtype=np.int64),
            fastest_mps * max(tick_s, self.plan.slice_s),
        )
        world = World(self.grid.arrays, self.field.arrays, reservations, self.plan.step_s)
        workspaces = self._workspaces_for(int(crowd.parameters["max_expansions"].max()))
        order = np.empty(actors, dtype=np.int64)
        if threads == 1:
            plan_and_step(
                world,
                self.grid.index,
                guides,
                self._no_guide,
                self._moves,
                prediction,
                last_wider,
                around,
                crowd,
                tick_s,
                order,
                workspaces[0],
                decisions,
                new_positions,
                new_cells,
            )
            return decisions, new_positions, new_cells

        def index(k: int) -> None:
            index_people(prediction, last_wider, around, k, threads, world.risk)

        self._on_threads(index, threads)
        prepare(world, guides, crowd, tick_s, order)
        # Every thread takes the next portion when it is done with one: none waits for the other.
        portion = min(_PORTION, -(-actors // (2 * threads)))
        portions = iter(range(0, actors, portion))

        def work(k: int) -> None:
            for first in portions:
                decide(
                    world,
                    guides,
                    self._no_guide,
                    self._moves,
                    prediction,
                    crowd,
                    tick_s,
                    first,
                    min(first + portion, actors),
                    workspaces[k],
                    decisions,
                )

        self._on_threads(work, threads)
        resolve(world, self.grid.index, crowd, order, tick_s, decisions, new_positions, new_cells)
        return decisions, new_positions, new_cells

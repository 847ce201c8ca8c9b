"""One tick of planning for all actors of a zone, in compiled batches on several threads."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from operator import is_

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.agents._search_kernels import Workspace
from esplanade.planning.agents._task_kernels import SUB, World
from esplanade.planning.agents._tick_kernels import (
    Zone,
    decide_some,
    has_room,
    index_future,
    plan_and_step,
    put_in_order,
    settle_all,
    take_steps,
)
from esplanade.planning.agents.agents import Agents, Decisions
from esplanade.planning.agents.rules import RuleModel
from esplanade.planning.agents.search import compass_moves, make_reservations, make_workspace
from esplanade.planning.compiled.handle import Handle, make_handle
from esplanade.planning.grid.grid import LayeredGrid
from esplanade.planning.people._prediction_kernels import Prediction
from esplanade.planning.people.risk import RiskField, RiskModel
from esplanade.planning.people.spread import GAUSSIAN, Spread

_PORTION = 8
"""A thread decides for this many agents at a time, at most."""
_WORTH_A_THREAD = 4
"""This many agents keep a thread busy for longer than it takes to hand the work over."""


@dataclass(frozen=True)
class PlanModel:
    """Horizon and resolution of the plans of a zone's agents."""

    step_s: float = 0.4
    """Time step of the search (delta), seconds; the risk field has two slices in each."""
    steps: int = 9
    """Steps to the horizon."""
    interval_s: float = 0.1
    """Time from one planning of an agent to its next, seconds, in whole ticks and at least one; in
    between it follows the path it has."""
    threads: int = 2
    """Threads that share the work; the result does not depend on their number."""

    def __post_init__(self) -> None:
        if not 0.0 <= self.interval_s <= 1.0:
            raise ValueError(f"interval_s must be at least 0 and at most 1, got {self.interval_s}")

    @property
    def slices(self) -> int:
        """Slices of the risk field after now."""
        return self.steps * SUB

    def interval_ticks(self, tick_s: float) -> int:
        """Ticks of `tick_s` seconds from one planning of an agent to its next."""
        return max(1, round(self.interval_s / tick_s))

    @property
    def slice_s(self) -> float:
        """Time between slices, seconds."""
        return self.step_s / SUB


class Batch:
    """Plans and steps for all actors of a zone at once.

    The arrays of a tick are handed over to compiled code when they change: when agents come or go,
    or want more room. Cost of a tick: O(people × slices) for the index of people, O(actors ×
    expansions × moves × people near) for the searches; both are spread over the threads.
    """

    def __init__(
        self,
        grid: LayeredGrid,
        plan: PlanModel,
        risk: RiskModel,
        spread: Spread = GAUSSIAN,
        rules: RuleModel | None = None,
    ) -> None:
        self.grid = grid
        self.plan = plan
        self.rules = rules or RuleModel()
        self.field = RiskField(grid, risk, plan.slices, spread)
        self._moves = compass_moves()
        self._branching = len(self._moves.speeds) + 1
        self._no_potential = np.full((len(grid.layered.floors), 4), np.inf, dtype=np.float32)
        self._pool = ThreadPoolExecutor(plan.threads, thread_name_prefix="planning")
        self._made_of: tuple[object, ...] = (None,)
        self._zone: Zone
        self._held: Handle[Zone]
        self._workspaces: list[Handle[Workspace]] = []
        self._budget = 0

    def close(self) -> None:
        """End the threads."""
        self._pool.shutdown()

    def _on_threads(self, work: Callable[[int], None], threads: int) -> None:
        """Call work(k) for every k at once and wait for all; their errors come up here."""
        for done in [self._pool.submit(work, k) for k in range(threads)]:
            done.result()

    def _hand_over(
        self, agents: Agents, potentials: NDArray[np.float32], prediction: Prediction, tick_s: float
    ) -> None:
        """Hand the agents over to compiled code, and make room for them."""
        budget = int(agents.parameters["max_expansions"].max())
        if budget > self._budget:
            self._budget = budget
            self._workspaces = [
                make_handle(make_workspace(budget, self._branching))
                for _ in range(self.plan.threads)
            ]
        self._zone = self._make_zone(agents, potentials, prediction, tick_s)
        self._held = make_handle(self._zone)
        self._made_of = agents, potentials, self.grid.arrays, self.field.arrays, tick_s

    def _make_zone(
        self, agents: Agents, potentials: NDArray[np.float32], prediction: Prediction, tick_s: float
    ) -> Zone:
        actors = len(agents.positions)
        slices = self.plan.slices + 1
        speeds = np.hypot(agents.velocities[:, 0], agents.velocities[:, 1])
        fastest_mps = max(float(agents.parameters["max_speed_mps"].max()), float(speeds.max()))
        self.field.make_room(prediction, fastest_mps * self.plan.step_s)
        risk = self.field.arrays
        if actors == 1:  # all people are soon looked through; buckets are not worth it
            risk = risk._replace(nx=1, ny=1)
        reservations = make_reservations(
            self.grid,
            np.empty((actors, slices, 2)),
            np.zeros((actors, slices)),
            agents.parameters["radius_m"].copy(),
            np.empty(actors, dtype=np.int64),
            fastest_mps * max(tick_s, self.plan.slice_s),
            self.rules,
        )
        return Zone(
            World(
                self.grid.arrays,
                risk,
                reservations,
                self.rules.row,
                self.plan.step_s,
                self.field.model.person_radius_m,
            ),
            self.grid.index,
            potentials,
            self._no_potential,
            self._moves,
            agents,
            np.ones(actors, dtype=np.bool_),
            np.zeros(actors),
            np.full((actors, 2), np.nan),
            np.empty(actors, dtype=np.int64),
            Decisions(
                np.empty((actors, slices, 2)),
                np.zeros((actors, 2)),
                np.zeros(actors, dtype=np.int64),
                np.zeros(actors, dtype=np.int64),
                np.zeros(actors, dtype=np.int64),
                np.zeros(actors, dtype=np.bool_),
                np.zeros(actors, dtype=np.bool_),
            ),
            np.empty((actors, 2)),
            np.empty(actors, dtype=np.int64),
            fastest_mps,
            self.field.last_wider(self.plan.slice_s),
        )

    def tick(
        self,
        agents: Agents,
        potentials: NDArray[np.float32],
        prediction: Prediction,
        tick_s: float,
        due: NDArray[np.bool_] | None = None,
        stalled_s: NDArray[np.float64] | None = None,
        steered: Mapping[int, tuple[float, float]] | None = None,
    ) -> tuple[Decisions, NDArray[np.float64], NDArray[np.int64]]:
        """Decide for everyone and take the step.

        Parameters
        ----------
        agents : state of A actors after the finished tick, A > 0
        potentials : float32 (G, N, 4), the potentials that `agents.potential_rows` points into
        prediction : people's future, as many slices as the plan has
        tick_s : length of the tick, seconds
        due : bool (A,), whose paths are planned; the others follow those that they have
        stalled_s : float64 (A,), seconds for which each has come no nearer to its goal; None for 0
        steered : by rows, the velocities of agents that are decided elsewhere, m/s

        Returns
        -------
        The decisions, and float64 (A, 2) positions and int64 (A,) cells after the tick. All are
        written over in the next one.
        """
        threads = min(self.plan.threads, 1 + len(agents.positions) // _WORTH_A_THREAD)
        self.field.make_room(prediction, 0.0)
        parts = agents, potentials, self.grid.arrays, self.field.arrays, tick_s
        if not all(map(is_, parts, self._made_of)):
            self._hand_over(agents, potentials, prediction, tick_s)
        whose: NDArray[np.bool_] | bool = True if due is None else due
        long_s: NDArray[np.float64] | float = 0.0 if stalled_s is None else stalled_s
        self._take_in(whose, long_s, steered or {})
        if not self._plan_and_step(threads, prediction, tick_s):
            self._hand_over(agents, potentials, prediction, tick_s)
            self._take_in(whose, long_s, steered or {})
            self._plan_and_step(threads, prediction, tick_s)
        return self._zone.decisions, self._zone.positions, self._zone.cells

    def _take_in(
        self,
        due: NDArray[np.bool_] | bool,
        stalled_s: NDArray[np.float64] | float,
        steered: Mapping[int, tuple[float, float]],
    ) -> None:
        zone = self._zone
        zone.due[:], zone.stalled_s[:], zone.steered[:] = due, stalled_s, np.nan
        for row, velocity in steered.items():
            zone.steered[row] = velocity

    def _plan_and_step(self, threads: int, prediction: Prediction, tick_s: float) -> bool:
        """The stages of a tick; False, and nothing done, if there is too little room."""
        zone = self._held
        if threads == 1:
            return plan_and_step(zone, self._workspaces[0], self._branching, prediction, tick_s)
        if not has_room(zone, self._workspaces[0], self._branching):
            return False
        self._on_threads(lambda k: index_future(zone, prediction, k, threads), threads)
        put_in_order(zone, tick_s)
        # Every thread takes the next portion when it is done with one: none waits for the other.
        actors = len(self._zone.order)
        portion = min(_PORTION, -(-actors // (2 * threads)))
        portions = iter(range(0, actors, portion))

        def work(k: int) -> None:
            for first in portions:
                last = min(first + portion, actors)
                decide_some(zone, prediction, tick_s, first, last, self._workspaces[k])

        self._on_threads(work, threads)
        take_steps(zone, tick_s)
        return True

    @property
    def zone(self) -> Zone:
        """The inputs and decisions of the last tick, for those who look between ticks."""
        return self._zone

    @property
    def branching(self) -> int:
        """Nodes that a search makes of one, at most."""
        return self._branching

    def settle(self, prediction: Prediction, tick_s: float) -> None:
        """Take the last tick over into the agents that it was made of."""
        settle_all(self._held, prediction, tick_s)

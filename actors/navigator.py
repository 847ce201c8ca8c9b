"""All actors of a zone, planned and moved together: perceive, plan, step."""

from __future__ import annotations

import math
from collections.abc import Hashable, Iterable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.parameters import ActorParameters, body_of
from esplanade.actors.people import ObservedPeople, People
from esplanade.actors.potential_pool import PotentialPool
from esplanade.actors.state import ActorState, Reason
from esplanade.planning import (
    AgentTable,
    Batch,
    LayeredGrid,
    PlanModel,
    Prediction,
    PredictionModel,
    RiskModel,
    SavedAgentsError,
    Scene,
    TrackHistory,
)
from esplanade.planning.scene.heights import SAME_FLOOR_M

Point = tuple[float, float]

_REASONS = tuple(Reason)
_SLACK_M = 0.02
"""A goal may lie closer to a wall than the radius by this."""


class Navigator:
    """Takes every actor to its goal among people whose future is not known.

    A tick is `observe` (where everyone is now) and `tick` (one step of every actor). Time is
    tick × `tick_s`; the seed only decides which of two with equal distances left goes first, and
    in which tick each looks for narrow places; the order in which actors were added or people are
    listed never matters.
    """

    def __init__(
        self,
        scene: Scene | LayeredGrid,
        tick_s: float = 0.1,
        seed: int = 0,
        *,
        cell_m: float = 0.25,
        plan: PlanModel | None = None,
        risk: RiskModel | None = None,
        prediction: PredictionModel | None = None,
    ) -> None:
        if not 0.0 < tick_s <= 0.5:
            raise ValueError(f"tick_s must lie in (0, 0.5], got {tick_s}")
        grid = scene if isinstance(scene, LayeredGrid) else LayeredGrid.from_scene(scene, cell_m)
        self.grid = grid
        self._bounds = grid.bounds
        self.tick_s = tick_s
        self.plan = plan or PlanModel()
        self._seed = seed
        people = prediction or PredictionModel()
        self._batch = Batch(grid, self.plan, risk or RiskModel(), people.spread)
        self._history = TrackHistory(people, tick_s)
        self._prediction = self._history.predict(grid, self.plan.slices, self.plan.slice_s)
        self.potentials = PotentialPool(grid)
        """Of the goals that actors are on their way to."""
        self.table = AgentTable(self.plan.slices)
        """Every actor's state; read it freely between two ticks."""

    # --- actors --------------------------------------------------------------------------

    def add_actor(
        self,
        actor_id: Hashable,
        position: Point,
        goal: Point | None = None,
        parameters: ActorParameters | None = None,
        *,
        z_m: float = 0.0,
        goal_z_m: float | None = None,
        heading: float = 0.0,
    ) -> None:
        """Put an actor into the zone; without a goal it stands and makes way.

        Raises
        ------
        ValueError
            The id is taken, or a position is not finite or outside the bounds. Nothing is changed
            then.
        """
        if actor_id in self.table:
            raise ValueError(f"there already is an actor {actor_id!r}")
        self.check_place(position, z_m)
        if goal is not None:
            self.check_place(goal, z_m if goal_z_m is None else goal_z_m)
        parameters = parameters or ActorParameters()
        cell = self._cell(position, z_m)
        row = self.table.add(
            actor_id,
            (float(position[0]), float(position[1]), self._floor(cell)),
            parameters.row(),
            cell=cell,
            layer=self._layer(cell),
            heading=heading,
        )
        self._fit_body(row)
        self._rank()
        if goal is not None:
            self.set_goal(actor_id, goal, z_m=z_m if goal_z_m is None else goal_z_m)

    def remove_actor(self, actor_id: Hashable) -> None:
        """Take an actor out; KeyError when there is none of that id."""
        row = self.table.row(actor_id)
        self.potentials.release(int(self.table.agents.potential_rows[row]))
        self.table.remove(actor_id)
        self._rank()

    def set_goal(self, actor_id: Hashable, goal: Point | None, *, z_m: float = 0.0) -> None:
        """Send an actor somewhere, or let it stand (None). A goal inside a wall is moved out."""
        row = self.table.row(actor_id)
        target = None
        if goal is not None:
            self.check_place(goal, z_m)
            target = float(goal[0]), float(goal[1]), float(z_m)
        self._head_for(row, target)
        trips = self.table.trips
        trips.wanted[row] = np.nan if target is None else target
        trips.arrived[row] = False
        trips.no_path_s[row] = 0.0

    def _head_for(self, row: int, target: tuple[float, float, float] | None) -> None:
        """Let an actor go by the potential of a goal, or by none."""
        agents = self.table.agents
        old, new = int(agents.potential_rows[row]), -1
        if target is not None:
            new = self._potential_row(row, target)
        agents.potential_rows[row] = new
        agents.known[row] = agents.known[row] and new == old
        agents.left_m[row] = np.nan
        agents.behind_s[row] = 0.0
        agents.passages[row] = 0.0
        self.potentials.release(old)

    def _potential_row(self, row: int, target: tuple[float, float, float]) -> int:
        """The potential of an actor's goal, -1 where none can be; its `goals` are moved out of
        walls."""
        body = body_of(self.table.agents.parameters[row])
        free = self.grid.nearest_free(target[:2], target[2], body.radius_m - _SLACK_M, body)
        if free is None:
            return -1
        self.table.agents.goals[row] = free
        return self.potentials.take(free, target[2], body)

    def prepare_goals(
        self, goals: Iterable[tuple[Point, float]], parameters: ActorParameters
    ) -> None:
        """Derive the potentials of goals, (x, y) and a height, before a tick has to wait for them.

        Goals where nobody can stand are left out.
        """
        body = parameters.body
        fits_m = body.radius_m - _SLACK_M
        free = [(self.grid.nearest_free(goal, z_m, fits_m, body), z_m) for goal, z_m in goals]
        keys = [(*goal, z_m, body) for goal, z_m in free if goal is not None]
        self.potentials.prepare(keys, self.plan.threads)

    def set_parameters(self, actor_id: Hashable, parameters: ActorParameters) -> None:
        """Change an actor's parameters from the next tick on."""
        row = self.table.row(actor_id)
        records = self.table.agents.parameters
        before = body_of(records[row])
        records[row] = parameters.row()
        if before != parameters.body:
            self._fit_body(row)
            goal = self.table.wanted(row)
            if goal is not None:
                self._head_for(row, goal)

    def _fit_body(self, row: int) -> None:
        """Find what the ground and the risk are for an actor's body."""
        agents = self.table.agents
        body = body_of(agents.parameters[row])
        agents.bodies[row] = self.grid.row_of(body)
        agents.contacts[row] = self._batch.field.contact_row(body.radius_m)

    def place_actor(
        self, actor_id: Hashable, position: Point, velocity: tuple[float, float] = (0.0, 0.0)
    ) -> None:
        """Put an actor where another simulation has it; the path it follows stays."""
        row = self.table.row(actor_id)
        agents = self.table.agents
        z_m = self._floor(int(agents.cells[row]))
        self.check_place(position, z_m)
        if not (math.isfinite(velocity[0]) and math.isfinite(velocity[1])):
            raise ValueError(f"velocity of {actor_id!r} must be finite, got {velocity}")
        cell = self._cell(position, z_m)
        agents.positions[row] = position
        agents.velocities[row] = velocity
        agents.cells[row] = cell
        agents.heights[row] = self._floor(cell)
        agents.layers[row] = self._layer(cell)

    def ground_changed(self, *, renewed_outside: bool = False) -> None:
        """The ground has changed: potentials are derived anew, one a tick, used ones first.

        With `renewed_outside`, they are as they were until somebody renews them in `potentials`.
        Until its turn comes an actor may walk up to what has closed; it never walks through.
        """
        if renewed_outside:
            self.potentials.outdate()
        else:
            self.potentials.forget()

    def parameters(self, actor_id: Hashable) -> ActorParameters:
        """An actor's parameters."""
        return ActorParameters.of_row(self.table.agents.parameters[self.table.row(actor_id)])

    def load(self, header: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> None:
        """Take the actors of a saved table (`AgentTable.save`) in the place of those here.

        Raises
        ------
        SavedAgentsError
            The table cannot be read, or was planned with another horizon; nothing is changed then.
        """
        table = AgentTable.load(header, arrays)
        if table.agents.planned.shape[1] != self.plan.slices + 1:
            raise SavedAgentsError(
                f"saved agents plan {table.agents.planned.shape[1] - 1} slices ahead, "
                f"this zone {self.plan.slices}"
            )
        for slot in self.table.agents.potential_rows.tolist():
            self.potentials.release(slot)
        self.table = table
        for row in range(len(table)):
            self._fit_body(row)
            target = table.wanted(row)
            if target is not None:
                table.agents.potential_rows[row] = self._potential_row(row, target)
        self._rank()

    # --- ticks ---------------------------------------------------------------------------

    def observe(self, people: People) -> None:
        """Tell where everyone is at this tick: id -> (x, y) or (x, y, z).

        People who are absent have left. Call it once before every tick.

        Raises
        ------
        ValueError
            A position is not finite; nothing is changed then.
        """
        if isinstance(people, ObservedPeople):
            self._history.observe_arrays(people.ids, people.places)
        else:
            self._history.observe(people)

    def advance(self) -> None:
        """Plan and take one step for every actor; `table` holds the result."""
        self.potentials.renew_one()
        self._prediction = self._history.predict(self.grid, self.plan.slices, self.plan.slice_s)
        if len(self.table):
            agents = self.table.agents
            self._batch.tick(agents, self.potentials.arrays, self._prediction, self.tick_s)
            self._batch.settle(self.tick_s)

    def tick(self) -> dict[Hashable, ActorState]:
        """`advance`, then the states of all actors; id -> state."""
        self.advance()
        return {actor_id: self._shown(row) for row, actor_id in enumerate(self.table)}

    def state(self, actor_id: Hashable) -> ActorState:
        """One actor's state as of the latest tick, or as it was put there."""
        return self._shown(self.table.row(actor_id))

    def _shown(self, row: int) -> ActorState:
        agents = self.table.agents
        x, y = agents.positions[row].tolist()
        vx, vy = agents.velocities[row].tolist()
        return ActorState(
            (x, y),
            int(agents.layers[row]),
            float(agents.heights[row]),
            (vx, vy),
            float(agents.headings[row]),
            _REASONS[agents.reasons[row]],
            self.table.wanted(row),
            self.plan.slice_s,
            agents.planned[row].copy(),
        )

    def predicted_near(
        self, position: Point, z_m: float, within_m: float
    ) -> list[NDArray[np.float64]]:
        """One array for each person now in that distance: (K, 4) float64 x, y, z, deviation m."""
        p: Prediction = self._prediction
        out = []
        for k in range(len(p.means)):
            away = np.hypot(*(p.means[k, 0] - np.asarray(position)))
            if abs(p.heights[k, 0] - z_m) < SAME_FLOOR_M and away <= within_m:
                out.append(np.column_stack([p.means[k], p.heights[k], p.sigmas[k]]))
        return out

    def close(self) -> None:
        """End the planning threads."""
        self._batch.close()

    def check_place(self, position: Point, z_m: float) -> None:
        """ValueError unless an actor may be put there or sent there."""
        x0, y0, x1, y1 = self._bounds
        x, y = position
        if not (math.isfinite(x) and math.isfinite(y) and math.isfinite(z_m)):
            raise ValueError(f"a place must be finite, got ({x}, {y}) at height {z_m}")
        if not (x0 <= x <= x1 and y0 <= y <= y1):
            raise ValueError(f"({x:g}, {y:g}) lies outside the bounds {self._bounds}")

    def _cell(self, position: Point, z_m: float) -> int:
        return self.grid.cell_at(position, z_m)

    def _floor(self, cell: int) -> float:
        return float(self.grid.layered.floors[cell]) if cell >= 0 else 0.0

    def _layer(self, cell: int) -> int:
        return int(self.grid.layered.places["layer"][cell]) if cell >= 0 else 0

    def _rank(self) -> None:
        """Order actors with equal distances left: a hash of id and seed, free of ties."""
        keys = [(_priority(self._seed, who), str(who)) for who in self.table]
        order = sorted(range(len(keys)), key=keys.__getitem__)
        self.table.agents.ranks[order] = np.arange(len(keys))


def _priority(seed: int, who: Hashable) -> int:
    """A number that is the same in every run for the same seed and id (FNV-1a, 64 bits).

    It decides ranks, so that another hash would be another world.
    """
    state = 0xCBF29CE484222325 ^ (seed & 0xFFFFFFFFFFFFFFFF)
    for byte in str(who).encode():
        state = ((state ^ byte) * 0x100000001B3) & 0xFFFFFFFFFFFFFFFF
    return state ^ (state >> 29)

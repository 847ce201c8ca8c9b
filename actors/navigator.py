"""All actors of a zone, planned and moved together: perceive, plan, step."""

from __future__ import annotations

import math
from collections.abc import Hashable, Mapping

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.parameters import ActorParameters
from esplanade.actors.potential_pool import PotentialPool
from esplanade.actors.state import ActorState, Reason
from esplanade.planning import (
    PARAMETERS,
    PASSAGE,
    Agents,
    Batch,
    LayeredGrid,
    PlanModel,
    Prediction,
    PredictionModel,
    RiskModel,
    Scene,
    TrackHistory,
)
from esplanade.planning.people.prediction import Coordinates
from esplanade.planning.scene.heights import SAME_FLOOR_M

Point = tuple[float, float]

_REASONS = tuple(Reason)
_SLACK_M = 0.02
"""A goal may lie so much closer to a wall than the radius."""


class Navigator:
    """Takes every actor to its goal among people whose future is not known.

    A tick is `observe` (where everyone is now) and `tick` (one step of every actor). Time is
    tick × `tick_s`; the seed decides nothing but who goes first of two with equal ways left, and
    who looks for narrow places when; the order in which actors were added or people are listed
    never matters.
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
        self._potentials = PotentialPool(grid)
        self._ids: list[Hashable] = []
        self._rows: dict[Hashable, int] = {}
        self._headings = np.zeros(0)
        self._crowd = _empty_crowd(self.plan.slices + 1)
        self._parameters: dict[Hashable, ActorParameters] = {}
        self._goals: dict[Hashable, tuple[float, float, float] | None] = {}

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
        if actor_id in self._rows:
            raise ValueError(f"there already is an actor {actor_id!r}")
        self.check_place(position, z_m)
        if goal is not None:
            self.check_place(goal, z_m if goal_z_m is None else goal_z_m)
        c = self._crowd
        parameters = parameters or ActorParameters()
        rows = len(self._ids)
        slices = self.plan.slices + 1
        self._crowd = Agents(
            np.concatenate([c.positions, np.array([position], dtype=np.float64)]),
            np.concatenate([c.velocities, np.zeros((1, 2))]),
            np.append(c.cells, self._cell(position, z_m)),
            np.append(c.bodies, self._body_row(parameters)),
            np.concatenate([c.goals, np.array([position], dtype=np.float64)]),
            np.append(c.potential_rows, np.int64(-1)),
            np.append(c.parameters, parameters.row()),
            c.ranks,
            np.append(c.known, False),
            np.append(c.ages, np.int64(0)),
            np.concatenate([c.followed, np.zeros((1, slices, 2))]),
            np.append(c.left_m, np.nan),
            np.append(c.behind_s, 0.0),
            np.append(c.passages, np.zeros(1, dtype=PASSAGE)),
        )
        self._ids.append(actor_id)
        self._rows[actor_id] = rows
        self._headings = np.append(self._headings, heading)
        self._parameters[actor_id] = parameters
        self._goals[actor_id] = None
        self._rank()
        if goal is not None:
            self.set_goal(actor_id, goal, z_m=z_m if goal_z_m is None else goal_z_m)

    def remove_actor(self, actor_id: Hashable) -> None:
        """Take an actor out; KeyError when there is none of that id."""
        row = self._row(actor_id)
        self._potentials.release(int(self._crowd.potential_rows[row]))
        fields = {
            name: np.delete(array, row, axis=0) for name, array in self._crowd._asdict().items()
        }
        self._crowd = Agents(**fields)
        self._headings = np.delete(self._headings, row)
        del self._ids[row], self._parameters[actor_id], self._goals[actor_id]
        self._rows = {who: k for k, who in enumerate(self._ids)}
        self._rank()

    def set_goal(self, actor_id: Hashable, goal: Point | None, *, z_m: float = 0.0) -> None:
        """Send an actor somewhere, or let it stand (None). A goal inside a wall is moved out."""
        row = self._row(actor_id)
        if goal is not None:
            self.check_place(goal, z_m)
        c = self._crowd
        old = int(c.potential_rows[row])
        slot = -1
        target = None if goal is None else (float(goal[0]), float(goal[1]), float(z_m))
        if target is not None:
            body = self._parameters[actor_id].body
            free = self.grid.nearest_free(target[:2], z_m, body.radius_m - _SLACK_M, body)
            if free is not None:
                slot = self._potentials.take(free, z_m, body)
                c.goals[row] = free
        c.potential_rows[row] = slot
        c.known[row] = c.known[row] and slot == old
        c.left_m[row] = np.nan
        c.behind_s[row] = 0.0
        c.passages[row] = 0.0
        self._potentials.release(old)
        self._goals[actor_id] = target

    def prepare_goal(self, goal: Point, z_m: float, parameters: ActorParameters) -> None:
        """Work out the potential of a goal before somebody needs it in the middle of a tick."""
        body = parameters.body
        free = self.grid.nearest_free(goal, z_m, body.radius_m - _SLACK_M, body)
        if free is not None:
            self._potentials.release(self._potentials.take(free, z_m, body))

    def set_parameters(self, actor_id: Hashable, parameters: ActorParameters) -> None:
        """Change an actor's parameters from the next tick on."""
        row = self._row(actor_id)
        before = self._parameters[actor_id]
        self._parameters[actor_id] = parameters
        self._crowd.parameters[row] = parameters.row()
        goal = self._goals[actor_id]
        if before.body != parameters.body:
            self._crowd.bodies[row] = self._body_row(parameters)
            if goal is not None:
                self.set_goal(actor_id, goal[:2], z_m=goal[2])

    def place_actor(
        self, actor_id: Hashable, position: Point, velocity: tuple[float, float] = (0.0, 0.0)
    ) -> None:
        """Put an actor where another simulation has it; the path it follows stays."""
        row = self._row(actor_id)
        z_m = self._floor(int(self._crowd.cells[row]))
        self.check_place(position, z_m)
        if not (math.isfinite(velocity[0]) and math.isfinite(velocity[1])):
            raise ValueError(f"velocity of {actor_id!r} must be finite, got {velocity}")
        self._crowd.positions[row] = position
        self._crowd.cells[row] = self._cell(position, z_m)
        self._crowd.velocities[row] = velocity

    def ground_changed(self) -> None:
        """The ground has changed: potentials are derived anew, one a tick, used ones first.

        Until its turn comes an actor may walk up to what has closed; it never walks through.
        """
        self._potentials.forget()

    def parameters(self, actor_id: Hashable) -> ActorParameters:
        """An actor's parameters."""
        return self._parameters[self._ids[self._row(actor_id)]]

    # --- ticks ---------------------------------------------------------------------------

    def observe(self, people: Mapping[Hashable, Coordinates]) -> None:
        """Tell where everyone is at this tick: id -> (x, y) or (x, y, z).

        Who is absent has left. Call it once before every `tick`.

        Raises
        ------
        ValueError
            A position is not finite; nothing is changed then.
        """
        self._history.observe(people)

    def tick(self) -> dict[Hashable, ActorState]:
        """Plan and take one step for every actor; id -> state."""
        self._potentials.renew_one()
        self._prediction = self._history.predict(self.grid, self.plan.slices, self.plan.slice_s)
        if not self._ids:
            return {}
        self._batch.tick(self._crowd, self._potentials.arrays, self._prediction, self.tick_s)
        shown, ways = self._batch.settle(self.tick_s, self._headings)
        return {
            who: self._state(who, row, way)
            for who, row, way in zip(self._ids, shown.tolist(), ways, strict=True)
        }

    def state(self, actor_id: Hashable) -> ActorState:
        """An actor as it stands, before its first tick."""
        row = self._row(actor_id)
        c = self._crowd
        cell = int(c.cells[row])
        x, y = c.positions[row].tolist()
        vx, vy = c.velocities[row].tolist()
        z_m = self._floor(cell)
        layer = self.grid.layered.places["layer"][cell] if cell >= 0 else 0
        shown = [x, y, layer, z_m, vx, vy, float(self._headings[row]), Reason.WAITING]
        return self._state(actor_id, shown, np.array([[x, y, z_m]]))

    def _state(
        self, actor_id: Hashable, shown: list[float], way: NDArray[np.float64]
    ) -> ActorState:
        x, y, layer, z_m, vx, vy, heading, reason = shown
        return ActorState(
            (x, y),
            int(layer),
            z_m,
            (vx, vy),
            heading,
            _REASONS[int(reason)],
            self._goals[actor_id],
            self.plan.slice_s,
            way,
        )

    def predicted_near(
        self, position: Point, z_m: float, within_m: float
    ) -> list[NDArray[np.float64]]:
        """For each person now within that distance: float64 (K, 4) x, y, z, deviation m."""
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

    def _row(self, actor_id: Hashable) -> int:
        try:
            return self._rows[actor_id]
        except KeyError:
            raise KeyError(f"there is no actor {actor_id!r}") from None

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

    def _body_row(self, parameters: ActorParameters) -> int:
        return self.grid.row_of(parameters.body)

    def _rank(self) -> None:
        """Order among those with equal ways left: a hash of id and seed, free of ties."""
        keys = [(_priority(self._seed, who), str(who)) for who in self._ids]
        order = sorted(range(len(keys)), key=keys.__getitem__)
        ranks = np.empty(len(keys), dtype=np.int64)
        ranks[order] = np.arange(len(keys))
        self._crowd = self._crowd._replace(ranks=ranks)


def _priority(seed: int, who: Hashable) -> int:
    """A number that is the same in every run for the same seed and id."""
    state = 0xCBF29CE484222325 ^ (seed & 0xFFFFFFFFFFFFFFFF)
    for byte in str(who).encode():
        state = ((state ^ byte) * 0x100000001B3) & 0xFFFFFFFFFFFFFFFF
    return state ^ (state >> 29)


def _empty_crowd(slices: int) -> Agents:
    return Agents(
        np.zeros((0, 2)),
        np.zeros((0, 2)),
        np.zeros(0, dtype=np.int64),
        np.zeros(0, dtype=np.int64),
        np.zeros((0, 2)),
        np.zeros(0, dtype=np.int64),
        np.zeros(0, dtype=PARAMETERS),
        np.zeros(0, dtype=np.int64),
        np.zeros(0, dtype=np.bool_),
        np.zeros(0, dtype=np.int64),
        np.zeros((0, slices, 2)),
        np.zeros(0),
        np.zeros(0),
        np.zeros(0, dtype=PASSAGE),
    )

"""All actors of a zone, planned and moved together: perceive, plan, step."""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from functools import lru_cache
from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from esplanade.actors.bodies_near import Bodies
from esplanade.actors.derived_rows import DerivedRows
from esplanade.actors.detours import LOOK_EVERY_S, Detours
from esplanade.actors.outcomes import InTheWay, Kind, Outcome
from esplanade.actors.parameter_records import with_values
from esplanade.actors.parameters import ActorParameters, body_of
from esplanade.actors.people import ObservedPeople, People
from esplanade.actors.planning_interval import PlanningInterval
from esplanade.actors.potential_pool import Goal, GoalKey, PotentialPool, goal_key
from esplanade.actors.saved_agents import check_saved, with_new_parameters
from esplanade.actors.saved_detours import read_detours
from esplanade.actors.standing import StandingPeople, stand_on
from esplanade.actors.standing_discs import ACTOR_ROOM_M, PERSON_ROOM_M, Standing
from esplanade.actors.state import ActorState, Reason
from esplanade.actors.traces import Decided, Trace
from esplanade.actors.tracing import Tracing
from esplanade.actors.trip_ends import TripEnds
from esplanade.planning import (
    AgentTable,
    Batch,
    Body,
    LayeredGrid,
    MovedEnd,
    MoveReason,
    PlanModel,
    Prediction,
    PredictionModel,
    RiskModel,
    RuleModel,
    SavedAgentsError,
    Scene,
    TrackHistory,
)
from esplanade.planning.scene.heights import SAME_FLOOR_M

Point = tuple[float, float]

_REASONS = tuple(Reason)
_TURNS = 8
"""Actors look for people in their way by turns, so many of them."""


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
        rules: RuleModel | None = None,
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
        self._batch = Batch(grid, self.plan, risk or RiskModel(), people.spread, rules)
        self._history = TrackHistory(people, tick_s)
        self._prediction = self._history.predict(grid, self.plan.slices, self.plan.slice_s)
        self.potentials = PotentialPool(grid)
        """Of the goals that actors are on their way to."""
        self._rows = DerivedRows(grid, self._batch.field, self.potentials)
        self.detours = Detours(grid, self.potentials)
        """Ways around people who have stood in a narrow place for a while."""
        self._ends = TripEnds(grid, self.potentials)
        self._standing = StandingPeople()
        self.table = AgentTable(self.plan.slices)
        """Every actor's state; read it freely between two ticks."""
        self.planning_interval = PlanningInterval(self.plan.interval_ticks(tick_s))
        """At which actors are planned from the next tick on; its `ticks` may be changed."""
        self.tracing = Tracing(self._batch, self.plan, tick_s)

    @property
    def person_radius_m(self) -> float:
        """Radius of the people of this zone, metres."""
        return self._batch.field.model.person_radius_m

    @property
    def prediction(self) -> Prediction:
        """The places where people are expected, as of the latest tick."""
        return self._prediction

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
        self.check_place(position, z_m)
        if goal is not None:
            self.check_place(goal, z_m if goal_z_m is None else goal_z_m)
        records = (parameters or ActorParameters()).row()[None]
        self.add_actors([actor_id], [(*position, z_m)], records, headings=[heading])
        if goal is not None:
            self.set_goal(actor_id, goal, z_m=z_m if goal_z_m is None else goal_z_m)

    def add_actors(
        self,
        ids: Sequence[Hashable],
        places: Sequence[tuple[float, float, float]],
        records: NDArray[np.void],
        *,
        headings: Sequence[float] | None = None,
    ) -> None:
        """Put N actors into the zone that stand at places x, y, z; records (N,) say how.

        Raises
        ------
        ValueError
            An id is taken or occurs twice, a place is not finite or outside the bounds, or too many
            kinds of body walk here. Nothing is changed then.
        """
        for x, y, z_m in places:
            self.check_place((x, y), z_m)
        points = np.array(places, dtype=np.float64).reshape(-1, 3)
        cells = np.array([self._cell((x, y), z) for x, y, z in places], dtype=np.int64)
        points[:, 2] = [self._floor(cell) for cell in cells.tolist()]
        layers = np.array([self._layer(cell) for cell in cells.tolist()], dtype=np.int64)
        claims = self._rows.claim([body_of(record) for record in records])
        turned = np.zeros(len(ids)) if headings is None else np.array(headings, dtype=np.float64)
        first = len(self.table)
        try:
            self.table.add(ids, points, records, cells=cells, layers=layers, headings=turned)
        except ValueError:
            self._rows.release(records)
            raise
        agents = self.table.agents
        agents.bodies[first:] = claims
        agents.contacts[first:] = self._rows.contacts(records)
        self._rank()

    def remove_actors(self, ids: Sequence[Hashable]) -> None:
        """Take actors out; KeyError when one is not there, and nothing is changed then."""
        rows = [self.table.row(each) for each in dict.fromkeys(ids)]
        agents, own_rows = self.table.agents, self.table.trips.own_rows
        self.table.remove(list(dict.fromkeys(ids)))
        for row in rows:
            self.potentials.release(int(own_rows[row]))
        self._rows.release(agents.parameters[rows])
        self._rank()

    def remove_actor(self, actor_id: Hashable) -> None:
        """Take an actor out; KeyError when there is none of that id."""
        self.remove_actors([actor_id])

    def set_goal(
        self, actor_id: Hashable, goal: Point | None, *, z_m: float = 0.0, strict: bool = False
    ) -> None:
        """Send an actor somewhere, or let it stand (None).

        A goal where its body does not fit is moved to the nearest place where it does; `moved`
        tells by how much and why. If it is `strict`, the actor stays instead, with no path.
        """
        row = self.table.row(actor_id)
        self.table.trips.strict[row] = strict
        target: Goal | None = None
        if goal is not None:
            self.check_place(goal, z_m)
            target = float(goal[0]), float(goal[1]), float(z_m)
        self._rows.head_for(self.table, row, target)
        trips = self.table.trips
        if target is None:
            trips.moved_m[row], trips.moved_why[row] = 0.0, 0
        trips.wanted[row] = np.nan if target is None else target
        turn = int(self.table.agents.ranks[row]) % _TURNS
        trips.look_in_s[row], trips.shut[row] = LOOK_EVERY_S * turn / _TURNS, False
        self.begin_trip(actor_id)

    def begin_trip(self, actor_id: Hashable) -> None:
        """Let an actor's trip to the goal that it has begin anew, without an outcome."""
        row, agents, trips = self.table.row(actor_id), self.table.agents, self.table.trips
        trips.outcomes[row], trips.nearest_m[row] = 0, np.nan
        trips.stalled_s[row] = trips.queued_s[row] = trips.no_path_s[row] = 0.0
        agents.waits[row], agents.cautions[row] = False, 1.0
        self.table.in_the_way.pop(actor_id, None)

    def moved(self, actor_id: Hashable) -> MovedEnd | None:
        """How an actor's goal was moved, or would be if it is strict; None if by at most 0.25 m."""
        row = self.table.row(actor_id)
        agents, trips, target = self.table.agents, self.table.trips, self.table.wanted(row)
        if target is None or not trips.moved_why[row]:
            return None
        x, y = agents.goals[row].tolist()
        place = x, y, self.grid.floor_at((x, y), target[2])
        why = MoveReason(int(trips.moved_why[row]))
        return MovedEnd(float(trips.moved_m[row]), why, target, place)

    def waypoint(self, actor_id: Hashable) -> Point | None:
        """The point that an actor's way leads straight to: its goal, or a corner before it.

        None where no way leads, or it is not known yet.
        """
        row, agents = self.table.row(actor_id), self.table.agents
        potential, cell = int(agents.potential_rows[row]), int(agents.cells[row])
        x, y = agents.positions[row].tolist()
        for _ in range(2):
            if potential < 0 or cell < 0:
                return None
            left_m, wx, wy, _ = self.potentials.arrays[potential, cell].tolist()
            if not math.isfinite(left_m):
                return None
            if left_m == 0.0 or math.hypot(wx - x, wy - y) >= 0.25 * self.grid.cell_m:
                break
            cell = self._cell((wx, wy), self._floor(cell))
        return wx, wy

    def prepare_goals(
        self, goals: Iterable[tuple[Point, float]], parameters: ActorParameters
    ) -> None:
        """Derive the potentials of goals, (x, y) and a height, before a tick has to wait for them.

        Goals where nobody can stand are left out.
        """
        keys = [goal_key(self.grid, (*goal, z_m), parameters.body) for goal, z_m in goals]
        self.potentials.prepare([key for key in keys if key is not None], self.plan.threads)

    def set_parameters(self, actor_id: Hashable, parameters: ActorParameters) -> None:
        """Change an actor's parameters from the next tick on; as `set_many`."""
        self.set_many([actor_id], parameters.model_dump())

    def set_many(
        self,
        ids: Sequence[Hashable],
        values: Mapping[str, ArrayLike],
        prepared: Mapping[GoalKey, NDArray[np.float32]] | None = None,
    ) -> None:
        """Change some parameters of N different actors from the next tick on: all, or none.

        Parameters
        ----------
        values : by the parameter's name, one number for all or N
        prepared : potentials of goals for bodies that are new here, derived before

        Raises
        ------
        ParameterError
            An actor cannot have its values. Nothing is changed then.
        KeyError
            One of the actors is not there. Nothing is changed then.
        ValueError
            Too many kinds of body would walk here, or an actor is named twice. Nothing is changed
            then.
        """
        rows, after = self._changed(ids, values)
        self._rows.change(self.table, rows, after, prepared)

    def new_bodies(
        self, ids: Sequence[Hashable], values: Mapping[str, ArrayLike]
    ) -> list[tuple[Goal | None, Body]]:
        """The bodies that `set_many` would make others, each with the goal of its actor.

        Raises
        ------
        ParameterError, KeyError, ValueError
            As of `set_many`.
        """
        rows, after = self._changed(ids, values)
        new = self._rows.of_new_kind(self.table.agents.parameters[rows], after).tolist()
        return [(self.table.wanted(int(rows[k])), body_of(after[k])) for k in new]

    def check_values(self, ids: Sequence[Hashable], values: Mapping[str, ArrayLike]) -> None:
        """Raise what `set_many` would, except that too many kinds of body would walk here."""
        self._changed(ids, values)

    def _changed(
        self, ids: Sequence[Hashable], values: Mapping[str, ArrayLike]
    ) -> tuple[NDArray[np.int64], NDArray[np.void]]:
        """Rows of some actors, and their records with other values."""
        row_of = self.table.row
        rows = np.fromiter((row_of(actor_id) for actor_id in ids), np.int64, len(ids))
        if len(set(ids)) < len(ids):
            raise ValueError("an actor is named twice")
        return rows, with_values(self.table.agents.parameters[rows], ids, values)

    def prepare_contacts(self, bodies: Iterable[Body]) -> None:
        """Derive what risk is for some bodies before a tick has to; safe in any thread."""
        self._batch.field.prepare_contacts(body.radius_m for body in bodies)

    def place_actor(
        self,
        actor_id: Hashable,
        position: Point,
        velocity: tuple[float, float] = (0.0, 0.0),
        *,
        z_m: float | None = None,
    ) -> None:
        """Put an actor where another simulation has it; the path it follows stays.

        Without `z_m` it is on the floor nearest in height to where it is.
        """
        row = self.table.row(actor_id)
        agents = self.table.agents
        if z_m is None:
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
        agents.on_edges[row] = 0

    def set_back(self, actor_id: Hashable) -> None:
        """Let an actor forget the path that it follows: it is somewhere else now."""
        row = self.table.row(actor_id)
        agents = self.table.agents
        agents.known[row], agents.left_m[row], agents.behind_s[row] = False, np.nan, 0.0
        agents.passages[row] = 0.0
        agents.planned[row, :, :2], agents.planned[row, :, 2] = (
            agents.positions[row],
            agents.heights[row],
        )

    def undo_point(self) -> Callable[[], None]:
        """Return a call that puts all actors back, if a tick or a change fails half-way."""
        restore, around = self.table.undo_point(), self.detours.undo_point()
        count = self.planning_interval.count

        def undo() -> None:
            self._rows.give_back(self.table)
            restore()
            self.planning_interval.count = count
            self.tracing.forget()
            self._rows.take_all(self.table)
            self.detours.put_back(self.table, around)
            self._rank()

        return undo

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

    def save(self) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
        """The table as `AgentTable.save` gives it, and all else that later ticks depend on.

        That is where people stood, ways around them, and who is due when.

        Raises
        ------
        TypeError
            As of `AgentTable.save`.
        """
        header, arrays = self.table.save()
        standing, around = self._standing.save(), self.detours.save(self.table)
        due = self.planning_interval.save()
        return {**header, "standing": standing, "detours": around, "planning": due}, arrays

    def load(self, header: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> None:
        """Take the actors of a saved table (`AgentTable.save`) in the place of those here.

        Raises
        ------
        SavedAgentsError
            The table cannot be read, or was planned with another horizon; nothing is changed then.
        """
        table = self._checked_table(header, arrays)
        standing = StandingPeople()
        try:
            standing.load(header.get("standing", ()))
        except (TypeError, ValueError, IndexError) as error:
            raise SavedAgentsError(f"where people stood cannot be read: {error}") from error
        try:
            detours = read_detours(header.get("detours", ()), len(table))
        except (TypeError, ValueError) as error:
            raise SavedAgentsError(f"ways around people cannot be read: {error}") from error
        self.planning_interval.load(header.get("planning", {}))
        self._rows.give_back(self.table)
        self.table, self._standing = table, standing
        self.tracing.forget()
        self._rows.take_all(table)
        self.detours.load(table, detours)
        self._rank()

    def _checked_table(
        self, header: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]
    ) -> AgentTable:
        table = AgentTable.load(header, with_new_parameters(arrays))
        if table.agents.planned.shape[1] != self.plan.slices + 1:
            raise SavedAgentsError(
                f"saved agents plan {table.agents.planned.shape[1] - 1} slices ahead, "
                f"this zone {self.plan.slices}"
            )
        check_saved(table, self.grid)
        return table

    def save_exactly(self) -> dict[str, Any]:
        """Everything that later ticks depend on, bit for bit, as plain data and copies of arrays.

        Beside what `save` gives these are the past of people, cells, and potentials as they are
        while the ground has changed and not all are derived anew.

        Raises
        ------
        TypeError
            As of `AgentTable.save`.
        """
        header, columns = self.table.save()
        agents, trips = self.table.agents, self.table.trips
        return {
            "table": header,
            "columns": columns,
            "rows": np.column_stack([trips.own_rows, agents.potential_rows]),
            "planning": self.planning_interval.save(),
            "standing": self._standing.save_exactly(),
            "tracks": self._history.save(),
            "potentials": self.potentials.save(),
            "detours": self.detours.save_exactly(),
        }

    def load_exactly(self, saved: Mapping[str, Any]) -> None:
        """Go on bit for bit from what `save_exactly` gave, in the place of all actors here.

        Raises
        ------
        ValueError, KeyError, TypeError
            Something is missing, or cannot be. Nothing is to be done with this navigator then.
        """
        table = self._checked_table(saved["table"], saved["columns"])
        cells = np.asarray(saved["columns"]["cells"])
        if ((cells < -1) | (cells >= len(self.grid.layered.floors))).any():
            raise SavedAgentsError("column 'cells' of saved agents has a value that cannot be")
        table.agents.cells[:] = cells
        table.agents.layers[:] = saved["columns"]["layers"]
        self._rows.give_back(self.table)
        self.table = table
        self.tracing.forget()
        self._rows.take_bodies(table)
        self.potentials.load(saved["potentials"])
        rows = np.asarray(saved["rows"], dtype=np.int64).reshape(len(table), 2)
        if ((rows < -1) | (rows >= len(self.potentials.users))).any():
            raise SavedAgentsError("a saved agent goes by a potential that is not there")
        table.trips.own_rows[:], table.agents.potential_rows[:] = rows.T
        self.detours.load_exactly(saved["detours"])
        self.planning_interval.load(saved["planning"])
        self._standing.load_exactly(saved["standing"])
        self._history.load(saved["tracks"])
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

    def advance(self, steered: Mapping[Hashable, Point] | None = None) -> None:
        """Plan and take one step for every actor; `table` holds the result.

        Those in `steered` go at these velocities, m/s, within their limits, and plan nothing; walls
        and other actors still stop them.
        """
        self.potentials.renew_one()
        self._prediction = self._history.predict(self.grid, self.plan.slices, self.plan.slice_s)
        if len(self.table):
            agents = self.table.agents
            if self.tracing.wanted:
                self.tracing.keep(agents, self.table.version)
            else:
                self.tracing.forget()
            due = self.planning_interval.due(agents.ranks)
            self._batch.tick(
                agents,
                self.potentials.arrays,
                self._prediction,
                self.tick_s,
                due,
                self.table.trips.stalled_s,
                {self.table.row(who): velocity for who, velocity in (steered or {}).items()},
            )
            self._batch.settle(self._prediction, self.tick_s)
            self.planning_interval.count += 1
            self._wait_for_potentials()
            self._end_trips()

    def bodies(self, people: Sequence[Hashable], places: NDArray[np.float64]) -> Bodies:
        """The bodies of people at places (P, 3), and of all actors."""
        agents = self.table.agents
        actors = np.column_stack([agents.positions, agents.heights])
        radii = agents.parameters["radius_m"]
        return Bodies(
            np.concatenate([places, actors]),
            np.concatenate([np.full(len(people), self.person_radius_m), radii]),
            people,
            self.table.ids,
        )

    def _end_trips(self) -> None:
        """Keep account of trips, of who stands where, and of ways around those who do."""
        trips, people = self.table.trips, self._standing
        people.observe(self._history.ids, self._history.places, self._history.version, self.tick_s)
        bodies = self.bodies(people.ids, self._history.places)
        self._ends.keep(self.table, bodies, people.stood_s, self.tick_s)
        places = bodies.places[len(people.ids) :]
        on_way = ~np.isnan(trips.wanted[:, 0]) & (trips.outcomes == 0)
        stand_on(places, trips.stood_at, trips.stood_s, self.tick_s)
        trips.stood_at[on_way], trips.stood_s[on_way] = places[on_way], 0.0
        rooms_m = np.full(len(bodies.radii), ACTOR_ROOM_M)
        rooms_m[: len(people.ids)] = PERSON_ROOM_M
        anchors = np.concatenate([people.anchors, trips.stood_at])
        stood_s = np.concatenate([people.stood_s, trips.stood_s])
        stands = stood_s > 0.0
        discs = np.column_stack([anchors, bodies.radii + rooms_m])
        standing = Standing(discs[stands], stood_s[stands], bodies.radii[stands])
        self.detours.keep(self.table, standing, self.tick_s)

    def _wait_for_potentials(self) -> None:
        """Those whose way is still being found stand and wait; it is not that there is none.

        For those whose strict goal would have to be moved there is none.
        """
        agents, trips = self.table.agents, self.table.trips
        refused = trips.strict & (trips.moved_why > 0) & (agents.potential_rows < 0)
        agents.reasons[refused & (agents.reasons == Reason.WAITING)] = Reason.NO_PATH
        waiting = self.potentials.provisional(agents.potential_rows)
        waiting &= agents.reasons == Reason.NO_PATH
        agents.reasons[waiting] = Reason.WAITING

    def decided(self, actor_id: Hashable) -> Decided:
        """The path that an actor has taken in the latest tick, and the one before, priced.

        Between two ticks only, as `trace`.

        Raises
        ------
        NotKeptError
            `tracing` was not wanted in that tick, or actors have come or gone since.
        KeyError
            There is none of that id.
        """
        return self.tracing.decided(self.table.row(actor_id), self.table.version)

    def trace(self, actor_id: Hashable) -> Trace:
        """An actor's decision of the latest tick, made once more; as `decided`. Heavy."""
        return self.tracing.trace(self.table.row(actor_id), self.table.version, self._prediction)

    def tick(self) -> dict[Hashable, ActorState]:
        """`advance`, then the states of all actors; id -> state."""
        self.advance()
        return dict(zip(self.table.ids, self._states(slice(None)), strict=True))

    def state(self, actor_id: Hashable) -> ActorState:
        """One actor's state as of the latest tick, or as it was put there."""
        row = self.table.row(actor_id)
        return next(self._states(slice(row, row + 1)))

    def _states(self, rows: slice) -> Iterator[ActorState]:
        """The states of the actors in some rows; whole columns are turned into numbers at once."""
        agents, trips, table = self.table.agents, self.table.trips, self.table
        slice_s = self.plan.slice_s
        columns = (
            agents.positions[rows].tolist(),
            agents.layers[rows].tolist(),
            agents.heights[rows].tolist(),
            agents.velocities[rows].tolist(),
            agents.headings[rows].tolist(),
            agents.reasons[rows].tolist(),
            trips.wanted[rows].tolist(),
            agents.planned[rows].copy(),
            trips.outcomes[rows].tolist(),
        )
        for row, (place, layer, z_m, velocity, heading, reason, goal, way, outcome) in enumerate(
            zip(*columns, strict=True), start=rows.start or 0
        ):
            yield ActorState(
                tuple(place),
                layer,
                z_m,
                tuple(velocity),
                heading,
                _REASONS[reason],
                None if math.isnan(goal[0]) else tuple(goal),
                slice_s,
                way,
                None,
                Outcome(outcome) if outcome else None,
                self.in_the_way(row) if table.in_the_way else None,
            )

    def outcome(self, row: int) -> Outcome | None:
        """How the trip of the actor in a row ended; None while it goes on, and without a goal."""
        code = int(self.table.trips.outcomes[row])
        return Outcome(code) if code else None

    def in_the_way(self, row: int) -> InTheWay | None:
        """The person, actor, door or wall for which its trip did not end at the goal."""
        by = self.table.in_the_way.get(self.table.ids[row]) if self.table.in_the_way else None
        return None if by is None else InTheWay(cast(Kind, by[0]), by[1])

    def predicted_near(
        self, position: Point, z_m: float, within_m: float
    ) -> list[NDArray[np.float64]]:
        """One array for each person now in that distance: (K, 4) float64 x, y, z, deviation m."""
        p: Prediction = self._prediction
        away_m = np.hypot(p.means[:, 0, 0] - position[0], p.means[:, 0, 1] - position[1])
        near = (np.abs(p.heights[:, 0] - z_m) < SAME_FLOOR_M) & (away_m <= within_m)
        return [
            np.column_stack([p.means[k], p.heights[k], p.sigmas[k]])
            for k in np.flatnonzero(near).tolist()
        ]

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


@lru_cache(maxsize=4096)
def _priority(seed: int, who: Hashable) -> int:
    """A number that is the same in every run for the same seed and id (FNV-1a, 64 bits).

    It decides ranks, so that another hash would be another world.
    """
    state = 0xCBF29CE484222325 ^ (seed & 0xFFFFFFFFFFFFFFFF)
    for byte in str(who).encode():
        state = ((state ^ byte) * 0x100000001B3) & 0xFFFFFFFFFFFFFFFF
    return state ^ (state >> 29)

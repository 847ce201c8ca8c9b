"""The rows that actors use of what a zone derives: clearances, tables of risk, potentials."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.parameter_records import measures
from esplanade.actors.parameters import body_of
from esplanade.actors.potential_pool import Goal, GoalKey, PotentialPool, goal_key, kind_for_ways
from esplanade.planning import AgentTable, Body, LayeredGrid
from esplanade.planning.grid.clearances import kind_of
from esplanade.planning.people.risk import RiskField
from esplanade.planning.routes.moved_ends import moved_end


class DerivedRows:
    """Takes rows for actors and gives them back, so that each is counted once for each user."""

    def __init__(self, grid: LayeredGrid, field: RiskField, potentials: PotentialPool) -> None:
        self._grid = grid
        self._field = field
        self._potentials = potentials

    def claim(self, bodies: Sequence[Body]) -> list[int]:
        """Rows of the grid for some bodies.

        Raises
        ------
        ValueError
            Too many kinds of body would walk here; none is claimed then.
        """
        rows: list[int] = []
        try:
            for body in bodies:
                rows.append(self._grid.claim(body))  # noqa: PERF401 - some are claimed if it fails
        except ValueError:
            for body in bodies[: len(rows)]:
                self._grid.release(body)
            raise
        return rows

    def release(self, records: NDArray[np.void]) -> None:
        """Give back the rows of the grid that actors with these parameters (N,) had."""
        for record in records:
            self._grid.release(body_of(record))

    def contacts(self, records: NDArray[np.void]) -> list[int]:
        """Rows of the tables of risk for actors with these parameters (N,)."""
        return [self._field.contact_row(float(record["radius_m"])) for record in records]

    def give_back(self, table: AgentTable) -> None:
        """Give back all rows of all actors."""
        for slot in table.trips.own_rows.tolist():
            self._potentials.release(slot)
        self.release(table.agents.parameters)

    def take_all(self, table: AgentTable) -> None:
        """Take all rows of all actors, who have none."""
        agents = table.agents
        self.take_bodies(table)
        for row in range(len(table)):
            target = table.wanted(row)
            slot = -1 if target is None else self._potential(table, row, target)
            table.trips.own_rows[row] = agents.potential_rows[row] = slot

    def take_bodies(self, table: AgentTable) -> None:
        """Take the rows of all actors that go by their bodies, and none of potentials."""
        agents = table.agents
        agents.bodies[:] = self.claim([body_of(record) for record in agents.parameters])
        agents.contacts[:] = self.contacts(agents.parameters)

    def head_for(self, table: AgentTable, row: int, target: Goal | None) -> None:
        """Let an actor go by the potential of a goal, or by none."""
        self._go_by(table, row, -1 if target is None else self._potential(table, row, target))

    def change(
        self,
        table: AgentTable,
        rows: NDArray[np.int64],
        records: NDArray[np.void],
        prepared: Mapping[GoalKey, NDArray[np.float32]] | None = None,
    ) -> None:
        """Write other parameters (N,) of the actors in these rows (N,), and what follows from them.

        Raises
        ------
        ValueError
            Too many kinds of body would walk here; nothing is changed then.
        """
        agents = table.agents
        before = agents.parameters[rows]
        new = self.of_new_kind(before, records)
        bodies = [body_of(record) for record in records[new]]
        claims, contacts = self.claim(bodies), self.contacts(records[new])
        keys: list[GoalKey | None] = []
        slots: list[int] = []
        try:
            for row, body in zip(rows[new].tolist(), bodies, strict=True):
                target = table.wanted(row)
                key = None if target is None else goal_key(self._grid, target, body)
                if target is not None:
                    key = self._allowed(table, row, key, body, target)
                keys.append(key)
                slots.append(-1 if keys[-1] is None else self._potentials.take(keys[-1], prepared))
        except Exception:
            for slot in slots:
                self._potentials.release(slot)
            self.release(records[new])
            raise
        agents.parameters[rows] = records
        self.release(before[new])
        agents.bodies[rows[new]], agents.contacts[rows[new]] = claims, contacts
        for row, key, slot in zip(rows[new].tolist(), keys, slots, strict=True):
            if key is not None:
                agents.goals[row] = key[:2]
            self._go_by(table, row, slot)

    def of_new_kind(self, before: NDArray[np.void], after: NDArray[np.void]) -> NDArray[np.int64]:
        """Tell for each of N actors whether other parameters let it go other ways.

        They do if they make it another kind of body, or bound its cells on edges otherwise where
        that bound can forbid a way.
        """
        edges = before["edge_cells"] != after["edge_cells"]
        other = np.flatnonzero(edges | (measures(before) != measures(after)).any(axis=1))
        new = [
            k for k in other.tolist() if self._goes_otherwise(body_of(before[k]), body_of(after[k]))
        ]
        return np.array(new, dtype=np.int64)

    def _goes_otherwise(self, before: Body, after: Body) -> bool:
        """Whether a body that is another goes other ways.

        Bounds of cells on edges are asked for only where the kind is the same: for a kind that the
        grid does not know yet they take as long as a tick.
        """
        if kind_of(before) != kind_of(after):
            return True
        return kind_for_ways(self._grid, before) != kind_for_ways(self._grid, after)

    def _potential(self, table: AgentTable, row: int, target: Goal) -> int:
        """The potential of an actor's goal, -1 where none can be."""
        body = body_of(table.agents.parameters[row])
        key = self._allowed(table, row, goal_key(self._grid, target, body), body, target)
        return -1 if key is None else self._potentials.take(key)

    def _allowed(
        self, table: AgentTable, row: int, key: GoalKey | None, body: Body, target: Goal
    ) -> GoalKey | None:
        """Move an actor's goal to where it fits, and note how far and why.

        It is None where the goal may not be moved, as the actor is strict.
        """
        trips = table.trips
        moved = None
        if key is not None:
            table.agents.goals[row] = key[:2]
            moved = moved_end(self._grid, body, target, (key[0], key[1], target[2]))
        trips.moved_m[row] = 0.0 if moved is None else moved.distance_m
        trips.moved_why[row] = 0 if moved is None else moved.reason
        return None if trips.strict[row] and moved is not None else key

    def _go_by(self, table: AgentTable, row: int, slot: int) -> None:
        """Let an actor go by a potential that was taken for it, and begin anew."""
        agents, trips = table.agents, table.trips
        old = int(trips.own_rows[row])
        agents.known[row] = agents.known[row] and slot == agents.potential_rows[row]
        trips.own_rows[row] = agents.potential_rows[row] = slot
        trips.detours[row] = False
        agents.left_m[row] = np.nan
        agents.behind_s[row] = 0.0
        agents.passages[row] = 0.0
        self._potentials.release(old)

"""Ends the trips of actors: at the goal, beside it where it is taken, or where a way is blocked."""

from __future__ import annotations

import math
from collections.abc import Hashable
from typing import Final

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.bodies_near import Bodies, nearest_on_way
from esplanade.actors.outcomes import Outcome
from esplanade.actors.parameters import body_of
from esplanade.actors.potential_pool import PotentialPool
from esplanade.actors.state import Reason
from esplanade.planning import AgentTable, LayeredGrid
from esplanade.planning.scene.heights import SAME_FLOOR_M

NO_WAY_AFTER_S: Final = 3.0
"""A trip has no way once none has led to its goal for so long."""
NEARER_M: Final = 0.5
"""An actor that has come nearer by this much has got on."""
TAKES_S: Final = 0.5
"""A person who has stood at a goal for so long takes it."""
LOOK_M: Final = 3.0
"""An actor this near to its goal looks whether somebody is there; further away for a queue."""
QUEUE_M: Final = 0.8
"""It looks further by this for the square root of the actors with the same goal."""
OUTSIDE_M: Final = 1.0
"""It does not queue where its way is shut by somebody else, further than this from the queue."""
BESIDE_M: Final = 0.5
"""An actor waits beside a goal that is taken with this much between it and whoever is there."""
QUEUES_S: Final = 2.0
"""An actor that cannot get nearer to a goal that is taken waits where it is after so long."""
ACTOR_ROOM_M: Final = 0.02
OWNS_M: Final = 2.0
"""An actor that has arrived, and was moved aside by no more than this, still takes its goal."""
CAREFUL_S: Final = 2.0
"""An actor that has not got on for so long passes nearer to people who stand."""
SQUEEZED: Final = 0.2
"""The part of risk that counts for it then; the last check before a step is as ever."""
STANDING_M: Final = 3.0
BLOCKED_BY_M: Final = 4.0


class TripEnds:
    """Keeps account of all trips of a zone after each tick."""

    def __init__(self, grid: LayeredGrid, potentials: PotentialPool) -> None:
        self._grid = grid
        self._potentials = potentials

    def keep(
        self, table: AgentTable, bodies: Bodies, stood_s: NDArray[np.float64], tick_s: float
    ) -> None:
        """End trips, and let actors wait at goals that are taken.

        `stood_s` (P,) s tells for how long each of the people has stood. Cost O(actors), and
        O(bodies) for each actor near a goal that is taken or that does not get on.
        """
        agents, trips = table.agents, table.trips
        wants = ~np.isnan(trips.wanted[:, 0])
        no_path = wants & (agents.reasons == Reason.NO_PATH)
        trips.no_path_s[:] = np.where(no_path, trips.no_path_s + tick_s, 0.0)
        self._take_up(table, (trips.outcomes == Outcome.NO_WAY) & ~no_path)
        going = wants & (trips.outcomes == 0)
        if not going.any():
            return
        left_m = self._left_m(table)
        arrived = going & (agents.reasons == Reason.ARRIVED)
        evades = (agents.reasons == Reason.GIVING_WAY) | (agents.reasons == Reason.WAITING)
        arrived |= going & evades & (left_m <= agents.parameters["goal_tolerance_m"])
        trips.outcomes[arrived] = Outcome.ARRIVED
        agents.waits[arrived] = False
        lost = going & (trips.no_path_s >= NO_WAY_AFTER_S)
        for row in np.flatnonzero(lost).tolist():
            self._end(table, row, Outcome.NO_WAY, self._closed(row, table))
        going &= ~arrived & ~lost
        self._count(table, going, left_m, tick_s)
        taken = self._wait(table, bodies, stood_s, going, left_m, tick_s)
        over = going & (trips.stalled_s >= agents.parameters["patience_s"])
        for row in np.flatnonzero(over).tolist():
            if row in taken:
                self._end(table, row, Outcome.NEAR, bodies.who(taken[row]))
            else:
                self._end(table, row, Outcome.BLOCKED, self._held_by(table, bodies, row))
            agents.waits[row] = True
        self._squeeze(table, bodies, stood_s, going & ~over, taken)

    def _take_up(self, table: AgentTable, rows: NDArray[np.bool_]) -> None:
        """Let trips go on that had ended without a way: the ground is another one."""
        for row in np.flatnonzero(rows).tolist():
            table.trips.outcomes[row] = 0
            table.trips.stalled_s[row] = 0.0
            table.in_the_way.pop(table.ids[row], None)

    def _end(self, table: AgentTable, row: int, outcome: Outcome, by: tuple[str, Hashable]) -> None:
        table.trips.outcomes[row] = outcome
        table.in_the_way[table.ids[row]] = by

    def _left_m(self, table: AgentTable) -> NDArray[np.float64]:
        """Metres that are left of each trip, (A,), inf where none leads there or nobody knows."""
        agents = table.agents
        rows, cells = agents.potential_rows, agents.cells
        left_m = np.full(len(rows), np.inf)
        known = np.flatnonzero((rows >= 0) & (cells >= 0))
        if len(known):
            values = self._potentials.arrays[rows[known], cells[known]].astype(np.float64)
            x, y = agents.positions[known].T
            left_m[known] = values[:, 0] + np.hypot(values[:, 1] - x, values[:, 2] - y)
        return left_m

    def _count(
        self,
        table: AgentTable,
        going: NDArray[np.bool_],
        left_m: NDArray[np.float64],
        tick_s: float,
    ) -> None:
        trips = table.trips
        nearest_m = trips.nearest_m
        nearer = going & (np.isnan(nearest_m) | (left_m < nearest_m - NEARER_M))
        nearer &= np.isfinite(left_m)
        nearest_m[nearer] = left_m[nearer]
        trips.stalled_s[nearer] = 0.0
        trips.stalled_s[going & ~nearer] += tick_s

    def _wait(
        self,
        table: AgentTable,
        bodies: Bodies,
        stood_s: NDArray[np.float64],
        going: NDArray[np.bool_],
        left_m: NDArray[np.float64],
        tick_s: float,
    ) -> dict[int, int]:
        """Let actors wait near goals that are taken; returns who takes that of each, by its row."""
        agents, trips = table.agents, table.trips
        people = len(bodies.people)
        takers = np.zeros(len(bodies.radii), dtype=np.bool_)
        takers[:people] = stood_s >= TAKES_S
        takers[people:] = trips.outcomes == Outcome.ARRIVED
        taking = np.flatnonzero(takers)
        sharing = np.bincount(trips.own_rows[going & (trips.own_rows >= 0)])
        shared = trips.own_rows >= 0
        shared &= trips.own_rows < len(sharing)
        queue_m = np.zeros(len(left_m))
        queue_m[shared] = QUEUE_M * np.sqrt(sharing[trips.own_rows[shared]])
        outside_m = OUTSIDE_M + agents.parameters["radius_m"] + queue_m
        kept_out = trips.shut & (np.hypot(*(agents.positions - agents.goals).T) > outside_m)
        near = going & (left_m <= LOOK_M + queue_m) & ~kept_out
        agents.waits[going & ~near] = False
        trips.queued_s[~near] = 0.0
        taken: dict[int, int] = {}
        if not len(taking):
            self._let_in(table, np.flatnonzero(near & agents.waits).tolist(), near)
            return taken
        free: list[int] = []
        rows = np.flatnonzero(near)
        perhaps = self._anybody_at(table, bodies, taking, rows)
        for row, somebody in zip(rows.tolist(), perhaps.tolist(), strict=True):
            by = self._taken_by(table, bodies, taking, row, people) if somebody else None
            if by is None:
                if agents.waits[row]:
                    free.append(row)
                continue
            taken[row] = by
            speed = float(np.hypot(*agents.velocities[row]))
            stops_m = speed * speed / (2.0 * float(agents.parameters["max_acceleration_mps2"][row]))
            away_m = math.dist(agents.positions[row], agents.goals[row])
            ring_m = bodies.radii[people + row] + bodies.radii[by] + BESIDE_M
            if away_m <= ring_m + stops_m or trips.stalled_s[row] >= QUEUES_S:
                agents.waits[row] = True
            if agents.waits[row]:
                trips.queued_s[row] += tick_s
        self._let_in(table, free, near)
        return taken

    def _let_in(self, table: AgentTable, free: list[int], near: NDArray[np.bool_]) -> None:
        """Of those who wait for a goal that is free now the first in the queue goes there."""
        agents, trips = table.agents, table.trips
        first: dict[int, int] = {}
        for row in free:
            goal, other = int(trips.own_rows[row]), first.get(int(trips.own_rows[row]))
            if other is None or (-trips.queued_s[row], agents.ranks[row]) < (
                -trips.queued_s[other],
                agents.ranks[other],
            ):
                first[goal] = row
        for goal, row in first.items():
            if not (near & ~agents.waits & (trips.own_rows == goal)).any():
                agents.waits[row] = False
                trips.queued_s[row] = trips.stalled_s[row] = 0.0

    def _anybody_at(
        self,
        table: AgentTable,
        bodies: Bodies,
        taking: NDArray[np.int64],
        rows: NDArray[np.int64],
    ) -> NDArray[np.bool_]:
        """Whether anybody is near enough to the goals of some actors (N,) to take a place there."""
        agents = table.agents
        p = agents.parameters[rows]
        room_m = np.maximum(p["person_room_m"], ACTOR_ROOM_M) + p["goal_tolerance_m"]
        reach_m = np.maximum(OWNS_M, bodies.radii[taking].max() + p["radius_m"] + room_m)
        offsets = bodies.places[None, taking, :2] - agents.goals[rows, None]
        near = offsets[:, :, 0] ** 2 + offsets[:, :, 1] ** 2 <= reach_m[:, None] ** 2
        found: NDArray[np.bool_] = near.any(axis=1)
        return found

    def _taken_by(
        self,
        table: AgentTable,
        bodies: Bodies,
        taking: NDArray[np.int64],
        row: int,
        people: int,
    ) -> int | None:
        """Find the body nearest to a goal that takes an actor's place there, if there is one."""
        agents, own_rows = table.agents, table.trips.own_rows
        p = agents.parameters[row]
        goal, tolerance_m = agents.goals[row], float(p["goal_tolerance_m"])
        need_m = bodies.radii[taking] + float(p["radius_m"])
        need_m = need_m + np.where(taking < people, float(p["person_room_m"]), ACTOR_ROOM_M)
        offsets = bodies.places[taking, :2] - goal
        away_m = np.hypot(offsets[:, 0], offsets[:, 1])
        # One that has been moved aside comes back.
        owns = (taking >= people) & (own_rows[np.maximum(taking - people, 0)] == own_rows[row])
        owns &= (away_m < OWNS_M) & (own_rows[row] >= 0)
        if owns.any():
            return int(taking[np.where(owns, away_m, np.inf).argmin()])
        close = away_m < need_m + tolerance_m
        close &= np.abs(bodies.places[taking, 2] - table.trips.wanted[row, 2]) < SAME_FLOOR_M
        if not close.any():
            return None
        spots = _SPOTS * tolerance_m
        apart = np.hypot(*(spots[:, None] - offsets[None, close]).transpose(2, 0, 1))
        free = (apart >= need_m[close]).all(axis=1)
        if free.any():
            body = body_of(p)
            places = goal + spots[free]
            heights = np.full(len(places), table.trips.wanted[row, 2])
            if (self._grid.clearance(places, heights, body) >= body.radius_m - 0.02).any():
                return None
        near = np.flatnonzero(close)
        return int(taking[near[away_m[near].argmin()]])

    def _squeeze(
        self,
        table: AgentTable,
        bodies: Bodies,
        stood_s: NDArray[np.float64],
        going: NDArray[np.bool_],
        taken: dict[int, int],
    ) -> None:
        """Let actors that do not get on pass nearer to people who stand about."""
        agents, trips = table.agents, table.trips
        slow = (trips.stalled_s >= CAREFUL_S) | (agents.cautions < 1.0)
        slow &= going & ~agents.waits & ~trips.shut
        agents.cautions[~slow] = 1.0
        if not slow.any():
            return
        standing = bodies.places[: len(bodies.people)][stood_s >= CAREFUL_S]
        for row in np.flatnonzero(slow).tolist():
            away = np.hypot(*(standing[:, :2] - agents.positions[row]).T)
            level = np.abs(standing[:, 2] - agents.heights[row]) < SAME_FLOOR_M
            near = row not in taken and (level & (away < STANDING_M)).any()
            agents.cautions[row] = SQUEEZED if near else 1.0

    def _held_by(self, table: AgentTable, bodies: Bodies, row: int) -> tuple[str, Hashable]:
        """Find the body in the way of an actor: on its way first, and then anywhere near."""
        agents = table.agents
        slot, cell = int(agents.potential_rows[row]), int(agents.cells[row])
        own, ahead = len(bodies.people) + row, None
        if slot >= 0 and cell >= 0:
            waypoint = self._potentials.arrays[slot, cell, 1:3].astype(np.float64)
            ahead = waypoint - agents.positions[row] if np.isfinite(waypoint).all() else None
        found = nearest_on_way(bodies, own, ahead, BLOCKED_BY_M)
        found = found or nearest_on_way(bodies, own, None, BLOCKED_BY_M)
        return ("wall", None) if found is None else bodies.who(found[0])

    def _closed(self, row: int, table: AgentTable) -> tuple[str, Hashable]:
        """The nearest door that is closed, or else walls."""
        x, y = table.agents.positions[row].tolist()
        doors, barriers = self._grid.doors, self._grid.barriers
        found = []
        for name in doors:
            if not doors.is_open(name):
                x0, y0, x1, y1 = barriers[doors.rows[name]].tolist()[:4]
                found.append((math.dist((x, y), ((x0 + x1) / 2.0, (y0 + y1) / 2.0)), name))
        return ("door", min(found)[1]) if found else ("wall", None)


def _spots() -> NDArray[np.float64]:
    angles = np.arange(12) * (np.pi / 6.0)
    ring = np.column_stack([np.cos(angles), np.sin(angles)])
    return np.concatenate([np.zeros((1, 2)), 0.5 * ring, 0.9 * ring])


_SPOTS: Final = _spots()
"""Places around a goal where an actor has arrived, in parts of its tolerance."""

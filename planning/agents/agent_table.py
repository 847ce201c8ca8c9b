"""The one table of a zone's agents, with a row for each of them."""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.agents._passage_kernels import PASSAGE
from esplanade.planning.agents.agents import PARAMETERS, WAITING, Agents

VERSION: Final = 4
"""Version of the data that `AgentTable.save` gives; `load` takes no other."""
FORMAT: Final = "esplanade.agents"


class SavedAgentsError(ValueError):
    """Saved agents that cannot be loaded; the message names the column or field at fault."""


class Trips(NamedTuple):
    """The part of A agents' state that kernels do not need: where each wants to be, its progress.

    `wanted` (A, 3) m is the goal as it was asked for, nan without one; `no_path_s` (A,) s for how
    long no path has led there; `points_at` (A, 3) m the place that the agent shows to people, nan
    for none. Its behaviour is asked again at `ask_at_s` (A,) s, and when its outcome is no longer
    what it was when last asked, `outcome_when_asked` (A,). For `reason_s` (A,) s its reason has
    been what it is now.
    The goal was moved by `moved_m` (A,) m to where the body fits, for the reason `moved_why` (A,),
    a `MoveReason`, if by more than 0.25 m; both are 0 otherwise. An agent that is `strict` (A,)
    does not go to a goal that would have to be moved so.
    The trip has the outcome `outcomes` (A,), 0 while it goes on. The agent has come as near as
    `nearest_m` (A,) m, nan at first; for `stalled_s` (A,) s it has not come nearer by half a metre,
    and for `queued_s` (A,) s it has waited for a place that is taken.
    `own_rows` (A,) are the rows of the goals' own potentials, -1 without a goal; an agent that goes
    around people who stand, `detours` (A,), has another in `potential_rows`. It looks for such
    people again in `look_in_s` (A,) s; they have `shut` (A,) the way to its goal. An agent that is
    not on its way has stood at `stood_at` (A, 3) m for `stood_s` (A,) s.
    """

    wanted: NDArray[np.float64]
    no_path_s: NDArray[np.float64]
    points_at: NDArray[np.float64]
    ask_at_s: NDArray[np.float64]
    outcome_when_asked: NDArray[np.int64]
    reason_s: NDArray[np.float64]
    moved_m: NDArray[np.float64]
    moved_why: NDArray[np.int64]
    strict: NDArray[np.bool_]
    outcomes: NDArray[np.int64]
    nearest_m: NDArray[np.float64]
    stalled_s: NDArray[np.float64]
    queued_s: NDArray[np.float64]
    own_rows: NDArray[np.int64]
    detours: NDArray[np.bool_]
    look_in_s: NDArray[np.float64]
    shut: NDArray[np.bool_]
    stood_at: NDArray[np.float64]
    stood_s: NDArray[np.float64]


_DERIVED: Final = ("bodies", "contacts", "potential_rows", "own_rows", "ranks")
"""Columns that point into what a zone derives of its own; they are derived anew after loading."""
_SAVED: Final = tuple(
    (name, k) for k, name in enumerate((*Agents._fields, *Trips._fields)) if name not in _DERIVED
)
"""The others, and where they stand in an `Agents` with a `Trips` behind it."""


class AgentTable:
    """Every agent of a zone by its id, the one identity that an agent has.

    `agents` and `trips` hold the columns; both are other objects after agents have come or gone
    and `version` has grown then. In between the arrays are written in place. A row number holds
    until an agent is removed. Adding and removing cost O(agents).
    """

    def __init__(self, slices: int) -> None:
        """A table without agents, whose plans have `slices` slices after now."""
        self.agents = _no_agents(slices + 1)
        self.trips = _no_trips()
        self.version = 0
        self.in_the_way: dict[Hashable, tuple[str, Hashable]] = {}
        """By agents whose trips did not end at the goal: the kind and id of what was in the way."""
        self._rows: dict[Hashable, int] = {}

    def __len__(self) -> int:
        return len(self._rows)

    def __contains__(self, agent_id: object) -> bool:
        return agent_id in self._rows

    def __iter__(self) -> Iterator[Hashable]:
        return iter(self._rows)

    @property
    def ids(self) -> list[Hashable]:
        """The ids of all agents in the order of their rows."""
        return list(self._rows)

    def row(self, agent_id: Hashable) -> int:
        """The row of an agent; KeyError when there is none of that id."""
        try:
            return self._rows[agent_id]
        except KeyError:
            raise KeyError(f"there is no actor {agent_id!r}") from None

    def add(
        self,
        ids: Sequence[Hashable],
        places: NDArray[np.float64],
        parameters: NDArray[np.void],
        *,
        cells: NDArray[np.int64],
        layers: NDArray[np.int64],
        headings: NDArray[np.float64],
    ) -> None:
        """Add N agents that stand at places (N, 3) without a goal, in the next N rows.

        Raises
        ------
        ValueError
            An id is taken, or occurs twice. Nothing is changed then.
        """
        rows = dict(self._rows)
        for agent_id in ids:
            if agent_id in rows:
                raise ValueError(f"there already is an actor {agent_id!r}")
            rows[agent_id] = len(rows)
        known = {
            "positions": places[:, :2],
            "cells": cells,
            "goals": places[:, :2],
            "potential_rows": -1,
            "parameters": parameters,
            "left_m": np.nan,
            "headings": headings,
            "heights": places[:, 2],
            "layers": layers,
            "reasons": WAITING,
            "planned": places[:, None],
            "cautions": 1.0,
        }
        self.agents = Agents._make(_with_rows(self.agents, len(ids), known))
        blank = {
            "wanted": np.nan,
            "points_at": np.nan,
            "ask_at_s": -np.inf,
            "nearest_m": np.nan,
            "own_rows": -1,
            "stood_at": places,
        }
        self.trips = Trips._make(_with_rows(self.trips, len(ids), blank))
        self._rows = rows
        self.version += 1

    def remove(self, ids: Sequence[Hashable]) -> None:
        """Remove agents; KeyError when one of them is not there, and nothing is changed then."""
        rows = [self.row(agent_id) for agent_id in ids]
        self.agents = Agents._make(np.delete(column, rows, axis=0) for column in self.agents)
        self.trips = Trips._make(np.delete(column, rows, axis=0) for column in self.trips)
        gone = set(ids)
        self.in_the_way = {who: by for who, by in self.in_the_way.items() if who not in gone}
        others = (each for each in self._rows if each not in gone)
        self._rows = {each: k for k, each in enumerate(others)}
        self.version += 1

    def undo_point(self) -> Callable[[], None]:
        """Return a call that puts the table back, its arrays in place; O(agents)."""
        agents, trips, rows, version = self.agents, self.trips, self._rows, self.version
        in_the_way = dict(self.in_the_way)
        columns = (*agents, *trips)
        copies = [column.copy() for column in columns]

        def undo() -> None:
            for column, kept in zip(columns, copies, strict=True):
                column[...] = kept
            self.agents, self.trips, self._rows, self.version = agents, trips, rows, version
            self.in_the_way = in_the_way

        return undo

    def wanted(self, row: int) -> tuple[float, float, float] | None:
        """The goal that an agent was given, x, y and height in metres; None without one."""
        return _place_or_none(self.trips.wanted[row])

    def points_at(self, row: int) -> tuple[float, float, float] | None:
        """The place that an agent shows to people, x, y, z in metres; None for none."""
        return _place_or_none(self.trips.points_at[row])

    def save(self) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
        """Everything that the next tick of these agents depends on, as plain data and arrays.

        All of it is copied. The columns that a zone derives of its own are left out.

        Raises
        ------
        TypeError
            An id is neither text nor a whole number, so that JSON would not give it back.
        """
        for agent_id in self._rows:
            if isinstance(agent_id, bool) or not isinstance(agent_id, str | int):
                raise TypeError(f"only text and whole numbers can be saved as ids: {agent_id!r}")
        columns = (*self.agents, *self.trips)
        arrays = {name: columns[k].copy() for name, k in _SAVED}
        slices = self.agents.planned.shape[1] - 1
        header = {
            "format": FORMAT,
            "version": VERSION,
            "slices": slices,
            "ids": list(self._rows),
            "in_the_way": [[who, *by] for who, by in self.in_the_way.items()],
        }
        return header, arrays

    @classmethod
    def load(cls, header: Mapping[str, Any], arrays: Mapping[str, NDArray[Any]]) -> AgentTable:
        """The table that `save` gave; the derived columns are left blank.

        Raises
        ------
        SavedAgentsError
            The version is another, or a column is missing, unknown or of another shape or type.
        """
        slices, ids = _checked(header)
        table = cls(slices)
        blank = {**table.agents._asdict(), **table.trips._asdict()}
        unknown = sorted(arrays.keys() - blank.keys())
        if unknown:
            raise SavedAgentsError(f"saved agents have a column {unknown[0]!r} that is not known")
        filled = {}
        for name, column in blank.items():
            shape = (len(ids), *column.shape[1:])
            if name in _DERIVED:
                filled[name] = np.full(shape, -1 if name.endswith("_rows") else 0, column.dtype)
                continue
            if name not in arrays:
                raise SavedAgentsError(f"saved agents lack the column {name!r}")
            given = np.asarray(arrays[name])
            if given.shape != shape or given.dtype != column.dtype:
                raise SavedAgentsError(
                    f"column {name!r} of saved agents must be {column.dtype} {shape}, "
                    f"got {given.dtype} {given.shape}"
                )
            filled[name] = np.array(given)
        table.agents = Agents(**{name: filled[name] for name in Agents._fields})
        table.trips = Trips(**{name: filled[name] for name in Trips._fields})
        table._rows = {agent_id: row for row, agent_id in enumerate(ids)}
        table.version = 1
        table.in_the_way = _in_the_way(header, table)
        return table


def _checked(header: Mapping[str, Any]) -> tuple[int, Sequence[Hashable]]:
    if header.get("format") != FORMAT:
        raise SavedAgentsError(f"these are no saved agents: format is {header.get('format')!r}")
    if header.get("version") != VERSION:
        raise SavedAgentsError(
            f"saved agents are of version {header.get('version')!r}, this program reads {VERSION}"
        )
    slices, ids = header.get("slices"), header.get("ids")
    if not isinstance(slices, int) or slices < 1:
        raise SavedAgentsError(f"slices of saved agents must be a number above 0, got {slices!r}")
    if not isinstance(ids, list) or not all(isinstance(each, str | int) for each in ids):
        raise SavedAgentsError("ids of saved agents must be a list of text and whole numbers")
    if len(set(ids)) < len(ids):
        raise SavedAgentsError("ids of saved agents occur twice")
    return slices, ids


def _in_the_way(
    header: Mapping[str, Any], table: AgentTable
) -> dict[Hashable, tuple[str, Hashable]]:
    found: dict[Hashable, tuple[str, Hashable]] = {}
    for entry in header.get("in_the_way", ()):
        if not isinstance(entry, list | tuple) or len(entry) != 3 or entry[0] not in table:
            raise SavedAgentsError(f"what is in the way of a saved agent is none: {entry!r}")
        found[entry[0]] = str(entry[1]), entry[2]
    return found


def _place_or_none(place: NDArray[np.float64]) -> tuple[float, float, float] | None:
    x, y, z = place.tolist()
    return None if math.isnan(x) else (x, y, z)


def _with_rows(
    columns: Agents | Trips, count: int, values: Mapping[str, Any]
) -> list[NDArray[Any]]:
    """The columns with so many more rows, zero where no value is given."""
    grown: list[NDArray[Any]] = []
    for name, column in columns._asdict().items():
        rows: NDArray[Any] = np.zeros((count, *column.shape[1:]), dtype=column.dtype)
        if name in values:
            rows[...] = values[name]
        grown.append(np.concatenate([column, rows]))
    return grown


def _no_agents(instants: int) -> Agents:
    return Agents(
        positions=np.zeros((0, 2)),
        velocities=np.zeros((0, 2)),
        cells=np.zeros(0, dtype=np.int64),
        bodies=np.zeros(0, dtype=np.int64),
        contacts=np.zeros(0, dtype=np.int64),
        goals=np.zeros((0, 2)),
        potential_rows=np.zeros(0, dtype=np.int64),
        parameters=np.zeros(0, dtype=PARAMETERS),
        ranks=np.zeros(0, dtype=np.int64),
        known=np.zeros(0, dtype=np.bool_),
        ages=np.zeros(0, dtype=np.int64),
        followed=np.zeros((0, instants, 2)),
        left_m=np.zeros(0),
        behind_s=np.zeros(0),
        passages=np.zeros(0, dtype=PASSAGE),
        headings=np.zeros(0),
        heights=np.zeros(0),
        layers=np.zeros(0, dtype=np.int64),
        on_edges=np.zeros(0),
        reasons=np.zeros(0, dtype=np.int64),
        planned=np.zeros((0, instants, 3)),
        waits=np.zeros(0, dtype=np.bool_),
        cautions=np.zeros(0),
    )


def _no_trips() -> Trips:
    return Trips(
        wanted=np.zeros((0, 3)),
        no_path_s=np.zeros(0),
        points_at=np.zeros((0, 3)),
        ask_at_s=np.zeros(0),
        outcome_when_asked=np.zeros(0, dtype=np.int64),
        reason_s=np.zeros(0),
        moved_m=np.zeros(0),
        moved_why=np.zeros(0, dtype=np.int64),
        strict=np.zeros(0, dtype=np.bool_),
        outcomes=np.zeros(0, dtype=np.int64),
        nearest_m=np.zeros(0),
        stalled_s=np.zeros(0),
        queued_s=np.zeros(0),
        own_rows=np.zeros(0, dtype=np.int64),
        detours=np.zeros(0, dtype=np.bool_),
        look_in_s=np.zeros(0),
        shut=np.zeros(0, dtype=np.bool_),
        stood_at=np.zeros((0, 3)),
        stood_s=np.zeros(0),
    )

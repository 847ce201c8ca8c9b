"""The one table of a zone's agents, with a row for each of them."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.agents._passage_kernels import PASSAGE
from esplanade.planning.agents.agents import PARAMETERS, WAITING, Agents

VERSION: Final = 3
"""Version of the data that `AgentTable.save` gives; `load` takes no other."""
FORMAT: Final = "esplanade.agents"


class SavedAgentsError(ValueError):
    """Saved agents that cannot be loaded; the message names the column or field at fault."""


class Trips(NamedTuple):
    """The part of A agents' state that kernels do not need: where each wants to be, its progress.

    `wanted` (A, 3) m is the goal as it was asked for, nan without one; `arrived` (A,) whether it
    has been reached; `no_path_s` (A,) s for how long no path has led there; `points_at` (A, 3) m
    the place that the agent shows to people, nan for none. Its behaviour is asked again at
    `ask_at_s` (A,) s, and when `arrived` is no longer what it was when last asked,
    `arrived_when_asked` (A,). For `reason_s` (A,) s its reason has been what it is now.
    The goal was moved by `moved_m` (A,) m to where the body fits, for the reason `moved_why` (A,),
    a `MoveReason`, if by more than 0.25 m; both are 0 otherwise. An agent that is `strict` (A,)
    does not go to a goal that would have to be moved so.
    """

    wanted: NDArray[np.float64]
    arrived: NDArray[np.bool_]
    no_path_s: NDArray[np.float64]
    points_at: NDArray[np.float64]
    ask_at_s: NDArray[np.float64]
    arrived_when_asked: NDArray[np.bool_]
    reason_s: NDArray[np.float64]
    moved_m: NDArray[np.float64]
    moved_why: NDArray[np.int64]
    strict: NDArray[np.bool_]


_DERIVED: Final = ("bodies", "contacts", "potential_rows", "ranks")
"""Columns that point into what a zone derives of its own; they are derived anew after loading."""


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
        }
        self.agents = Agents._make(_with_rows(self.agents, len(ids), known))
        blank = {"wanted": np.nan, "points_at": np.nan, "ask_at_s": -np.inf}
        self.trips = Trips._make(_with_rows(self.trips, len(ids), blank))
        self._rows = rows
        self.version += 1

    def remove(self, ids: Sequence[Hashable]) -> None:
        """Remove agents; KeyError when one of them is not there, and nothing is changed then."""
        rows = [self.row(agent_id) for agent_id in ids]
        self.agents = Agents._make(np.delete(column, rows, axis=0) for column in self.agents)
        self.trips = Trips._make(np.delete(column, rows, axis=0) for column in self.trips)
        gone = set(ids)
        others = (each for each in self._rows if each not in gone)
        self._rows = {each: k for k, each in enumerate(others)}
        self.version += 1

    def undo_point(self) -> Callable[[], None]:
        """Return a call that puts the table back, its arrays in place; O(agents)."""
        agents, trips, rows, version = self.agents, self.trips, self._rows, self.version
        columns = (*agents, *trips)
        copies = [column.copy() for column in columns]

        def undo() -> None:
            for column, kept in zip(columns, copies, strict=True):
                column[...] = kept
            self.agents, self.trips, self._rows, self.version = agents, trips, rows, version

        return undo

    def wanted(self, row: int) -> tuple[float, float, float] | None:
        """The goal that an agent was given, x, y and height in metres; None without one."""
        return _place_or_none(self.trips.wanted[row])

    def points_at(self, row: int) -> tuple[float, float, float] | None:
        """The place that an agent shows to people, x, y, z in metres; None for none."""
        return _place_or_none(self.trips.points_at[row])

    def save(self) -> tuple[dict[str, Any], dict[str, NDArray[Any]]]:
        """Everything that the next tick of these agents depends on, as JSON and arrays.

        The arrays are copies. The columns that a zone derives of its own are left out.

        Raises
        ------
        TypeError
            An id is neither text nor a whole number, so that JSON would not give it back.
        """
        for agent_id in self._rows:
            if isinstance(agent_id, bool) or not isinstance(agent_id, str | int):
                raise TypeError(f"only text and whole numbers can be saved as ids: {agent_id!r}")
        arrays = {
            name: column.copy()
            for columns in (self.agents, self.trips)
            for name, column in columns._asdict().items()
            if name not in _DERIVED
        }
        slices = self.agents.planned.shape[1] - 1
        header = {"format": FORMAT, "version": VERSION, "slices": slices, "ids": self.ids}
        return json.loads(json.dumps(header)), arrays

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
                filled[name] = np.full(shape, -1 if name == "potential_rows" else 0, column.dtype)
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
    )


def _no_trips() -> Trips:
    return Trips(
        wanted=np.zeros((0, 3)),
        arrived=np.zeros(0, dtype=np.bool_),
        no_path_s=np.zeros(0),
        points_at=np.zeros((0, 3)),
        ask_at_s=np.zeros(0),
        arrived_when_asked=np.zeros(0, dtype=np.bool_),
        reason_s=np.zeros(0),
        moved_m=np.zeros(0),
        moved_why=np.zeros(0, dtype=np.int64),
        strict=np.zeros(0, dtype=np.bool_),
    )

"""Decides once more as actors have decided in the last tick, and tells what it was made of."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from esplanade.actors.traces import (
    COST_PARTS,
    Decided,
    Floats,
    PricedPath,
    RiskSlices,
    SearchTree,
    Trace,
    Winner,
)
from esplanade.planning import Agents, Batch, Decisions, PlanModel, Prediction, SearchStatus
from esplanade.planning.agents import _trace_kernels as kernels
from esplanade.planning.agents._search_kernels import Workspace
from esplanade.planning.agents._task_kernels import SUB
from esplanade.planning.agents._tick_kernels import Zone, decide_some
from esplanade.planning.agents.search import make_workspace
from esplanade.planning.compiled.handle import Handle, make_handle

MOST_NODES: Final = 4096
"""Of a tree with more nodes those left open, the dearest first, are left out."""
FIELD_CELLS: Final = 32
FIELD_CELL_M: Final = 0.25
_OUT_OF_REACH_S: Final = 1e9
_NOT_KEPT: Final = frozenset({"followed", "planned", "headings", "heights", "layers", "reasons"})
"""Columns that no decision reads."""


class NotKeptError(LookupError):
    """Nothing is known of the last decision of this actor: it was not kept, or there was none."""


class Tracing:
    """Keeps what a tick decides upon, if that is wanted, for questions between two ticks."""

    def __init__(self, batch: Batch, plan: PlanModel, tick_s: float) -> None:
        self.wanted = False
        self._batch = batch
        self._plan = plan
        self._tick_s = tick_s
        self._kept: Agents | None = None
        """The agents as they were before the tick."""
        self._version = 0
        self._zone: Zone | None = None
        """The zone that `_held` was made of."""
        self._held: Handle[Zone]
        self._again: Decisions
        self._searched_in: Workspace | None = None
        self._memory: Handle[Workspace]

    def keep(self, agents: Agents, version: int) -> None:
        """Keep the agents of a table of this version, before a tick; O(agents)."""
        kept = self._kept
        if kept is None or len(kept.cells) != len(agents.cells):
            kept = Agents._make(np.empty_like(column) for column in agents)
            self._kept, self._zone = kept, None
        for name, to, column in zip(Agents._fields, kept, agents, strict=True):
            if name not in _NOT_KEPT:
                to[...] = column
        self._version = version

    @property
    def has_kept(self) -> bool:
        """Whether there is something to tell of the last tick."""
        return self._kept is not None

    def forget(self) -> None:
        """Forget what was kept."""
        self._kept = self._zone = None

    def decided(self, row: int, version: int) -> Decided:
        """The path taken by the actor in a row, and the one before.

        Raises
        ------
        NotKeptError
            What the last tick decided upon was not kept, or the table has other rows now.
        """
        zone, kept = self._renewed(version)
        paths = [zone.decisions.paths[row]]
        if kept.known[row]:
            paths.append(zone.world.reservations.paths[row])
        taken, *before = self._priced(row, paths)
        return Decided(taken, before[0] if before else None)

    def trace(self, row: int, version: int, prediction: Prediction) -> Trace:
        """Decide once more for the actor in a row; as `decided`, with all that it was made of.

        `prediction` is that of the tick.
        """
        zone, kept = self._renewed(version)
        budget = int(kept.parameters["max_expansions"][row])
        memory = self._memory_for(budget)
        again = self._decide(zone, kept, row, prediction)
        exact = all(
            np.array_equal(ours[row], theirs[row])
            for name, ours, theirs in zip(Decisions._fields, again, zone.decisions, strict=True)
            if name != "reasons"  # the step that follows a decision may change it
        )
        replanned = bool(again.replanned[row])
        tree = self._tree(memory, int(again.expansions[row]), budget)
        if not replanned:  # the path that it follows was found in an earlier tick
            tree = replace(tree, status=SearchStatus.FOUND)
        paths = {"taken": again.paths[row].copy()}
        if memory.ends[2] > 0:
            paths["searched"] = self._path(memory)
        if kept.known[row]:
            paths["previous"] = zone.world.reservations.paths[row]
        found = dict(zip(paths, self._priced(row, list(paths.values())), strict=True))
        previous, perturbed, changed = found.get("previous"), None, False
        if replanned and previous is not None and previous.legal:
            bent, changed = self._perturbed(zone, kept, row, prediction)
            (perturbed,) = self._priced(row, [bent])
        return Trace(
            exact,
            Decided(found["taken"], previous),
            found.get("searched"),
            perturbed,
            _winner(found["taken"], previous, perturbed, changed) if replanned else "not_due",
            float(kept.parameters["hysteresis_s"][row]),
            tree,
            self._risk(kept, row, prediction),
        )

    def _renewed(self, version: int) -> tuple[Zone, Agents]:
        """The zone of the last tick, and its agents as they were before; `_held` are both."""
        if self._kept is None or version != self._version:
            raise NotKeptError("what the last tick decided upon was not kept")
        zone = self._batch.zone
        if self._zone is not zone:
            self._again = Decisions._make(np.zeros_like(each) for each in zone.decisions)
            changed = zone._replace(agents=self._kept, decisions=self._again)
            self._zone, self._held = zone, make_handle(changed)
        return zone, self._kept

    def _memory_for(self, budget: int) -> Workspace:
        """Memory of a search, in which no node counts as expanded; `_memory` is its handle."""
        nodes = budget * self._batch.branching + 2
        if self._searched_in is None or len(self._searched_in.node_order) < nodes:
            self._searched_in = make_workspace(budget, self._batch.branching)
            self._memory = make_handle(self._searched_in)
        self._searched_in.node_order[:] = -1
        self._searched_in.ends[:] = 0
        return self._searched_in

    def _decide(self, zone: Zone, kept: Agents, row: int, prediction: Prediction) -> Decisions:
        """Call what a tick calls, for one actor; `_searched_in` are the nodes of its search."""
        before = kept.left_m[row], kept.behind_s[row], kept.passages[row].copy()
        first = int(np.flatnonzero(zone.world.reservations.members[0] == row)[0])
        decide_some(self._held, prediction, self._tick_s, first, first + 1, self._memory)
        kept.left_m[row], kept.behind_s[row], kept.passages[row] = before
        return self._again

    def _perturbed(
        self, zone: Zone, kept: Agents, row: int, prediction: Prediction
    ) -> tuple[Floats, bool]:
        """The path before, perturbed if that pays, and whether it is another then.

        No search finds a path that is better by such a margin: the path before is kept.
        """
        margins = kept.parameters["hysteresis_s"]
        before = float(margins[row])
        margins[row] = _OUT_OF_REACH_S
        try:
            again = self._decide(zone, kept, row, prediction)
        finally:
            margins[row] = before
        return again.paths[row].copy(), bool(again.renewed[row])

    def _priced(self, row: int, paths: list[Floats]) -> list[PricedPath]:
        places = np.zeros((len(paths), len(paths[0]), 3))
        places[:, :, :2] = paths
        prices = np.zeros((len(paths), kernels.COLUMNS))
        kernels.price_paths(self._held, row, self._tick_s, places, prices)
        return [
            PricedPath(
                places[n],
                prices[n, : len(COST_PARTS)],
                float(prices[n, kernels.MEAN_RISK]),
                bool(prices[n, kernels.LEGAL]),
            )
            for n in range(len(paths))
        ]

    def _path(self, memory: Workspace) -> Floats:
        """The path of a search, float64 (K, 2), as the search writes it."""
        path = np.zeros((self._plan.slices + 1, 2))
        n = int(memory.ends[2])
        path[:] = memory.node_state["x"][n], memory.node_state["y"][n]
        while n > 0:
            k = int(memory.node_step[n]) * SUB
            node = memory.node_state[n]
            path[k] = node["x"], node["y"]
            path[k - 1] = node["half_x"], node["half_y"]
            n = int(memory.node_parent[n])
        path[0] = memory.node_state["x"][0], memory.node_state["y"][0]
        return path

    def _tree(self, memory: Workspace, expansions: int, budget: int) -> SearchTree:
        made, left, last = memory.ends.tolist()
        order = memory.node_order[:made]
        expanded = np.flatnonzero(order >= 0)
        expanded = expanded[np.argsort(order[expanded])]
        # Entries of one key leave a queue in the order in which they were made.
        keys, items = memory.heap_keys[:left], memory.heap_items[:left]
        waiting = items[np.lexsort((items, keys))]
        end = [last] if made and order[last] < 0 else []
        listed = np.concatenate([expanded, end, waiting]).astype(np.int64)
        chosen = np.array(_parents_first(memory, listed.tolist()), dtype=np.int64)
        left_out = max(0, len(chosen) - MOST_NODES)
        chosen = chosen[:MOST_NODES]
        rows = np.full(made + 1, -1)
        rows[chosen] = np.arange(len(chosen))
        layered = self._batch.grid.layered
        nodes = np.empty((len(chosen), 7))
        state = memory.node_state[chosen]
        cells = memory.node_cell[chosen]
        nodes[:, 0], nodes[:, 1], nodes[:, 5] = state["x"], state["y"], state["cost_s"]
        nodes[:, 2] = np.where(cells >= 0, layered.floors[cells], 0.0)
        nodes[:, 3] = memory.node_step[chosen] * self._plan.step_s
        nodes[:, 4] = rows[memory.node_parent[chosen]]
        nodes[:, 6] = order[chosen]
        if made and memory.node_step[last] == self._plan.steps:
            status = SearchStatus.FOUND
        elif made and (expansions >= budget or last > 0):
            status = SearchStatus.PARTIAL
        else:
            status = SearchStatus.NO_PATH
        return SearchTree(status, expansions, budget, nodes, left_out)

    def _risk(self, kept: Agents, row: int, prediction: Prediction) -> RiskSlices:
        """Risk around an actor at each step of its search, on its floor and those near."""
        grid = self._batch.grid
        x, y = kept.positions[row].tolist()
        x0, y0 = (
            round((each - FIELD_CELLS * FIELD_CELL_M / 2) / FIELD_CELL_M) * FIELD_CELL_M
            for each in (x, y)
        )
        middles = FIELD_CELL_M * (np.arange(FIELD_CELLS) + 0.5)
        gx, gy = np.meshgrid(x0 + middles, y0 + middles)
        places = np.column_stack([gx.ravel(), gy.ravel()])
        cell = int(kept.cells[row])
        floor_m = float(grid.layered.floors[cell]) if cell >= 0 else 0.0
        _, cells = grid.on_ground(places, np.full(len(places), floor_m))
        field = self._batch.field.arrays
        room = field._replace(
            people=np.zeros_like(field.people),
            rows=np.zeros_like(field.rows),
            starts=np.zeros_like(field.starts),
            members=np.zeros_like(field.members),
        )
        values = np.zeros((self._plan.steps + 1, len(places)))
        kernels.risk_slices(self._held, prediction, room, row, SUB, cells, places, values)
        return RiskSlices(
            (x0, y0),
            FIELD_CELL_M,
            np.arange(self._plan.steps + 1, dtype=np.float64) * self._plan.step_s,
            values.astype(np.float32).reshape(-1, FIELD_CELLS, FIELD_CELLS),
        )


def _parents_first(memory: Workspace, nodes: list[int]) -> list[int]:
    """Nodes in their order, each after those that lead to it.

    Steps of the path that a search has gone on from were nodes before they were expanded, if ever.
    """
    found: dict[int, None] = {}
    for last in nodes:
        n, way = last, list[int]()
        while n >= 0 and n not in found:
            way.append(n)
            n = int(memory.node_parent[n])
        found.update(dict.fromkeys(reversed(way)))
    return list(found)


def _winner(
    taken: PricedPath, previous: PricedPath | None, perturbed: PricedPath | None, changed: bool
) -> Winner:
    if previous is None:
        return "first"
    if perturbed is None:
        return "forced"
    if np.array_equal(taken.places, perturbed.places):
        return "perturbation" if changed else "kept"
    return "search"

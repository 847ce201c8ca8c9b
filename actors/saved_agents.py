"""Checks saved agents before kernels read them: what cannot be there is refused by name."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, get_args

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.outcomes import Kind, Outcome
from esplanade.actors.parameters import ActorParameters
from esplanade.actors.state import Reason
from esplanade.planning import PARAMETERS, AgentTable, LayeredGrid, SavedAgentsError

MOST_M = 1_000_000.0
_FINITE = ("velocities", "headings", "heights", "behind_s", "planned", "followed", "goals")
_BOUNDED_TRIPS = (
    "no_path_s",
    "reason_s",
    "stalled_s",
    "queued_s",
    "look_in_s",
    "stood_at",
    "stood_s",
)
_PERHAPS = ("wanted", "points_at")


def with_new_parameters(arrays: Mapping[str, NDArray[Any]]) -> dict[str, NDArray[Any]]:
    """The columns of saved agents, with usual values for parameters that are newer than they are.

    Whatever else may be wrong with the columns is left for others to refuse.
    """
    out = dict(arrays)
    saved = out.get("parameters")
    names, known = () if saved is None else saved.dtype.names or (), PARAMETERS.names or ()
    if saved is None or not names or names == known or names != known[: len(names)]:
        return out
    complete = np.full(saved.shape, ActorParameters().row(), dtype=PARAMETERS)
    for name in names:
        complete[name] = saved[name]
    out["parameters"] = complete
    return out


def check_saved(table: AgentTable, grid: LayeredGrid) -> None:
    """Check all that agents of this ground could not have come to; cells are found anew.

    Raises
    ------
    SavedAgentsError
        A column has such a value.
    """
    agents, trips = table.agents, table.trips
    x0, y0, x1, y1 = grid.bounds
    x, y = agents.positions.T
    _hold("positions", (x0 <= x) & (x <= x1) & (y0 <= y) & (y <= y1))
    for name in _FINITE:
        _hold(name, np.abs(getattr(agents, name)) <= MOST_M)
    for name in _BOUNDED_TRIPS:
        _hold(name, np.abs(getattr(trips, name)) <= 1e12)
    for name in _PERHAPS:
        column = getattr(trips, name)
        _hold(name, np.isnan(column) | (np.abs(column) <= MOST_M))
    wanted = trips.wanted[~np.isnan(trips.wanted).any(axis=1)]
    _hold(
        "wanted",
        (x0 <= wanted[:, 0]) & (wanted[:, 0] <= x1) & (y0 <= wanted[:, 1]) & (wanted[:, 1] <= y1),
    )
    _hold("ask_at_s", ~np.isnan(trips.ask_at_s))
    _hold("left_m", np.isnan(agents.left_m) | (agents.left_m >= 0.0))
    _hold("reasons", (agents.reasons >= 0) & (agents.reasons <= max(Reason)))
    _hold("outcomes", (trips.outcomes >= 0) & (trips.outcomes <= max(Outcome)))
    for kind, _ in table.in_the_way.values():
        if kind not in get_args(Kind):
            raise SavedAgentsError(f"what is in the way of a saved agent is {kind!r}")
    _hold("nearest_m", np.isnan(trips.nearest_m) | (trips.nearest_m >= 0.0))
    _hold("cautions", (agents.cautions >= 0.0) & (agents.cautions <= 1.0))
    _hold("on_edges", (agents.on_edges >= 0.0) & (agents.on_edges <= MOST_M))
    _hold("ages", (agents.ages >= 0) & (agents.ages <= 2**40))
    for field in agents.passages.dtype.names or ():
        _hold(f"passages.{field}", ~np.isnan(agents.passages[field]))
    for actor_id, record in zip(table, agents.parameters, strict=True):
        try:
            ActorParameters.of_row(record)
        except (ValueError, OverflowError) as error:
            raise SavedAgentsError(f"parameters of {actor_id!r}: {error}") from error
    cells = [
        grid.cell_at((float(x), float(y)), float(z))
        for (x, y), z in zip(agents.positions, agents.heights, strict=True)
    ]
    agents.cells[:] = cells
    known = agents.cells >= 0
    agents.layers[:] = np.where(known, grid.layered.places["layer"][agents.cells], 0)


def _hold(name: str, good: NDArray[np.bool_]) -> None:
    if not good.all():
        raise SavedAgentsError(f"column {name!r} of saved agents has a value that cannot be")

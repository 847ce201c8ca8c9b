"""The changes that a door makes to a grid are derived before the door moves."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from esplanade.planning.grid._grid_kernels import GridArrays
from esplanade.planning.scene.bodies import Body
from esplanade.planning.traversal.cache import KnownTraversability


@dataclass(frozen=True, eq=False)
class DoorChange:
    """The arrays that `LayeredGrid.prepare_door` has derived for one door that is to move."""

    name: str
    is_open: bool
    base: GridArrays
    """The arrays that it was derived from: it holds for these only."""
    arrays: GridArrays
    known: Mapping[Body, KnownTraversability]

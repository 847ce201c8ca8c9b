"""The changes of a grid that gets to know other kinds of body, derived beforehand."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from esplanade.planning.grid._grid_kernels import GridArrays
from esplanade.planning.scene.bodies import Body
from esplanade.planning.traversal.cache import KnownTraversability


@dataclass(frozen=True, eq=False)
class BodiesChange:
    """Arrays that a fork of a grid (`LayeredGrid.fork`) has derived for kinds of body new to it."""

    base: GridArrays
    """The arrays that it was derived from: it holds for these only."""
    arrays: GridArrays
    rows: Mapping[Body, int]
    """Rows of all kinds of body in these arrays."""
    known: Mapping[Body, KnownTraversability]
    """Of all these kinds."""

"""The slopes of a layer's cells, so that a ramp is written as a plane and stairs as steps."""

from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from esplanade.planning import Polygon, Scene
from esplanade.scenery.exports.layers import LayerCells

Floats = NDArray[np.float64]

GENTLE: Final = 0.35
"""Cells that rise by less from one to the next are a slope; by more, steps. So it is with stairs
of 0.3 m treads in cells of a quarter of a metre, which never rise twice in a row by so little."""
_SAME_M: Final = 1e-3


def slopes_of(scene: Scene, layer: LayerCells) -> tuple[Floats, Floats]:
    """The rise of each cell to the east and to the north, (rows, columns), metres a metre.

    On ramps of a scene it is that of the ramp. Elsewhere, as on a mesh, it is the lesser of those
    to the neighbours on both sides, and none where the two have not the same sign.
    """
    east = _gentler(layer.floors, layer.cell_m)
    north = _gentler(layer.floors.T, layer.cell_m).T
    for solid in scene.polygons:
        if solid.ramp is not None and solid.carries:
            on_it = _on_ramp(solid, layer)
            along = np.subtract(solid.ramp.end, solid.ramp.start)
            rise_m = solid.height_m - solid.ramp.start_height_m
            slope = rise_m * along / float(along @ along)
            east[on_it], north[on_it] = slope
    return east, north


def _gentler(floors: Floats, cell_m: float) -> Floats:
    """The lesser of the slopes to both neighbours along the rows; 0 beside what is no slope."""
    found = np.zeros(floors.shape)
    if floors.shape[1] < 2:
        return found
    rises = np.diff(floors, axis=1) / cell_m
    gentle = np.where(np.abs(rises) < GENTLE, rises, np.nan)
    edge = np.full((floors.shape[0], 1), np.nan)
    behind, ahead = np.hstack([edge, gentle]), np.hstack([gentle, edge])
    # At the rim of a floor there is one neighbour, and its slope counts.
    behind, ahead = (
        np.where(np.isnan(behind), ahead, behind),
        np.where(np.isnan(ahead), behind, ahead),
    )
    same = np.sign(behind) == np.sign(ahead)
    lesser = np.where(np.abs(behind) < np.abs(ahead), behind, ahead)
    found[same] = lesser[same]
    return np.nan_to_num(found)


def _on_ramp(solid: Polygon, layer: LayerCells) -> NDArray[np.bool_]:
    """The cells whose floor is the sloping part of a solid."""
    (x0, y0), (rows, columns) = layer.corner, layer.floors.shape
    x, y = np.meshgrid(
        x0 + (np.arange(columns) + 0.5) * layer.cell_m,
        y0 + (np.arange(rows) + 0.5) * layer.cell_m,
    )
    ramp: Any = solid.ramp
    along = np.subtract(ramp.end, ramp.start)
    share = ((x - ramp.start[0]) * along[0] + (y - ramp.start[1]) * along[1]) / (along @ along)
    low, high = solid.offset_m + ramp.start_height_m, solid.offset_m + solid.height_m
    on_top = np.abs(layer.floors - (low + share * (high - low))) < _SAME_M
    sloping: NDArray[np.bool_] = (share > 0.0) & (share < 1.0) & on_top
    return sloping & _inside(np.asarray(solid.points), x, y)


def _inside(ring: Floats, x: Floats, y: Floats) -> NDArray[np.bool_]:
    """Whether points lie in a ring, by the crossings of a line to the east."""
    inside = np.zeros(x.shape, dtype=np.bool_)
    for (ax, ay), (bx, by) in zip(ring, np.roll(ring, -1, axis=0), strict=True):
        crosses = (ay > y) != (by > y)
        with np.errstate(divide="ignore", invalid="ignore"):
            at = ax + (y - ay) * (bx - ax) / (by - ay)
        inside ^= crosses & (x < at)
    return inside

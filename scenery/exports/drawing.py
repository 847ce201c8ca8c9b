"""A plan of a layer to scale, as PNG, SVG or PDF."""

from importlib import import_module
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from esplanade.commandline.errors import UsageError
from esplanade.commandline.pictures import save
from esplanade.planning import Scene
from esplanade.scenery.exports.layers import LayerCells
from esplanade.scenery.pictures import require_matplotlib

_INCHES_A_CM: Final = 1.0 / 2.54
_MOST_INCHES: Final = 200.0
MARGIN_CM: Final = 0.8
"""Paper around the plan, on each side."""
_DOTS_AN_INCH: Final = 150
_FLOOR: Final = 0.94
_SOLID: Final = 0.55
_DEEPEST: Final = 0.22
_DARKEST_M: Final = 4.0
"""Shades of gray, and how far from the usual height the darkest floors are."""


def draw_plan(scene: Scene, layer: LayerCells, metres_a_cm: float, path: Path) -> None:
    """Draw floors, walls and doors; one centimetre of paper shows so many metres."""
    (x0, y0), (rows, columns) = layer.corner, layer.floors.shape
    width, height = columns * layer.cell_m, rows * layer.cell_m
    size = tuple((side / metres_a_cm + 2.0 * MARGIN_CM) * _INCHES_A_CM for side in (width, height))
    if max(size) > _MOST_INCHES or min(size) < 0.1:
        raise UsageError(
            "--metres-per-cm: the plan would measure "
            f"{size[0] * 2.54:.3g} x {size[1] * 2.54:.3g} cm"
        )
    figure = require_matplotlib()(figsize=size, dpi=_DOTS_AN_INCH)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    extent = (x0, x0 + width, y0, y0 + height)
    floors = import_module("matplotlib.patches").Rectangle(
        (x0, y0), width, height, fill=False, lw=0.0, transform=axes.transData
    )
    axes.imshow(
        _shades(layer.floors),
        cmap="gray",
        vmin=0.0,
        vmax=1.0,
        origin="lower",
        extent=extent,
        interpolation="nearest",
    )
    for ring in layer.solids:
        (shape,) = axes.fill(*zip(*ring, strict=True), color=str(_SOLID), ec="0.3", lw=0.4)
        shape.set_clip_path(floors)
    for (ax, ay), (bx, by) in layer.walls:
        axes.plot((ax, bx), (ay, by), color="black", lw=1.5)
    for _, ((ax, ay), (bx, by)) in layer.doors:
        axes.plot((ax, bx), (ay, by), color="#d7191c", lw=2.0)
    for name, (x, y) in layer.places:
        # Names begin, or end, where they would not fit beside the rim.
        side = min(2, max(0, int(5.0 * (x - x0) / width) // 2))
        axes.annotate(name, (x, y), ha=("left", "center", "right")[side], fontsize=6)
    _add_scale(axes, scene, layer, metres_a_cm)
    margin = MARGIN_CM * metres_a_cm
    axes.set(
        xlim=(extent[0] - margin, extent[1] + margin), ylim=(extent[2] - margin, extent[3] + margin)
    )
    axes.axis("off")
    save(figure, path)


def _shades(floors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Bright floors; the further from the height that most have, the darker, as up stairs."""
    known = floors[np.isfinite(floors)]
    heights, counts = np.unique(np.round(known, 2), return_counts=True)
    off_m = np.abs(floors - heights[np.argmax(counts)])
    shades = _FLOOR - _DEEPEST * np.minimum(off_m / _DARKEST_M, 1.0)
    return np.where(np.isfinite(floors), shades, _SOLID)


def _add_scale(axes: Any, scene: Scene, layer: LayerCells, metres_a_cm: float) -> None:
    """A bar of about a fifth of the width below the plan, and the scale in words beside it."""
    (x0, y0), columns = layer.corner, layer.floors.shape[1]
    fifth_m = 0.2 * columns * layer.cell_m
    power = 10.0 ** np.floor(np.log10(fifth_m))
    length_m = float(power * max(n for n in (1, 2, 5) if n * power <= fifth_m or n == 1))
    left, foot = x0, y0 - 0.75 * MARGIN_CM * metres_a_cm
    axes.plot((left, left + length_m), (foot, foot), color="black", lw=3, solid_capstyle="butt")
    told = f"{length_m:g} m · 1:{100 * metres_a_cm:g} · {scene.name}, layer {layer.number}"
    axes.annotate(told, (left + length_m + 0.2 * metres_a_cm, foot), fontsize=7, va="center")

"""A plan of a layer to scale, as PNG, SVG or PDF."""

from pathlib import Path
from typing import Final

import numpy as np

from esplanade.commandline.errors import UsageError
from esplanade.commandline.pictures import save
from esplanade.planning import Scene
from esplanade.scenery.exports.layers import LayerCells
from esplanade.scenery.pictures import require_matplotlib

_INCHES_A_CM: Final = 1.0 / 2.54
_MOST_INCHES: Final = 200.0
_DOTS_AN_INCH: Final = 150


def draw_plan(scene: Scene, layer: LayerCells, metres_a_cm: float, path: Path) -> None:
    """Draw floors, walls and doors; one centimetre of paper shows so many metres."""
    (x0, y0), (rows, columns) = layer.corner, layer.floors.shape
    width, height = columns * layer.cell_m, rows * layer.cell_m
    size = tuple(side / metres_a_cm * _INCHES_A_CM for side in (width, height))
    if max(size) > _MOST_INCHES or min(size) < 0.1:
        raise UsageError(
            "--metres-per-cm: the plan would measure "
            f"{size[0] * 2.54:.3g} x {size[1] * 2.54:.3g} cm"
        )
    figure = require_matplotlib()(figsize=size, dpi=_DOTS_AN_INCH)
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    extent = (x0, x0 + width, y0, y0 + height)
    axes.imshow(
        np.where(np.isfinite(layer.floors), 0.92, 0.55),
        cmap="gray",
        vmin=0.0,
        vmax=1.0,
        origin="lower",
        extent=extent,
        interpolation="nearest",
    )
    for (ax, ay), (bx, by) in layer.walls:
        axes.plot((ax, bx), (ay, by), color="black", lw=1.5)
    for _, ((ax, ay), (bx, by)) in layer.doors:
        axes.plot((ax, bx), (ay, by), color="#d7191c", lw=2.0)
    known = layer.floors[np.isfinite(layer.floors)]
    for place in scene.places:
        if known.min() - 0.5 <= place.z_m <= known.max() + 0.5:
            axes.annotate(place.name, place.position, ha="center", fontsize=6)
    axes.set(xlim=extent[:2], ylim=extent[2:])
    axes.axis("off")
    save(figure, path)

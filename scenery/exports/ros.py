"""A layer as a map of ROS: an image in PGM, and the YAML that names it."""

import json
import math

import numpy as np
from numpy.typing import NDArray

from esplanade.scenery.exports.layers import LayerCells, Line

_FREE, _OCCUPIED = 254, 0


def layer_as_pgm(layer: LayerCells) -> bytes:
    """Free where there is a floor and no wall, all else occupied; the first row is the north."""
    image = np.where(np.isfinite(layer.floors), _FREE, _OCCUPIED).astype(np.uint8)
    for wall in layer.walls:
        _draw(image, wall, layer)
    rows, columns = image.shape
    return b"P5\n%d %d\n255\n" % (columns, rows) + image[::-1].tobytes()


def layer_as_yaml(layer: LayerCells, image: str) -> str:
    """The YAML beside the image."""
    x, y = layer.corner
    return (
        f"image: {json.dumps(image)}\nresolution: {layer.cell_m:.10g}\n"
        f"origin: [{x:.10g}, {y:.10g}, 0.0]\n"
        "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
    )


def _draw(image: NDArray[np.uint8], wall: Line, layer: LayerCells) -> None:
    """Mark the cells that a wall goes through."""
    (ax, ay), (bx, by) = wall
    count = 2 + math.ceil(4.0 * math.dist(*wall) / layer.cell_m)
    columns = ((np.linspace(ax, bx, count) - layer.corner[0]) // layer.cell_m).astype(int)
    rows = ((np.linspace(ay, by, count) - layer.corner[1]) // layer.cell_m).astype(int)
    inside = (rows >= 0) & (rows < image.shape[0]) & (columns >= 0) & (columns < image.shape[1])
    image[rows[inside], columns[inside]] = _OCCUPIED

"""Draw docs/images/classes.png: the five classes of two floors, and a way from one to the other.

python tools/draw_classes.py
"""

from pathlib import Path

import matplotlib as mpl
import numpy as np

from esplanade.planning import Body, LayeredGrid, Polygon, Scene, Stairs, Wall, find_path
from esplanade.planning.traversal.stability import Stability

mpl.use("Agg")
from matplotlib import pyplot as plt
from matplotlib.colors import ListedColormap
from matplotlib.patches import Patch

OUT = Path(__file__).resolve().parents[1] / "docs" / "images" / "classes.png"
COLOURS = {
    Stability.FORBIDDEN: "#333a44",
    Stability.STABLE: "#f4f1ea",
    Stability.UNSTABLE: "#b9c2cc",
    Stability.UP_STAIR: "#e8a33d",
    Stability.DOWN_STAIR: "#4f9dc4",
}
START, GOAL = (9.0, 2.0, 0.0), (9.0, 2.0, 2.8)


def scene() -> Scene:
    """A ground floor, an upper floor with a bench on it, and a flight of stairs."""

    def box(x0: float, y0: float, x1: float, y1: float, offset: float, height: float) -> Polygon:
        ring = ((x0, y0), (x1, y0), (x1, y1), (x0, y1))
        return Polygon(points=ring, offset_m=offset, height_m=height)

    return Scene(
        bounds=(0.0, 0.0, 12.0, 12.0),
        polygons=(box(6.0, 0.0, 12.0, 12.0, 2.6, 0.2), box(8.0, 5.0, 11.0, 6.0, 2.8, 0.45)),
        walls=(Wall(start=(4.0, 0.0), end=(4.0, 7.0)),),
        stairs=(Stairs(start=(1.5, 9.5), end=(6.0, 9.5), width_m=2.0, top_m=2.8, steps=16),),
    )


def main() -> None:
    grid, body = LayeredGrid.from_scene(scene()), Body.adult()
    traversability, path = grid.traversability.of(body), find_path(grid, START, GOAL, body)
    places = traversability.arrays.places
    layers, rows, columns = places["layer"], places["row"], places["column"]
    figure, axes = plt.subplots(1, 2, figsize=(10, 5.6), layout="constrained")
    for layer, axis in enumerate(axes):
        held = (
            (layers == layer)
            & (rows < traversability.arrays.ny)
            & (columns < traversability.arrays.nx)
        )
        shown = np.zeros((traversability.arrays.ny, traversability.arrays.nx))
        shown[rows[held], columns[held]] = traversability.classes[held]
        axis.imshow(
            shown,
            origin="lower",
            extent=(0, 12, 0, 12),
            cmap=ListedColormap(list(COLOURS.values())),
            vmin=-0.5,
            vmax=4.5,
        )
        on_it = np.where(path.layers[:, None] == layer, path.points[:, :2], np.nan)
        axis.plot(*on_it.T, color="#c0392b", linewidth=2.2)
        for (x, y, z), mark in ((START, "o"), (GOAL, "s")):
            if (z > 1.0) == (layer == 1):
                axis.plot(x, y, mark, color="#c0392b", markersize=8)
        axis.set(title=f"layer {layer}", xticks=range(0, 13, 4), yticks=range(0, 13, 4))
    names = [Patch(facecolor=c, edgecolor="#888", label=s.name) for s, c in COLOURS.items()]
    figure.legend(handles=names, loc="outside lower center", ncols=5, frameon=False)
    figure.savefig(OUT, dpi=90)


if __name__ == "__main__":
    main()

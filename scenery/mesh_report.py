"""The figures of an imported building: floors by layer, bounds, and what was passed over."""

from collections import Counter

import numpy as np
from rich.console import Console
from rich.table import Table

from esplanade.planning import LayeredGrid


def show_floors(console: Console, grid: LayeredGrid) -> None:
    """Print the bounds, and the floor area of each layer."""
    x0, y0, x1, y1 = grid.bounds
    floors, layers = grid.layered.floors, grid.layered.places["layer"]
    known = np.isfinite(floors)
    table = Table("layer", "area m²", "floors m", box=None, pad_edge=False)
    for layer in np.unique(layers[known]).tolist():
        heights = floors[known & (layers == layer)]
        area_m2 = len(heights) * grid.cell_m**2
        span = f"{heights.min():.2f} to {heights.max():.2f}"
        table.add_row(str(layer), f"{area_m2:.1f}", span)
    console.print(table)
    console.print(
        f"{known.sum() * grid.cell_m**2:.1f} m² of floor in all; x {x0:g} to {x1:g}, y {y0:g} to "
        f"{y1:g}",
        highlight=False,
        soft_wrap=True,
    )


def show_passed(console: Console, passed: Counter[str]) -> None:
    """Print what of a file was passed over, and how often."""
    for what, count in passed.items():
        console.print(f"passed over: {count} {what}", highlight=False, markup=False, soft_wrap=True)

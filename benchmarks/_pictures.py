"""A picture of one disagreement: the way that one planner finds, and where the other is stuck."""

from __future__ import annotations

import sys
from importlib import import_module
from pathlib import Path
from typing import Any, Final

import numpy as np
from benchmarks._comparison import Disagreement
from benchmarks._pairs import Floats

CLOSE_M: Final = 4.0
"""Half the side of what is shown close up."""
STOREY_M: Final = 2.0
"""What is further above or below the gap is left out of the close-up."""


def draw(
    path: Path,
    title: str,
    refusal: Disagreement,
    way: Floats,
    cells: tuple[Floats, float],
    triangles: Floats,
) -> None:
    """Two plans: the whole way over all floors, and what lies around the gap.

    `way` is float64 (N, 3), `cells` are our centres (C, 3) and their side in metres, `triangles`
    what the navigation mesh holds as walkable, float64 (T, 3, 3).
    """
    try:
        figure_of = import_module("matplotlib.figure").Figure
        outlines_of = import_module("matplotlib.collections").PolyCollection
    except ImportError:
        sys.exit("pictures need matplotlib, which comes with `esplanade[evaluate]`")
    path.parent.mkdir(parents=True, exist_ok=True)
    figure = figure_of(figsize=(15.0, 7.5), layout="constrained")
    whole, close = figure.subplots(1, 2)
    centres, cell_m = cells
    gap = np.array(refusal.gap)
    near = _near(centres, gap)
    _squares(whole, outlines_of, centres, cell_m)
    shown = _squares(close, outlines_of, centres[near], 0.92 * cell_m)
    touching = triangles[_near(triangles.mean(axis=1), gap, 4.0 * CLOSE_M)]
    close.add_collection(
        outlines_of(
            touching[..., :2], facecolors=(0.8, 0.1, 0.1, 0.12), edgecolors="tab:red", lw=0.4
        )
    )
    for axes in (whole, close):
        axes.plot(way[:, 0], way[:, 1], color="tab:blue", lw=1.6)
        axes.plot(*refusal.start[:2], "o", color="tab:green", ms=7)
        axes.plot(*refusal.goal[:2], "*", color="tab:green", ms=11)
        axes.plot(*gap[:2], "x", color="black", ms=11, mew=2.5)
        axes.set_aspect("equal")
    whole.autoscale_view()
    close.set_xlim(gap[0] - CLOSE_M, gap[0] + CLOSE_M)
    close.set_ylim(gap[1] - CLOSE_M, gap[1] + CLOSE_M)
    close.set_title(f"around z = {gap[2]:.2f} m; red: navigation mesh, squares: our cells")
    figure.suptitle(f"{title}, pair {refusal.number}, {refusal.who}: {refusal.why}")
    if near.any():
        figure.colorbar(shown, ax=close, label="height, m", shrink=0.8)
    figure.savefig(path, dpi=90)


def _near(points: Floats, gap: Floats, half_m: float = CLOSE_M) -> Any:
    away = np.abs(points - gap)
    return (away[:, :2].max(axis=1) <= half_m) & (away[:, 2] <= STOREY_M)


def _squares(axes: Any, outlines_of: Any, centres: Floats, side_m: float) -> Any:
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * side_m / 2.0
    lowest_first = centres[np.argsort(centres[:, 2])]
    drawn = outlines_of(lowest_first[:, None, :2] + corners, cmap="viridis", lw=0)
    drawn.set_array(lowest_first[:, 2])
    axes.add_collection(drawn)
    return drawn

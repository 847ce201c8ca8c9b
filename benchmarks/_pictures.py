"""A picture of one disagreement: the path of one planner, and the gap of the other."""

from __future__ import annotations

import sys
from importlib import import_module
from pathlib import Path
from typing import Any, Final

import numpy as np
from benchmarks._comparison import Disagreement
from benchmarks._pairs import Floats

CLOSE_M: Final = 4.0
"""Half the side of the close-up."""
STOREY_M: Final = 2.0
"""The close-up leaves out points that are farther than this above or below the gap."""


def draw(
    path: Path,
    title: str,
    refusal: Disagreement,
    found_path: Floats,
    cells: tuple[Floats, float],
    triangles: Floats,
) -> None:
    """Draw two maps: the whole path over all floors, and a close-up of the gap.

    `found_path` is float64 (N, 3), `cells` are the centres of our cells (C, 3) and their side,
    `triangles` are the walkable triangles of the navigation mesh, float64 (T, 3, 3); all in
    metres.
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
        axes.plot(found_path[:, 0], found_path[:, 1], color="tab:blue", lw=1.6)
        axes.plot(*refusal.start[:2], "o", color="tab:green", ms=7)
        axes.plot(*refusal.goal[:2], "*", color="tab:green", ms=11)
        axes.plot(*gap[:2], "x", color="black", ms=11, mew=2.5)
        axes.set_aspect("equal")
    whole.autoscale_view()
    close.set_xlim(gap[0] - CLOSE_M, gap[0] + CLOSE_M)
    close.set_ylim(gap[1] - CLOSE_M, gap[1] + CLOSE_M)
    close.set_title(f"around z = {gap[2]:.2f} m; red: navigation mesh, squares: our cells")
    figure.suptitle(f"{title}, pair {refusal.number}, {refusal.finders}: {refusal.why}")
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

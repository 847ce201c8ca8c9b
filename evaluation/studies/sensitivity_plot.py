"""The picture of a sensitivity study: a row for every setting, a column for every measure."""

from collections.abc import Sequence
from importlib import import_module
from pathlib import Path
from typing import Any, Final

import numpy as np

from esplanade.commandline.pictures import save
from esplanade.evaluation.measures import MEASURES
from esplanade.evaluation.plotting import require_matplotlib
from esplanade.evaluation.studies.sensitivity import Curve, Point

SHOWN: Final = 4
"""The number of `MEASURES` that are drawn, from the first on."""
WIDTH_IN: Final = 9.6
ROW_IN: Final = 1.05
AROUND_IN: Final = 0.85
"""The height of the headings and the legend together."""
INK: Final = "#1f2933"
LINE: Final = "#2563a8"
GOAL: Final = "#2f8f4e"
BASELINE_BAND: Final = "#e9edf2"
STYLE: Final = {
    "font.sans-serif": ["DejaVu Sans", "sans-serif"],
    "font.size": 8.0,
    "axes.edgecolor": "#9aa5b1",
    "axes.labelcolor": INK,
    "axes.linewidth": 0.6,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "text.color": INK,
    "xtick.color": INK,
    "ytick.color": INK,
    "xtick.bottom": False,
    "ytick.left": False,
    "svg.fonttype": "none",  # text as text: a third of the size
    "svg.hashsalt": "sensitivity",  # the same figures give the same file
}


def draw(path: Path, curves: Sequence[Curve]) -> None:
    """Draw all curves; each column has one scale, so that settings can be compared."""
    figure_of = require_matplotlib()
    with import_module("matplotlib").rc_context(STYLE):
        height = AROUND_IN + ROW_IN * len(curves)
        figure = figure_of(figsize=(WIDTH_IN, height), facecolor="white")
        axes = figure.subplots(len(curves), SHOWN, sharey="col", squeeze=False)
        for row, curve in zip(axes, curves, strict=True):
            for column, panel in enumerate(row):
                _draw(panel, curve, column)
            label = f"{curve.name}\n{curve.unit}" if curve.unit else curve.name
            row[0].set_ylabel(label, rotation=0, ha="right", va="center", labelpad=14)
        for panel, measure in zip(axes[0], MEASURES, strict=False):
            panel.set_title(measure.label, fontsize=9, pad=8)
            panel.set_ylim(bottom=min(measure.best, panel.get_ylim()[0]))
        figure.text(
            0.5,
            0.12 / height,
            "shaded: baseline · filled: differs from it beyond chance · bars: 95 % · green: goal",
            ha="center",
            va="bottom",
        )
        figure.tight_layout(rect=(0, 0.3 / height, 1, 1), h_pad=0.4, w_pad=0.8)
        save(figure, path)


def _draw(panel: Any, curve: Curve, column: int) -> None:
    places = range(len(curve.points))
    means = np.array([point.means[column] for point in curve.points])
    reach = np.array([_reach(point, column) for point in curve.points]).T
    baseline = [point.value for point in curve.points].index(curve.baseline)
    panel.axvspan(baseline - 0.4, baseline + 0.4, color=BASELINE_BAND, lw=0, zorder=0)
    panel.axhline(MEASURES[column].goal, color=GOAL, lw=0.8, ls=(0, (4, 3)), zorder=1)
    panel.errorbar(places, means, reach, color=LINE, lw=1.2, elinewidth=0.8, zorder=2)
    fills = [LINE if point.differs[column] else "white" for point in curve.points]
    panel.scatter(
        places, means, s=16, c=fills, edgecolors=LINE, linewidths=1.0, zorder=3, clip_on=False
    )
    panel.set_xticks(places, [_short(point.value) for point in curve.points])
    panel.set_xlim(-0.5, len(curve.points) - 0.5)
    panel.locator_params(axis="y", nbins=4)


def _reach(point: Point, column: int) -> tuple[float, float]:
    """The lengths of the error bar below and above the mean."""
    mean = point.means[column]
    return max(mean - point.lows[column], 0.0), max(point.highs[column] - mean, 0.0)


def _short(value: Any) -> str:
    """A value with two digits, which is enough to tell the five values of a panel apart."""
    if not isinstance(value, float):
        return str(value).lower()
    text = f"{float(f'{value:.2g}'):g}"
    return text[1:] if text.startswith("0.") else text

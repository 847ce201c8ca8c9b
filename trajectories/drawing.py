"""A picture of a recorded crowd: where people went, and how fast."""

from importlib import import_module
from pathlib import Path
from typing import Any, Final

import numpy as np

from esplanade.commandline.pictures import save
from esplanade.recordings import Crowd

MOST_STEPS: Final = 200_000
"""Steps that are drawn; of more, every so many."""
_FASTEST_DRAWN_MPS: Final = 2.5


class DrawingError(ValueError):
    """A picture cannot be drawn; the message says why."""


def draw_crowd(path: Path, crowd: Crowd) -> None:
    """Draw all tracks from above, coloured by speed, and beside them how often each speed is.

    Raises
    ------
    DrawingError
        matplotlib is not installed, or the file cannot be written.
    """
    try:
        figure_of = import_module("matplotlib.figure").Figure
        lines_of = import_module("matplotlib.collections").LineCollection
    except ImportError:
        raise DrawingError(
            "pictures need matplotlib: install it, or everything of `esplanade[recordings]`"
        ) from None
    figure = figure_of(figsize=(11.0, 6.0), layout="constrained")
    plan, spread = figure.subplots(1, 2, width_ratios=(3, 1))
    steps, speeds = _steps(crowd)
    drawn = slice(None, None, max(1, len(steps) // MOST_STEPS))
    lines = lines_of(steps[drawn], array=speeds[drawn], cmap="viridis", linewidths=0.8)
    lines.set_clim(0.0, _FASTEST_DRAWN_MPS)
    plan.add_collection(lines)
    starts = np.array([track.positions[0] for track in crowd.tracks])
    plan.plot(*starts.T, ".", color="0.3", markersize=3)
    _frame(plan, crowd)
    figure.colorbar(lines, ax=plan, label="speed [m/s]", shrink=0.7)
    report = crowd.report
    bins = np.linspace(0.0, 2 * _FASTEST_DRAWN_MPS, 51).tolist()
    if len(speeds):
        spread.hist(
            np.clip(speeds, 0.0, 2 * _FASTEST_DRAWN_MPS),
            bins=bins,
            color="#3b528b",
        )
        spread.axvline(float(np.median(speeds)), color="#c0392b", linewidth=1)
    spread.set_xlabel("speed [m/s], median in red")
    spread.set_ylabel("steps")
    if report is not None:
        figure.suptitle(report.line.replace("; ", "\n", 1).replace("$", r"\$"), fontsize=8)
    try:
        save(figure, path, dpi=150)
    except OSError as error:
        raise DrawingError(f"{path} cannot be written: {error.strerror or error}") from None


def _steps(crowd: Crowd) -> tuple[Any, Any]:
    """All steps as lines, (N, 2, 2), metres, and their speeds, (N,), m/s."""
    pieces = [
        np.stack([track.positions[:-1], track.positions[1:]], axis=1) for track in crowd.tracks
    ]
    gaps = [np.diff(track.times) for track in crowd.tracks]
    steps = np.concatenate(pieces)
    return steps, np.hypot(*(steps[:, 1] - steps[:, 0]).T) / np.concatenate(gaps)


def _frame(plan: Any, crowd: Crowd) -> None:
    x0, y0, x1, y1 = crowd.bounds
    margin = 0.05 * max(x1 - x0, y1 - y0, 1.0)
    plan.set(
        xlim=(x0 - margin, x1 + margin),
        ylim=(y0 - margin, y1 + margin),
        aspect="equal",
        xlabel="x [m]",
        ylabel="y [m]",
    )
    plan.grid(linewidth=0.3)

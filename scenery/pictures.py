"""Pictures of one layer of a scene: what each of them shows, its legend, and a scale bar."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from esplanade.commandline.errors import UsageError

Floats = NDArray[np.float64]

_LONGER_SIDE_IN: Final = 9.0
_LEGEND_IN: Final = 2.3
_MARGIN_IN: Final = 0.45
_DOTS_AN_INCH: Final = 110
_NOTHING: Final = "white"
_WALL: Final = "#202020"
_PATH: Final = "#d7191c"

CLASSES: Final = {
    "forbidden": "#4d4d4d",
    "stable": "#d9ead3",
    "unstable": "#fdae61",
    "up-stair": "#2b83ba",
    "down-stair": "#9e6ebd",
}
"""How the five classes are painted, in the order of `Stability`."""
_FORBIDDEN: Final = 0


@dataclass(frozen=True)
class Mark:
    """A point with a name."""

    name: str
    position: tuple[float, float]
    spawn: bool


@dataclass(frozen=True)
class LayerView:
    """One layer, cell by cell: rows go north, columns east. What does not exist is nan or -1."""

    title: str
    number: int
    body: str
    corner: tuple[float, float]
    """x, y of the lower left corner of the first cell, metres."""
    cell_m: float
    floors: Floats
    """(rows, columns), metres; nan: nobody can stand there."""
    reachable: NDArray[np.bool_]
    """(rows, columns): somebody who comes in at a spawn gets there."""
    classes: NDArray[np.int8]
    """(rows, columns): codes in the order of CLASSES, -1: no floor."""
    distance: Floats
    """(rows, columns): way to the goal, metres; inf: none; nan: no floor."""
    walls: Floats
    """(S, 4): x0, y0, x1, y1 of what stops this body on this layer."""
    marks: tuple[Mark, ...]
    way: str
    """How long the path is, or why there is none."""
    path: Floats
    """(N, 2): the way between the two points, over all layers; empty: there is none."""
    path_layers: NDArray[np.int64]
    """(N,)"""

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """Left, right, bottom, top in metres."""
        rows, columns = self.floors.shape
        (x, y), cell_m = self.corner, self.cell_m
        return x, x + columns * cell_m, y, y + rows * cell_m


def require_matplotlib() -> Any:
    """matplotlib's Figure.

    Raises
    ------
    UsageError
        It is not installed.
    """
    try:
        return import_module("matplotlib.figure").Figure
    except ImportError:
        raise UsageError(
            "pictures need matplotlib: pip install matplotlib, or `pip install '.[scene]'`"
        ) from None


def draw_layer(view: LayerView, folder: Path) -> list[Path]:
    """Draw all that there is to a layer; returns the files, `layer-0-heights.png` and so on."""
    made = []
    for name, (caption, paint) in _SUBJECTS.items():
        path = folder / f"layer-{view.number}-{name}.png"
        _draw(view, caption, paint, path)
        made.append(path)
    return made


def _draw(
    view: LayerView, caption: str, paint: Callable[[LayerView, Any], None], path: Path
) -> None:
    left, right, bottom, top = view.extent
    inches_a_metre = _LONGER_SIDE_IN / max(right - left, top - bottom)
    inches = (right - left) * inches_a_metre, (top - bottom) * inches_a_metre
    size = inches[0] + _MARGIN_IN + _LEGEND_IN, inches[1] + 2.0 * _MARGIN_IN
    figure = require_matplotlib()(figsize=size, dpi=_DOTS_AN_INCH)
    axes = figure.add_axes(
        (_MARGIN_IN / size[0], _MARGIN_IN / size[1], inches[0] / size[0], inches[1] / size[1])
    )
    paint(view, axes)
    lines = import_module("matplotlib.collections").LineCollection
    axes.add_collection(lines(view.walls.reshape(-1, 2, 2), colors=_WALL, linewidths=0.9))
    _add_marks(view, axes)
    _add_scale(view, axes)
    axes.set_xlim(left, right)
    axes.set_ylim(bottom, top)
    axes.tick_params(labelsize=7)
    title = f"{view.title}, layer {view.number}: {caption.format(way=view.way)}"
    axes.set_title(title, fontsize=10, loc="left", pad=14)
    figure.savefig(path)


def _paint_heights(view: LayerView, axes: Any) -> None:
    # The darkest shades would hide names and walls.
    shades = import_module("matplotlib").colormaps["viridis"](np.linspace(0.25, 1.0, 256))
    colours = import_module("matplotlib.colors").ListedColormap(shades)
    _paint_measure(view.floors, "height of the floor, m", colours, view, axes)


def _paint_reachability(view: LayerView, axes: Any) -> None:
    codes = np.where(view.reachable, 0, np.where(view.classes == _FORBIDDEN, 2, 1))
    codes[view.classes < 0] = -1
    colours = {"reached": "#a6d8b0", "not reached": "#e08a80", "no room to stand": "#4d4d4d"}
    _paint_codes(codes, colours, view, axes)


def _paint_classes(view: LayerView, axes: Any) -> None:
    _paint_codes(view.classes, CLASSES, view, axes)


def _paint_path(view: LayerView, axes: Any) -> None:
    cut_off = np.where(np.isinf(view.distance), 0, -1)
    _paint_codes(cut_off, {"no way to the goal": "#c9c9c9"}, view, axes)
    known = np.where(np.isfinite(view.distance), view.distance, np.nan)
    _paint_measure(known, "way left to the goal, m", "YlGnBu_r", view, axes)
    here = view.path_layers == view.number
    for k in range(len(view.path) - 1):
        style = {"lw": 2.2} if here[k] or here[k + 1] else {"lw": 1.2, "ls": (0, (2, 2))}
        axes.plot(*view.path[k : k + 2].T, color=_PATH, **style)
    for end, marker, size in ((0, "o", 8), (-1, "*", 15)):
        if len(view.path):
            fill = _PATH if here[end] else _NOTHING
            axes.plot(*view.path[end], marker, ms=size, mfc=fill, mec="black", mew=0.8)


_SUBJECTS: Final = {
    "heights": ("heights", _paint_heights),
    "reachability": ("where one gets from the spawns", _paint_reachability),
    "classes": ("classes", _paint_classes),
    "path": ("potential and path ({way})", _paint_path),
}


def _paint_measure(values: Floats, caption: str, colours: Any, view: LayerView, axes: Any) -> None:
    """Metres as shades, with a bar that says which."""
    known = values[np.isfinite(values)]
    if not len(known):
        return
    low, high = float(known.min()), float(known.max())
    image = axes.imshow(
        values,
        origin="lower",
        extent=view.extent,
        cmap=colours,
        vmin=low,
        vmax=max(high, low + 0.1),
        interpolation="nearest",
    )
    bar = axes.figure.colorbar(image, cax=axes.inset_axes((1.03, 0.2, 0.03, 0.55)))
    bar.set_label(caption, fontsize=8)
    bar.ax.tick_params(labelsize=7)


def _paint_codes(
    codes: NDArray[np.integer], colours: Mapping[str, str], view: LayerView, axes: Any
) -> None:
    """Codes 0, 1, ... in the colours of the names; their share of all floor in the legend."""
    palette = import_module("matplotlib.colors").ListedColormap(list(colours.values()))
    axes.imshow(
        np.ma.masked_less(codes, 0),
        origin="lower",
        extent=view.extent,
        cmap=palette,
        vmin=-0.5,
        vmax=len(colours) - 0.5,
        interpolation="nearest",
    )
    patch = import_module("matplotlib.patches").Patch
    floor = max(1, int(np.isfinite(view.floors).sum()))
    handles = [
        patch(fc=colour, ec="0.4", label=f"{name} {np.sum(codes == code) / floor:.0%}")
        for code, (name, colour) in enumerate(colours.items())
    ]
    axes.legend(
        handles=handles,
        loc="upper left",
        bbox_to_anchor=(1.01, 1.0),
        frameon=False,
        fontsize=8,
        title=view.body,
        title_fontsize=8,
        alignment="left",
    )


def _add_marks(view: LayerView, axes: Any) -> None:
    outline = import_module("matplotlib.patheffects").withStroke(linewidth=2.0, foreground="white")
    for mark in view.marks:
        axes.plot(*mark.position, "^" if mark.spawn else ".", color="black", ms=7, mec="white")
        axes.annotate(
            mark.name,
            mark.position,
            xytext=(0, 5),
            textcoords="offset points",
            ha="center",
            fontsize=7,
            path_effects=[outline],
            annotation_clip=True,
        )


def _add_scale(view: LayerView, axes: Any) -> None:
    """A bar of a round length, at most a fifth of the picture's width."""
    most = 0.2 * (view.extent[1] - view.extent[0])
    power = 10.0 ** math.floor(math.log10(most))
    length = max(step * power for step in (1.0, 2.0, 5.0) if step * power <= most)
    bar = import_module("mpl_toolkits.axes_grid1.anchored_artists").AnchoredSizeBar
    axes.add_artist(
        bar(
            axes.transData,
            length,
            f"{length:g} m",
            "lower left",
            bbox_to_anchor=(1.01, 0.0),
            bbox_transform=axes.transAxes,
            frameon=False,
            size_vertical=length / 25.0,
            prop={"size": 8},
        )
    )

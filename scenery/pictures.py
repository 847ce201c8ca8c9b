"""Pictures of one layer of a scene, each with a legend and a scale bar."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from esplanade.commandline.errors import UsageError
from esplanade.commandline.pictures import save
from esplanade.planning import LayeredGrid

Floats = NDArray[np.float64]

_LONGER_SIDE_IN: Final = 9.0
_LEGEND_IN: Final = 2.3
_MARGIN_IN: Final = 0.45
_MOST_LAYERS: Final = 12
"""Most layers beside each other in one picture."""
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
"""The colours of the five classes, in the order of `Stability`."""
_FORBIDDEN: Final = 0


@dataclass(frozen=True)
class Marker:
    """A named point, which is a spawn, a place or the arrival of a portal."""

    name: str
    position: tuple[float, float]
    spawn: bool


@dataclass(frozen=True)
class LayerMap:
    """The data of one layer cell by cell; rows go north, columns go east."""

    title: str
    number: int
    body: str
    corner: tuple[float, float]
    """The x and y of the lower left corner of the first cell, metres."""
    cell_m: float
    floors: Floats
    """(rows, columns): the height of the floor, metres; nan where there is none."""
    reachable: NDArray[np.bool_]
    """(rows, columns): whether a path leads there from a spawn."""
    classes: NDArray[np.int8]
    """(rows, columns): codes in the order of `CLASSES`; -1 where there is no floor."""
    distance: Floats
    """(rows, columns): the length of the path to the goal, metres; inf where no path leads to it,
    nan where there is no floor."""
    walls: Floats
    """(S, 4): x0, y0, x1, y1 of the barriers that stop this body on this layer, metres."""
    markers: tuple[Marker, ...]
    path_summary: str
    """The length of the path, or the reason why there is none."""
    path: Floats
    """(N, 2): the path between the two points over all layers, metres; empty if there is none."""
    path_layers: NDArray[np.int64]
    """(N,): the layer of each point of the path."""

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """The left, right, bottom and top edges, metres."""
        rows, columns = self.floors.shape
        (x, y), cell_m = self.corner, self.cell_m
        return x, x + columns * cell_m, y, y + rows * cell_m


def require_matplotlib() -> Any:
    """The class `Figure` of matplotlib.

    Raises
    ------
    UsageError
        matplotlib is not installed.
    """
    try:
        return import_module("matplotlib.figure").Figure
    except ImportError:
        raise UsageError(
            "pictures need matplotlib: pip install matplotlib, or `pip install '.[scene]'`"
        ) from None


def draw_layer(layer: LayerMap, folder: Path, form: str = "png") -> list[Path]:
    """Draw all pictures of a layer; returns their files, such as `layer-0-heights.png`."""
    made = []
    for name, (caption, paint) in _SUBJECTS.items():
        path = folder / f"layer-{layer.number}-{name}.{form}"
        _draw(layer, caption, paint, path)
        made.append(path)
    return made


def draw_heights(grid: LayeredGrid, title: str, path: Path) -> None:
    """Draw the heights of the floors of all layers beside each other, in one picture."""
    x0, y0, x1, y1 = grid.bounds
    arrays = grid.layered
    known = np.isfinite(arrays.floors)
    numbers = np.unique(arrays.places["layer"][known])[:_MOST_LAYERS].tolist()
    side = _LONGER_SIDE_IN / max(x1 - x0, y1 - y0)
    width, height = max(2.0, (x1 - x0) * side), max(2.0, (y1 - y0) * side)
    size = (width + 0.8) * len(numbers) + 1.0, height + 1.0
    figure = require_matplotlib()(figsize=size, dpi=_DOTS_AN_INCH * min(1.0, 60.0 / size[0]))
    low, high = float(arrays.floors[known].min()), float(arrays.floors[known].max())
    image = None
    all_axes = figure.subplots(1, len(numbers), squeeze=False)[0]
    for axes, number in zip(all_axes, numbers, strict=True):
        own = known & (arrays.places["layer"] == number)
        columns, rows = arrays.places["column"][own], arrays.places["row"][own]
        dense = np.full((rows.max() + 1, columns.max() + 1), np.nan)
        dense[rows, columns] = arrays.floors[own]
        extent = (x0, x0 + dense.shape[1] * grid.cell_m, y0, y0 + dense.shape[0] * grid.cell_m)
        image = axes.imshow(
            dense, origin="lower", extent=extent, vmin=low, vmax=max(high, low + 0.1)
        )
        axes.set(xlim=(x0, x1), ylim=(y0, y1))
        axes.set_title(f"{title}, layer {number}" if number == numbers[0] else f"layer {number}")
        axes.tick_params(labelsize=7)
    figure.colorbar(image, ax=list(all_axes), label="height of the floor, m", shrink=0.7)
    save(figure, path)


def _draw(
    layer: LayerMap, caption: str, paint: Callable[[LayerMap, Any], None], path: Path
) -> None:
    left, right, bottom, top = layer.extent
    inches_a_metre = _LONGER_SIDE_IN / max(right - left, top - bottom)
    inches = (right - left) * inches_a_metre, (top - bottom) * inches_a_metre
    size = inches[0] + _MARGIN_IN + _LEGEND_IN, inches[1] + 2.0 * _MARGIN_IN
    figure = require_matplotlib()(figsize=size, dpi=_DOTS_AN_INCH)
    axes = figure.add_axes(
        (_MARGIN_IN / size[0], _MARGIN_IN / size[1], inches[0] / size[0], inches[1] / size[1])
    )
    paint(layer, axes)
    lines = import_module("matplotlib.collections").LineCollection
    axes.add_collection(lines(layer.walls.reshape(-1, 2, 2), colors=_WALL, linewidths=0.9))
    _add_markers(layer, axes)
    _add_scale(layer, axes)
    axes.set_xlim(left, right)
    axes.set_ylim(bottom, top)
    axes.tick_params(labelsize=7)
    title = f"{layer.title}, layer {layer.number}: {caption.format(path=layer.path_summary)}"
    axes.set_title(title, fontsize=10, loc="left", pad=14)
    save(figure, path)


def _paint_heights(layer: LayerMap, axes: Any) -> None:
    # The darkest shades are left out because they would hide names and walls.
    shades = import_module("matplotlib").colormaps["viridis"](np.linspace(0.25, 1.0, 256))
    colours = import_module("matplotlib.colors").ListedColormap(shades)
    _paint_measure(layer.floors, "height of the floor, m", colours, layer, axes)


def _paint_reachability(layer: LayerMap, axes: Any) -> None:
    codes = np.where(layer.reachable, 0, np.where(layer.classes == _FORBIDDEN, 2, 1))
    codes[layer.classes < 0] = -1
    colours = {"reached": "#a6d8b0", "not reached": "#e08a80", "no room to stand": "#4d4d4d"}
    _paint_codes(codes, colours, layer, axes)


def _paint_classes(layer: LayerMap, axes: Any) -> None:
    _paint_codes(layer.classes, CLASSES, layer, axes)


def _paint_path(layer: LayerMap, axes: Any) -> None:
    cut_off = np.where(np.isinf(layer.distance), 0, -1)
    _paint_codes(cut_off, {"no path to the goal": "#c9c9c9"}, layer, axes)
    known = np.where(np.isfinite(layer.distance), layer.distance, np.nan)
    _paint_measure(known, "path length to the goal, m", "YlGnBu_r", layer, axes)
    here = layer.path_layers == layer.number
    for k in range(len(layer.path) - 1):
        style = {"lw": 2.2} if here[k] or here[k + 1] else {"lw": 1.2, "ls": (0, (2, 2))}
        axes.plot(*layer.path[k : k + 2].T, color=_PATH, **style)
    for end, marker, size in ((0, "o", 8), (-1, "*", 15)):
        if len(layer.path):
            fill = _PATH if here[end] else _NOTHING
            axes.plot(*layer.path[end], marker, ms=size, mfc=fill, mec="black", mew=0.8)


_SUBJECTS: Final = {
    "heights": ("heights", _paint_heights),
    "reachability": ("reachability from the spawns", _paint_reachability),
    "classes": ("classes", _paint_classes),
    "path": ("potential and path ({path})", _paint_path),
}


def _paint_measure(values: Floats, caption: str, colours: Any, layer: LayerMap, axes: Any) -> None:
    """Paint values in metres as shades, with a colour bar."""
    known = values[np.isfinite(values)]
    if not len(known):
        return
    low, high = float(known.min()), float(known.max())
    image = axes.imshow(
        values,
        origin="lower",
        extent=layer.extent,
        cmap=colours,
        vmin=low,
        vmax=max(high, low + 0.1),
        interpolation="nearest",
    )
    bar = axes.figure.colorbar(image, cax=axes.inset_axes((1.03, 0.2, 0.03, 0.55)))
    bar.set_label(caption, fontsize=8)
    bar.ax.tick_params(labelsize=7)


def _paint_codes(
    codes: NDArray[np.integer], colours: Mapping[str, str], layer: LayerMap, axes: Any
) -> None:
    """Paint codes 0, 1, ... in the colours of the names; the legend has their shares of the
    floor."""
    palette = import_module("matplotlib.colors").ListedColormap(list(colours.values()))
    axes.imshow(
        np.ma.masked_less(codes, 0),
        origin="lower",
        extent=layer.extent,
        cmap=palette,
        vmin=-0.5,
        vmax=len(colours) - 0.5,
        interpolation="nearest",
    )
    patch = import_module("matplotlib.patches").Patch
    floor = max(1, int(np.isfinite(layer.floors).sum()))
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
        title=layer.body,
        title_fontsize=8,
        alignment="left",
    )


def _add_markers(layer: LayerMap, axes: Any) -> None:
    outline = import_module("matplotlib.patheffects").withStroke(linewidth=2.0, foreground="white")
    for marker in layer.markers:
        axes.plot(*marker.position, "^" if marker.spawn else ".", color="black", ms=7, mec="white")
        axes.annotate(
            marker.name,
            marker.position,
            xytext=(0, 5),
            textcoords="offset points",
            ha="center",
            fontsize=7,
            path_effects=[outline],
            annotation_clip=True,
        )


def _add_scale(layer: LayerMap, axes: Any) -> None:
    """Add a scale bar of a round length, at most a fifth of the width of the picture."""
    most = 0.2 * (layer.extent[1] - layer.extent[0])
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

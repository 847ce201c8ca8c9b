"""Pictures of painted shapes as SVG or PDF: the same polygons, lines and words, without pixels."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from importlib import import_module
from itertools import count, groupby
from pathlib import Path
from typing import Any, Final, NamedTuple

from esplanade.commandline.pictures import save

Point = tuple[float, float]
_DOTS_AN_INCH: Final = 100.0
_POINTS_AN_INCH: Final = 72.0


class Shape(NamedTuple):
    """A polygon, a line where `width` is given, or words at its one point, where `text` is.

    Points are in pixels from the upper left corner of a panel.
    """

    points: Sequence[Point]
    colour: Any
    width: float = 0.0
    """Of a line, or the height of letters, in pixels."""
    text: str = ""


class Panel(NamedTuple):
    """A part of a picture: its upper left corner and size in pixels, and what is painted there."""

    corner: Point
    size: Point
    background: Any
    shapes: Sequence[Shape]


def write_shapes(path: Path, size: Point, panels: Sequence[Panel]) -> None:
    """Write panels as a picture of that size in pixels, of which a hundred are an inch."""
    figure_of = import_module("matplotlib.figure").Figure
    patches = import_module("matplotlib.patches")
    figure = figure_of(figsize=(size[0] / _DOTS_AN_INCH, size[1] / _DOTS_AN_INCH))
    axes = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    axes.set(xlim=(0.0, size[0]), ylim=(size[1], 0.0))
    axes.axis("off")
    order = count(1)
    for corner, (width, height), background, shapes in panels:
        frame = patches.Rectangle(corner, width, height, color=_hex(background), linewidth=0)
        axes.add_patch(frame)
        frame.set_zorder(0)
        # Later shapes lie on earlier ones, whatever kind they are.
        for kind, alike in groupby(shapes, _kind):
            for made in _DRAWN[kind](axes, corner, list(alike)):
                made.set(clip_path=frame, zorder=next(order))
    with import_module("matplotlib").rc_context({"svg.hashsalt": "esplanade"}):
        save(figure, path)


def _kind(shape: Shape) -> str:
    """Shapes of a kind that follow each other are drawn at once, which is much faster."""
    return "text" if shape.text else "line" if shape.width else "polygon"


def _polygons(axes: Any, corner: Point, shapes: Sequence[Shape]) -> Iterator[Any]:
    made = import_module("matplotlib.collections").PolyCollection(
        [_moved(shape, corner) for shape in shapes],
        facecolors=[_hex(shape.colour) for shape in shapes],
        linewidths=0,
    )
    yield axes.add_collection(made, autolim=False)


def _lines(axes: Any, corner: Point, shapes: Sequence[Shape]) -> Iterator[Any]:
    made = import_module("matplotlib.collections").LineCollection(
        [_moved(shape, corner) for shape in shapes],
        colors=[_hex(shape.colour) for shape in shapes],
        linewidths=[_points(shape.width) for shape in shapes],
    )
    yield axes.add_collection(made, autolim=False)


def _words(axes: Any, corner: Point, shapes: Sequence[Shape]) -> Iterator[Any]:
    for shape in shapes:
        ((x, y),) = _moved(shape, corner)
        size = _points(shape.width)
        yield axes.text(x, y, shape.text, color=_hex(shape.colour), va="top", fontsize=size)


_DRAWN: Final = {"polygon": _polygons, "line": _lines, "text": _words}


def _moved(shape: Shape, corner: Point) -> list[Point]:
    return [(x + corner[0], y + corner[1]) for x, y in shape.points]


def _points(pixels: float) -> float:
    return pixels * _POINTS_AN_INCH / _DOTS_AN_INCH


def _hex(colour: Any) -> str:
    if isinstance(colour, str):
        return colour
    red, green, blue = colour
    return f"#{red:02x}{green:02x}{blue:02x}"

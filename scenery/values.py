"""Bodies and points as they are written on the command line."""

import argparse
import math
from typing import Final, NamedTuple

PRESETS: Final = ("adult", "child")
_MEASURES: Final = {
    "radius": "radius_m",
    "height": "height_m",
    "step": "step_on_m",
    "leg": "leg_length_m",
    "edge": "edge_cells",
}

UNITS: Final = {
    "m": 1.0, "dm": 0.1, "cm": 0.01, "mm": 0.001, "km": 1000.0, "ft": 0.3048, "in": 0.0254,
    "yd": 0.9144,
}  # fmt: skip
"""Metres in each unit of length that `--unit` takes."""

Point = tuple[float, float, float]
"""x, y, z in metres."""
Where = str | Point
"""The name of a place, or a point."""


class BodyWish(NamedTuple):
    """A preset, and the measures that differ from it; `esplanade.scenery.bodies` makes the body."""

    preset: str
    changes: dict[str, float | int]


def body(text: str) -> BodyWish:
    """A preset, or measures that differ from it."""
    first, *others = text.split(",")
    preset, measures = ("adult", [first, *others]) if "=" in first else (first, others)
    if preset not in PRESETS:
        raise argparse.ArgumentTypeError(f"{preset!r} is no body; there are {', '.join(PRESETS)}")
    changes: dict[str, float | int] = {}
    for measure in measures:
        name, _, number = measure.partition("=")
        if name not in _MEASURES:
            raise argparse.ArgumentTypeError(
                f"{name!r} is no measure; there are {', '.join(_MEASURES)}"
            )
        try:
            changes[_MEASURES[name]] = int(number) if name == "edge" else float(number)
        except ValueError:
            raise argparse.ArgumentTypeError(f"{name}: {number!r} is no number") from None
    return BodyWish(preset, changes)


def where(text: str) -> Where:
    """A point if it looks like one, else a name."""
    return point(text) if text.count(",") == 2 else text


def point(text: str) -> Point:
    """x, y, z in metres."""
    try:
        x, y, z = (float(part) for part in text.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(f"{text!r} is not X,Y,Z in metres") from None
    if not all(math.isfinite(part) for part in (x, y, z)):
        raise argparse.ArgumentTypeError(f"{text!r} is not finite")
    return x, y, z

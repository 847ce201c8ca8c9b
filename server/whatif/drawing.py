"""Plots of a what-if as SVG, in the colours of the page: differences by seed, and over time."""

import math
from collections.abc import Sequence
from html import escape
from typing import Final

import numpy as np
from numpy.typing import NDArray

from esplanade.server.whatif.comparison import Row, Strip

Floats = NDArray[np.float64]

_WIDTH: Final = 400
_HEIGHT: Final = 74
_LEFT: Final = 16
_STRIP_WIDTH: Final = 1140
_STRIP_LEFT: Final = 64
_STRIP_HEIGHT: Final = 120


def by_seed(row: Row, told: str) -> str:
    """The difference of each seed as a point, and their mean with its interval below."""
    values = row.changed - row.unchanged
    values = values[np.isfinite(values)]
    bounds = [0.0, *values.tolist(), *(b for b in row.difference.interval if math.isfinite(b))]
    low, high = min(bounds), max(bounds)
    scale = (_WIDTH - 2 * _LEFT) / ((high - low) or 1.0)

    def x(value: float) -> str:
        return f"{_LEFT + scale * (value - low):.1f}"

    name, digits = escape(row.measure.label), row.measure.digits
    points = "".join(f'<circle class="dot c1" cx="{x(v)}" cy="44" r="2.5"/>' for v in values)
    mean, interval = row.difference.mean, row.difference.interval
    line = ""
    if math.isfinite(interval.low):
        line = f'<path class="line c0" d="M{x(interval.low)} 60H{x(interval.high)}"/>'
    return (
        f'<svg viewBox="0 0 {_WIDTH} {_HEIGHT}" role="img" aria-label="{name}">'
        f'<text class="title" x="8" y="16">{name}</text>'
        f'<text class="mark" x="{_LEFT}" y="32">{low:+.{digits}f}</text>'
        f'<text class="mark y" x="{_WIDTH - _LEFT}" y="32">{high:+.{digits}f}</text>'
        f'<path class="grid" d="M{x(0.0)} 36V68"/>{points}{line}'
        f'<circle class="dot c0" cx="{x(mean)}" cy="60" r="4">'
        f"<title>{escape(told)}</title></circle></svg>"
    )


def over_time(found: Strip) -> list[str]:
    """The strip of differences: of people in conflict with actors, and of where actors are."""
    drawn = [
        _strip(
            found,
            "people with a contact ahead, changed less unchanged, s of people in each piece",
            found.conflicts_s,
            (found.low_s, found.high_s),
        )
    ]
    if np.isfinite(found.apart_m).any():
        title = "distance of actors from where they are unchanged, mean m"
        drawn.append(_strip(found, title, found.apart_m))
    return drawn


def _strip(
    found: Strip, title: str, values: Floats, bounds: tuple[Floats, Floats] | None = None
) -> str:
    """A bar for each piece from 0 to its value; a line over it is the interval."""
    shown = [values, *(bounds or ())]
    known = [each[np.isfinite(each)] for each in shown]
    low = min(0.0, *(float(each.min(initial=0.0)) for each in known))
    high = max(0.0, *(float(each.max(initial=0.0)) for each in known))
    top, floor = 28.0, _STRIP_HEIGHT - 22.0
    scale = (floor - top) / ((high - low) or 1.0)
    wide = (_STRIP_WIDTH - _STRIP_LEFT - 8) / len(values)

    def y(value: float) -> float:
        return floor - scale * (value - low)

    sign = "+" if low < 0.0 or bounds is not None else ""
    drawn = [
        f'<svg viewBox="0 0 {_STRIP_WIDTH} {_STRIP_HEIGHT}" role="img" aria-label="{title}">',
        f'<text class="title" x="8" y="16">{title}</text>',
        f'<text class="mark y" x="{_STRIP_LEFT - 6}" y="{y(high) + 4:.1f}">{high:{sign}.2f}</text>',
    ]
    if low < 0.0:
        drawn.append(
            f'<text class="mark y" x="{_STRIP_LEFT - 6}" y="{y(low) + 4:.1f}">{low:+.2f}</text>'
        )
    for k, value in enumerate(values.tolist()):
        left, at_s = _STRIP_LEFT + wide * k, found.begins_s[k]
        middle = left + 0.5 * wide
        if math.isfinite(value):
            drawn.append(
                f'<path class="line c{int(value > 0.0)}" style="stroke-width:{0.7 * wide:.1f}" '
                f'd="M{middle:.1f} {y(0.0):.1f}V{y(value):.1f}"/>'
            )
        told = f"{at_s:.0f} s: {value:{sign}.2f}"
        if bounds is not None and math.isfinite(bounds[0][k]):
            ends = bounds[0][k], bounds[1][k]
            told += f" ({ends[0]:+.2f} to {ends[1]:+.2f})"
            drawn.append(
                f'<path class="error" d="M{middle:.1f} {y(ends[0]):.1f}V{y(ends[1]):.1f}"/>'
            )
        drawn.append(
            f'<rect class="hover" x="{left:.1f}" y="{top}" width="{wide:.1f}" '
            f'height="{floor - top}"><title>{told}</title></rect>'
        )
    drawn.append(f'<path class="grid" d="M{_STRIP_LEFT} {y(0.0):.1f}H{_STRIP_WIDTH - 8}"/>')
    drawn += _times(found, wide)
    return "".join([*drawn, "</svg>"])


def _times(found: Strip, wide: float) -> Sequence[str]:
    """Six marks of time along the strip; the last one ends with it."""
    pieces = len(found.begins_s)
    marks = sorted({round(pieces * share / 5) for share in range(6)})
    return [
        f'<text class="mark {"y" if k == pieces else "x"}" x="{_STRIP_LEFT + wide * k:.1f}" '
        f'y="{_STRIP_HEIGHT - 6}">{k * found.piece_s:.0f} s</text>'
        for k in marks
    ]

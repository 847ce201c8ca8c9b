"""A plot of one figure of several policies as SVG in a page: a point and its interval for each."""

import math
from collections.abc import Sequence
from html import escape
from typing import Final

from esplanade.evaluation.cells import number
from esplanade.evaluation.tables import Cell

_WIDTH: Final = 400
_LEFT: Final = 140
_RIGHT: Final = 375
_TOP: Final = 44
_ROW: Final = 24


def draw(policies: Sequence[str], heading: str, cells: Sequence[Cell]) -> str:
    """The plot, in the colours of the page; of differences, a line shows where 0 is."""
    compared = any(cell.differs is not None for cell in cells)
    bounds = [0.0] if compared else []
    for cell in cells:
        known = (cell.value, *(cell.interval or ()))
        bounds += [bound for bound in known if math.isfinite(bound)]
    low, high = min(bounds, default=0.0), max(bounds, default=1.0)
    scale = (_RIGHT - _LEFT) / ((high - low) or 1.0)

    def x(value: float) -> str:
        return f"{_LEFT + scale * (value - low):.1f}"

    name, height, digits = escape(heading.strip()), _TOP + _ROW * len(cells) + 8, cells[0].digits
    drawn = [
        f'<svg viewBox="0 0 {_WIDTH} {height}" role="img" aria-label="{name}">',
        f'<text class="title" x="8" y="16">{name}</text>',
        f'<text class="mark x" x="{x(low)}" y="34">{number(low, digits)}</text>',
        f'<text class="mark x" x="{x(high)}" y="34">{number(high, digits)}</text>',
    ]
    if compared:
        drawn.append(f'<path class="grid" d="M{x(0.0)} {_TOP - 4}V{height - 8}"/>')
    for k, (policy, cell) in enumerate(zip(policies, cells, strict=True)):
        y = f"{_TOP + _ROW * (k + 0.5):.1f}"
        told = f"{escape(policy)}: {escape(cell.text)}"
        drawn.append(f'<text class="mark" x="8" y="{y}" dy="4">{escape(policy)}</text>')
        if cell.interval and math.isfinite(cell.interval.low):
            ends = f"M{x(cell.interval.low)} {y}H{x(cell.interval.high)}"
            drawn.append(f'<path class="line c0" d="{ends}"/>')
        if math.isfinite(cell.value):
            point = f'<circle class="dot c0" cx="{x(cell.value)}" cy="{y}" r="4">'
            drawn.append(f"{point}<title>{told}</title></circle>")
    return "".join([*drawn, "</svg>"])

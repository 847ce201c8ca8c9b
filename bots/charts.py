"""Charts of values over time, drawn as SVG that stands in a page without any script."""

import math
from collections.abc import Sequence
from html import escape
from typing import Final, NamedTuple

WIDTH: Final = 640.0
HEIGHT: Final = 240.0
LEFT: Final = 58.0
RIGHT: Final = 12.0
TOP: Final = 30.0
BOTTOM: Final = 26.0

LOG_FROM: Final = 30.0
"""Values whose greatest is this many times the least positive one are drawn on a log scale."""


class Line(NamedTuple):
    """Values of one name, one for each moment; None leaves a gap."""

    name: str
    values: Sequence[float | None]


class Chart(NamedTuple):
    """Lines over the same moments. `step_s` is the time from one moment to the next."""

    title: str
    unit: str
    lines: Sequence[Line]
    step_s: float
    may_be_log: bool = False


class _Scale(NamedTuple):
    """From values to heights in the picture, and the values that are marked."""

    least: float
    most: float
    is_log: bool
    marks: Sequence[float]

    def y(self, value: float) -> float:
        if self.is_log:
            value = max(value, self.least)
            share = math.log(value / self.least) / math.log(self.most / self.least)
        else:
            share = (value - self.least) / (self.most - self.least)
        return HEIGHT - BOTTOM - share * (HEIGHT - TOP - BOTTOM)


def draw(chart: Chart) -> str:
    """The chart as one `svg` element; its colours are classes of the page."""
    moments = max((len(line.values) for line in chart.lines), default=0)
    scale = _scale(chart)
    span_s = max(1, moments) * chart.step_s
    parts = [
        f'<svg viewBox="0 0 {WIDTH:g} {HEIGHT:g}" role="img" aria-label="{escape(chart.title)}">',
        f'<text class="title" x="{LEFT:g}" y="15">{escape(chart.title)}</text>',
        *_marks(scale, chart.unit),
        *_times(span_s),
    ]
    for number, line in enumerate(chart.lines):
        parts += _drawn(line, number, scale, moments)
    parts += _legend(chart.lines)
    parts += _hovers(chart, moments)
    return "\n".join([*parts, "</svg>"])


def nice_marks(most: float, count: int = 4) -> list[float]:
    """Round values from 0 to the first that is not below `most`, about so many."""
    if most <= 0.0:
        return [0.0, 1.0]
    rough = most / count
    power = 10.0 ** math.floor(math.log10(rough))
    step = next(factor * power for factor in (1, 2, 2.5, 5, 10) if factor * power >= rough * 0.999)
    return [step * place for place in range(math.ceil(most / step - 1e-9) + 1)]


def _scale(chart: Chart) -> _Scale:
    values = [value for line in chart.lines for value in line.values if value is not None]
    positive = [value for value in values if value > 0.0]
    if chart.may_be_log and positive and max(positive) > LOG_FROM * min(positive):
        low, high = math.floor(math.log10(min(positive))), math.ceil(math.log10(max(positive)))
        marks = [10.0**power for power in range(low, high + 1)]
        return _Scale(marks[0], marks[-1], True, marks)
    marks = nice_marks(max(values, default=0.0))
    return _Scale(marks[0], marks[-1], False, marks)


def _x(place: float, moments: int) -> float:
    return LEFT + place / max(1, moments) * (WIDTH - LEFT - RIGHT)


def _marks(scale: _Scale, unit: str) -> list[str]:
    parts = []
    for mark in scale.marks:
        y = scale.y(mark)
        parts.append(f'<path class="grid" d="M{LEFT:g} {y:.1f}H{WIDTH - RIGHT:g}"/>')
        parts.append(f'<text class="mark y" x="{LEFT - 6:g}" y="{y + 4:.1f}">{mark:,.6g}</text>')
    parts.append(f'<text class="mark y" x="{LEFT - 6:g}" y="15">{escape(unit)}</text>')
    return parts


def _times(span_s: float) -> list[str]:
    parts = []
    for mark in nice_marks(span_s, 6):
        if mark <= span_s:
            x = LEFT + mark / span_s * (WIDTH - LEFT - RIGHT)
            parts.append(
                f'<text class="mark x" x="{x:.1f}" y="{HEIGHT - 8:g}">{mark:,.6g} s</text>'
            )
    return parts


def _drawn(line: Line, number: int, scale: _Scale, moments: int) -> list[str]:
    """The line through the middles of its moments; a moment between gaps is a dot."""
    runs: list[list[str]] = [[]]
    for place, value in enumerate(line.values):
        if value is None:
            runs.append([])
        else:
            runs[-1].append(f"{_x(place + 0.5, moments):.1f} {scale.y(value):.1f}")
    parts = []
    for run in runs:
        if len(run) > 1:
            parts.append(f'<path class="line c{number}" d="M{"L".join(run)}"/>')
        elif run:
            x, y = run[0].split()
            parts.append(f'<circle class="dot c{number}" cx="{x}" cy="{y}" r="2.5"/>')
    return parts


def _legend(lines: Sequence[Line]) -> list[str]:
    parts, x = [], WIDTH - RIGHT
    for number, line in reversed(list(enumerate(lines))):
        parts.append(f'<text class="mark y" x="{x:.1f}" y="15">{escape(line.name)}</text>')
        x -= 6.3 * len(line.name) + 6.0
        parts.append(f'<path class="line key c{number}" d="M{x - 14:.1f} 11H{x:.1f}"/>')
        x -= 28.0
    return parts


def _hovers(chart: Chart, moments: int) -> list[str]:
    """The values of each moment, shown under the pointer."""
    parts = []
    for place in range(moments):
        told = ", ".join(
            f"{line.name} {line.values[place]:,.4g}"
            for line in chart.lines
            if line.values[place] is not None
        )
        x, width = _x(place, moments), (WIDTH - LEFT - RIGHT) / moments
        parts.append(
            f'<rect class="hover" x="{x:.1f}" y="{TOP:g}" width="{width:.2f}" '
            f'height="{HEIGHT - TOP - BOTTOM:g}"><title>{place * chart.step_s:g} s: '
            f"{escape(told)} {escape(chart.unit)}</title></rect>"
        )
    return parts

"""The results of studies as tables."""

from collections.abc import Sequence
from typing import Any, Final

from rich import box
from rich.console import Console
from rich.table import Table

from esplanade.evaluation.cells import number, with_interval
from esplanade.evaluation.measures import MEASURES, Measure
from esplanade.evaluation.studies.sensitivity import Curve
from esplanade.evaluation.studies.tuning import Tuning
from esplanade.evaluation.studies.variants import Variant
from esplanade.stats import Interval

RANKED_SHOWN: Final = 15
BASELINE: Final = "baseline"
CHOSEN: Final = "settings"
"""The heading of the column whose cells may wrap."""
HELD_OUT_MEASURES: Final = MEASURES[:3]
"""The measures that are shown of a place that was left out; the JSON has all."""


def show_curves(console: Console, curves: Sequence[Curve]) -> None:
    """Print a row for every value, with a star where a measure differs from the baseline.

    Only differences beyond chance have a star: their 95 % interval does not contain 0.
    """
    table = _table("Sensitivity (*: differs from the baseline beyond chance)", "setting", "value")
    for curve in curves:
        for point in curve.points:
            here = point.value == curve.baseline
            bounds = map(Interval, point.lows, point.highs)
            cells = (
                cell + ("*" if differs else " ")
                for cell, differs in zip(_cells(point.means, [*bounds]), point.differs, strict=True)
            )
            value = f"{point.value} {BASELINE}" if here else f"{point.value}"
            table.add_row(curve.name if point is curve.points[0] else "", value, *cells)
        table.add_section()
    console.print(table)


def show_tuning(console: Console, tuning: Tuning) -> None:
    """Print the best candidates on all places, then the result of cross-validation."""
    table = _table("Candidates on all places", CHOSEN, "cost")
    for variant, measures, cost in tuning.ranked[:RANKED_SHOWN]:
        table.add_row(
            _describe(variant, tuning),
            number(cost, 2),
            *_cells(measures, tuning.intervals[variant]),
        )
    if len(tuning.ranked) > RANKED_SHOWN:
        table.add_row(f"and {len(tuning.ranked) - RANKED_SHOWN} more")
    console.print(table)
    table = _table(
        "Leave-one-out cross-validation over places",
        "left out",
        CHOSEN,
        "cost",
        BASELINE,
        "least",
        measures=HELD_OUT_MEASURES,
    )
    for fold in tuning.folds:
        table.add_row(
            fold.left_out,
            _describe(fold.chosen, tuning),
            *(number(cost, 2) for cost in (fold.cost, fold.baseline_cost, fold.least_cost)),
            *_cells(fold.measures, fold.intervals)[: len(HELD_OUT_MEASURES)],
        )
    console.print(table)
    best = tuning.ranked[0][0]
    if best == tuning.baseline:
        console.print("No candidate costs less than the baseline.")
    else:
        console.print(
            f"Chosen on all places: {_describe(best, tuning)}. It costs less than the baseline "
            f"in {tuning.confidence_percent:.0f} % of bootstrap resamples."
        )


def _describe(variant: Variant, tuning: Tuning) -> str:
    """A variant in one line, as the options of the command write it."""
    settings = " ".join(f"{name}={value}" for name, value in variant.settings)
    return BASELINE if variant == tuning.baseline else settings


def _table(title: str, *headings: str, measures: Sequence[Measure] = MEASURES) -> Table:
    table = Table(
        title=title,
        title_justify="left",
        box=box.SIMPLE_HEAD,
        collapse_padding=True,
        pad_edge=False,
    )
    for heading in headings:
        chosen = heading == CHOSEN
        table.add_column(heading, no_wrap=not chosen, min_width=20 if chosen else None)
    for measure in measures:
        table.add_column(measure.short, justify="right")
    return table


def _cells(measures: Sequence[float] | Any, intervals: Sequence[Interval]) -> list[str]:
    return [
        with_interval(value, interval, measure.digits)
        for value, interval, measure in zip(measures, intervals, MEASURES, strict=True)
    ]

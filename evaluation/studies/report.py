"""The results of studies as tables."""

import math
from collections.abc import Mapping, Sequence
from typing import Any, Final

from rich import box
from rich.console import Console
from rich.table import Table

from esplanade.evaluation.studies.measures import MEASURES, Measure
from esplanade.evaluation.studies.sensitivity import Curve
from esplanade.evaluation.studies.tuning import Tuning
from esplanade.evaluation.studies.variants import Variant
from esplanade.evaluation.trials import Source

RANKED_SHOWN: Final = 15
BASELINE: Final = "baseline"
CHOSEN: Final = "settings"
"""The heading of the column whose cells may wrap."""
HELD_OUT_MEASURES: Final = MEASURES[:3]
"""The measures that are shown of a recording that was left out; the JSON has all."""


def show_curves(console: Console, curves: Sequence[Curve]) -> None:
    """Print a row for every value, with a star where a measure differs from the baseline.

    Only differences beyond chance have a star: their 95 % interval does not contain 0.
    """
    table = _table("Sensitivity (*: differs from the baseline beyond chance)", "setting", "value")
    for curve in curves:
        for point in curve.points:
            here = point.value == curve.baseline
            cells = (
                _cell(mean, measure.digits) + ("*" if differs else " ")
                for measure, mean, differs in zip(MEASURES, point.means, point.differs, strict=True)
            )
            value = f"{point.value} {BASELINE}" if here else f"{point.value}"
            table.add_row(curve.name if point is curve.points[0] else "", value, *cells)
        table.add_section()
    console.print(table)


def show_tuning(console: Console, tuning: Tuning, names: Mapping[Source, str]) -> None:
    """Print the best candidates on all recordings, then the result of cross-validation."""
    table = _table("Candidates on all recordings", CHOSEN, "cost")
    for variant, measures, cost in tuning.ranked[:RANKED_SHOWN]:
        table.add_row(_describe(variant, tuning), _cell(cost, 2), *_cells(measures))
    if len(tuning.ranked) > RANKED_SHOWN:
        table.add_row(f"and {len(tuning.ranked) - RANKED_SHOWN} more")
    console.print(table)
    table = _table(
        "Leave-one-out cross-validation over recordings",
        "left out",
        CHOSEN,
        "cost",
        BASELINE,
        "least",
        measures=HELD_OUT_MEASURES,
    )
    for fold in tuning.folds:
        table.add_row(
            names[fold.left_out],
            _describe(fold.chosen, tuning),
            *(_cell(cost, 2) for cost in (fold.cost, fold.baseline_cost, fold.least_cost)),
            *_cells(fold.measures)[: len(HELD_OUT_MEASURES)],
        )
    console.print(table)
    best = tuning.ranked[0][0]
    if best == tuning.baseline:
        console.print("No candidate costs less than the baseline.")
    else:
        console.print(
            f"Chosen on all recordings: {_describe(best, tuning)}. It costs less than the baseline "
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
        table.add_column(measure.short, justify="right", no_wrap=True)
    return table


def _cells(measures: Sequence[float] | Any) -> list[str]:
    return [_cell(v, measure.digits) for v, measure in zip(measures, MEASURES, strict=True)]


def _cell(value: float, digits: int) -> str:
    return f"{value:.{digits}f}" if math.isfinite(value) else "–"

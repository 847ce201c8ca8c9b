"""Studies as tables for people."""

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
AS_IS: Final = "as is"
CHOSEN: Final = "settings"
"""This column takes the lines it needs."""
HELD_AGAINST: Final = MEASURES[:3]
"""What is shown of a recording that was left out; the rest is in the JSON."""


def show_curves(console: Console, curves: Sequence[Curve]) -> None:
    """A row for every value; a star where a measure differs from the unchanged beyond chance."""
    table = _table("Sensitivity (*: differs from `as is` beyond chance)", "setting", "value")
    for curve in curves:
        for point in curve.points:
            here = point.value == curve.unchanged
            cells = (
                _cell(mean, measure.digits) + ("*" if differs else " ")
                for measure, mean, differs in zip(MEASURES, point.means, point.differs, strict=True)
            )
            value = f"{point.value} {AS_IS}" if here else f"{point.value}"
            table.add_row(curve.name if point is curve.points[0] else "", value, *cells)
        table.add_section()
    console.print(table)


def show_tuning(console: Console, tuning: Tuning, names: Mapping[Source, str]) -> None:
    """The best candidates on all recordings, then what was chosen without each of them."""
    table = _table("Candidates on all recordings", CHOSEN, "cost")
    for variant, measures, cost in tuning.ranked[:RANKED_SHOWN]:
        table.add_row(_told(variant, tuning), _cell(cost, 2), *_cells(measures))
    if len(tuning.ranked) > RANKED_SHOWN:
        table.add_row(f"and {len(tuning.ranked) - RANKED_SHOWN} more")
    console.print(table)
    table = _table(
        "Chosen without one recording, held against that one",
        "left out",
        CHOSEN,
        "cost",
        "as is",
        "least",
        measures=HELD_AGAINST,
    )
    for fold in tuning.folds:
        table.add_row(
            names[fold.left_out],
            _told(fold.chosen, tuning),
            *(_cell(cost, 2) for cost in (fold.cost, fold.unchanged_cost, fold.least_cost)),
            *_cells(fold.measures)[: len(HELD_AGAINST)],
        )
    console.print(table)
    best = tuning.ranked[0][0]
    if best == tuning.unchanged:
        console.print(f"No candidate costs less than `{AS_IS}`.")
    else:
        sure = f"in {tuning.sure_percent:.0f} % of draws of episodes"
        console.print(
            f"Chosen on all recordings: {_told(best, tuning)}; costs less than `{AS_IS}` {sure}."
        )


def _told(variant: Variant, tuning: Tuning) -> str:
    """A variant in one line, as options of the command say it."""
    settings = " ".join(f"{name}={value}" for name, value in variant.settings)
    return AS_IS if variant == tuning.unchanged else settings


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

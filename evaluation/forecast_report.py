"""Reports of how good predictions are: tables, and one object for JSON."""

import math
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any, Final, NamedTuple

from rich import box
from rich.console import Console
from rich.table import Table

from esplanade.evaluation.calibration import (
    COVERAGE_LEVELS,
    HORIZONS_S,
    ForecastScore,
    pool,
    score_forecasts,
)
from esplanade.evaluation.fits import Fits, Growth, LeaveOneOutFit, fit_each
from esplanade.evaluation.forecasts import Forecasts, forecast
from esplanade.planning import GAUSSIAN, PredictionModel, Spread
from esplanade.recordings import Crowd, Obstacles

MODELS: Final = {
    "default": PredictionModel(),
    "one Gaussian": PredictionModel(spread=GAUSSIAN),
    "the same deviation for everyone": PredictionModel(calibration_s=math.inf),
    "eq. (1) as printed": PredictionModel(printed=True),
}
POOLED: Final = "all together"
NOTHING: Final = "nothing"


class ForecastRow(NamedTuple):
    """The score of one prediction model on one recording."""

    recording: str
    model: str
    score: ForecastScore


def measure(
    crowds: Sequence[tuple[str, Crowd, Obstacles]], sample_s: float, *, fit: bool
) -> tuple[list[ForecastRow], Fits]:
    """Score every model on every recording, and fit error distributions if `fit` is set.

    People who are not recorded for long enough do not count.
    """
    rows: list[ForecastRow] = []
    by_model: dict[str, list[tuple[str, Forecasts]]] = {name: [] for name in MODELS}
    for recording, crowd, obstacles in crowds:
        for model, constants in MODELS.items():
            found = forecast(crowd, obstacles, constants, sample_s)
            if len(found.errors):
                by_model[model].append((recording, found))
                rows.append(ForecastRow(recording, model, score_forecasts(found, constants.spread)))
    for model, parts in by_model.items():
        if len(parts) > 1:
            pooled = pool([found for _, found in parts])
            rows.append(ForecastRow(POOLED, model, score_forecasts(pooled, MODELS[model].spread)))
    used = MODELS["default"].spread
    return rows, fit_each(by_model["default"], used) if fit else Fits()


def show(console: Console, rows: Sequence[ForecastRow], fits: Fits) -> None:
    """Print one table for each model, with a column for each recording, then the fits."""
    for model in MODELS:
        shown = {row.recording: row.score for row in rows if row.model == model}
        table = Table(title=f"Prediction, {model}", title_justify="left", box=box.SIMPLE_HEAD)
        table.add_column("", no_wrap=True)
        for recording in shown:
            table.add_column(recording, justify="right", overflow="fold")
        for heading, *cells in zip(*(_lines(score) for score in shown.values()), strict=True):
            table.add_row(heading[0], *(cell for _, cell in (heading, *cells)))
        console.print(table)
    if fits.growths:
        console.print(_growth_table(fits.growths))
    if fits.spreads:
        console.print(_spread_table(fits.spreads))


def _lines(score: ForecastScore) -> list[tuple[str, str]]:
    """The headings and cells of one column."""
    errors = zip(HORIZONS_S, score.ade_m, score.fde_m, strict=True)
    return [
        ("predictions", f"{score.forecasts}"),
        *((f"ADE/FDE at {s} s, m", f"{average:.2f}/{final:.2f}") for s, average, final in errors),
        ("neg. log-likelihood", f"{score.negative_log_likelihood:.2f}"),
        *(
            (f"% in the {circle:.0%} circle", f"{100.0 * coverage:.1f}")
            for circle, coverage in zip(COVERAGE_LEVELS, score.coverage, strict=True)
        ),
    ]


def _growth_table(fits: Sequence[LeaveOneOutFit[Growth]]) -> Table:
    headings = ("sigma_0, m", "growth, m/s", "neg. log-likelihood", "each their own")
    table = _table("Fitted deviation, the same for everyone", headings)
    for row in fits:
        values = (row.fit.sigma_0_m, row.fit.growth_mps, *row[2:])
        table.add_row(row.left_out or NOTHING, *(f"{value:.3f}" for value in values))
    return table


def _spread_table(fits: Sequence[LeaveOneOutFit[Spread]]) -> Table:
    headings = ("narrow", "weight", "wide", "weight", "neg. log-likelihood", "by default")
    table = _table("Fitted spread of those who moved, in deviations", headings)
    for row in fits:
        parts = [value for part in row.fit.parts for value in part]
        values = (*parts, *row[2:])
        table.add_row(row.left_out or NOTHING, *(f"{value:.3f}" for value in values))
    return table


def _table(title: str, headings: Sequence[str]) -> Table:
    table = Table("left out", title=title, title_justify="left", box=box.SIMPLE_HEAD)
    for heading in headings:
        table.add_column(heading, justify="right")
    return table


def figures(rows: Sequence[ForecastRow], fits: Fits, sample_s: float) -> dict[str, Any]:
    """All scores and fits, ready for JSON."""
    return {
        "settings": {"sample_s": sample_s, "horizons_s": HORIZONS_S, "circles": COVERAGE_LEVELS},
        "predictions": [
            {"recording": row.recording, "model": row.model, **asdict(row.score)} for row in rows
        ],
        "fitted_deviations": [_figures_of(row) for row in fits.growths],
        "fitted_spreads": [_figures_of(row) for row in fits.spreads],
    }


def _figures_of(row: LeaveOneOutFit[Growth] | LeaveOneOutFit[Spread]) -> dict[str, Any]:
    return {
        "left_out": row.left_out,
        **asdict(row.fit),
        "negative_log_likelihood": row.negative_log_likelihood,
        "default_negative_log_likelihood": row.default_negative_log_likelihood,
    }

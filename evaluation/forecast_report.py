"""Predictions as tables, and as one object for programs."""

import math
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any, Final, NamedTuple

from rich import box
from rich.console import Console
from rich.table import Table

from evaluation.calibration import (
    HORIZONS_S,
    SHARES,
    Fit,
    ForecastScore,
    fit_deviation,
    negative_log_likelihood,
    pool,
    score_forecasts,
)
from evaluation.forecasts import Forecasts, forecast
from planning import PredictionModel
from recordings import Crowd, Obstacles

MODELS: Final = {
    "default": PredictionModel(),
    "the same deviation for everyone": PredictionModel(calibration_s=math.inf),
    "eq. (1) as printed": PredictionModel(printed=True),
}
POOLED: Final = "all together"


class Row(NamedTuple):
    """One line of the result."""

    recording: str
    model: str
    score: ForecastScore


class FitRow(NamedTuple):
    """A deviation fitted to all recordings but one, held against that one."""

    left_out: str
    fit: Fit
    fitted: float
    """Negative log-likelihood of the one left out, with the fit."""
    default: float
    """The same with the model's own deviations."""


def measure(
    crowds: Sequence[tuple[str, Crowd, Obstacles]], sample_s: float, *, fit: bool
) -> tuple[list[Row], list[FitRow]]:
    """Every model on every recording; who is not followed for long enough does not count."""
    rows: list[Row] = []
    by_model: dict[str, list[tuple[str, Forecasts]]] = {name: [] for name in MODELS}
    for recording, crowd, obstacles in crowds:
        for model, constants in MODELS.items():
            found = forecast(crowd, obstacles, constants, sample_s)
            if len(found.errors):
                by_model[model].append((recording, found))
                rows.append(Row(recording, model, score_forecasts(found)))
    for model, parts in by_model.items():
        if len(parts) > 1:
            pooled = pool([found for _, found in parts])
            rows.append(Row(POOLED, model, score_forecasts(pooled)))
    return rows, _fits(by_model["default"]) if fit else []


def _fits(parts: Sequence[tuple[str, Forecasts]]) -> list[FitRow]:
    """With one recording, the fit is to it; with several, also to all but each."""
    if not parts:
        return []
    everything = pool([found for _, found in parts])
    chosen = fit_deviation([found for _, found in parts])
    rows = []
    for name, found in parts if len(parts) > 1 else ():
        others = fit_deviation([other for other_name, other in parts if other_name != name])
        rows.append(_held_against(name, others, found))
    return [*rows, _held_against("nothing", chosen, everything)]


def _held_against(left_out: str, fit: Fit, found: Forecasts) -> FitRow:
    return FitRow(
        left_out,
        fit,
        negative_log_likelihood(found, fit.sigmas()),
        negative_log_likelihood(found, found.sigmas),
    )


def show(console: Console, rows: Sequence[Row], fits: Sequence[FitRow]) -> None:
    """A table for every model, a column for every recording; then the fits."""
    for model in MODELS:
        shown = {row.recording: row.score for row in rows if row.model == model}
        table = Table(title=f"Prediction, {model}", title_justify="left", box=box.SIMPLE_HEAD)
        table.add_column("", no_wrap=True)
        for recording in shown:
            table.add_column(recording, justify="right")
        for heading, *cells in zip(*(_lines(score) for score in shown.values()), strict=True):
            table.add_row(heading[0], *(cell for _, cell in (heading, *cells)))
        console.print(table)
    if fits:
        console.print(_fit_table(fits))


def _lines(score: ForecastScore) -> list[tuple[str, str]]:
    """Headings and cells of one column."""
    errors = zip(HORIZONS_S, score.average_m, score.final_m, strict=True)
    return [
        ("predictions", f"{score.forecasts}"),
        *((f"ADE/FDE at {s} s, m", f"{average:.2f}/{final:.2f}") for s, average, final in errors),
        ("neg. log-likelihood", f"{score.negative_log_likelihood:.2f}"),
        *(
            (f"% in the {circle:.0%} circle", f"{100.0 * inside:.1f}")
            for circle, inside in zip(SHARES, score.inside, strict=True)
        ),
    ]


def _fit_table(fits: Sequence[FitRow]) -> Table:
    table = Table("left out", title="Fitted deviation", title_justify="left", box=box.SIMPLE_HEAD)
    for heading in ("sigma_0, m", "growth, m/s", "neg. log-likelihood", "by default"):
        table.add_column(heading, justify="right")
    for row in fits:
        values = (row.fit.sigma_0_m, row.fit.growth_mps, row.fitted, row.default)
        table.add_row(row.left_out, *(f"{value:.3f}" for value in values))
    return table


def figures(rows: Sequence[Row], fits: Sequence[FitRow], sample_s: float) -> dict[str, Any]:
    """Everything that was measured, for JSON."""
    return {
        "settings": {"sample_s": sample_s, "horizons_s": HORIZONS_S, "circles": SHARES},
        "predictions": [
            {"recording": row.recording, "model": row.model, **asdict(row.score)} for row in rows
        ],
        "fits": [
            {
                "left_out": None if row.left_out == "nothing" else row.left_out,
                **asdict(row.fit),
                "negative_log_likelihood": row.fitted,
                "default_negative_log_likelihood": row.default,
            }
            for row in fits
        ],
    }

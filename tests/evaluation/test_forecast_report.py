"""Reports of predictions on several recordings, as tables and as JSON."""

import json

from rich.console import Console

from esplanade.evaluation.fits import Fits
from esplanade.evaluation.forecast_report import MODELS, POOLED, ForecastRow, figures, measure, show
from esplanade.planning import PEOPLE
from esplanade.recordings import Crowd, Obstacles
from tests.evaluation.worlds import crowd, walk

SQUARE = crowd(*(walk(str(k), 2.0 * k, (0, 0), (4 + k, 0), (4 + k, 12)) for k in range(3)))
LANE = crowd(walk("1", 0.0, (0, 0), (9, 3), (12, 12)), walk("2", 1.0, (30, 0), (0, 0)))


def measured(*crowds: tuple[str, Crowd], fit: bool) -> tuple[list[ForecastRow], Fits]:
    return measure([(name, people, Obstacles()) for name, people in crowds], 0.4, fit=fit)


def test_every_model_is_held_against_every_recording_and_all_together() -> None:
    rows, fits = measured(("square", SQUARE), ("lane", LANE), fit=False)
    assert {(row.recording, row.model) for row in rows} == {
        (recording, model) for recording in ("square", "lane", POOLED) for model in MODELS
    }
    assert fits == Fits()
    by_model = {row.model: row.score for row in rows if row.recording == POOLED}
    ours, even = by_model["default"], by_model["one Gaussian"]
    assert ours.fde_m == even.fde_m
    assert ours.negative_log_likelihood != even.negative_log_likelihood


def test_tables_and_figures_tell_the_same() -> None:
    rows, fits = measured(("square", SQUARE), ("lane", LANE), fit=True)
    console = Console(record=True, width=120)
    show(console, rows, fits)
    shown = console.export_text()
    for model in MODELS:
        assert f"Prediction, {model}" in shown
    told = json.loads(json.dumps(figures(rows, fits, 0.4)))
    assert [row["left_out"] for row in told["fitted_spreads"]] == ["square", "lane", None]
    for fitted in told["fitted_spreads"]:
        assert len(fitted["scales"]) == len(PEOPLE.scales)
        assert f"{fitted['scales'][0]:.3f}" in shown
        assert f"{fitted['negative_log_likelihood']:.3f}" in shown
    for fitted in told["fitted_deviations"]:
        assert f"{fitted['growth_mps']:.3f}" in shown


def test_a_recording_too_short_to_judge_has_no_column() -> None:
    short = crowd(walk("1", 0.0, (0, 0), (3, 0)))
    rows, _ = measured(("square", SQUARE), ("short", short), fit=True)
    assert {row.recording for row in rows} == {"square"}

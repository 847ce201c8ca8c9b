"""Scores of predictions: how accurate they are, and how well their uncertainty is calibrated."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.forecasts import STEP_S, Forecasts
from esplanade.planning import Spread

Floats = NDArray[np.float64]

HORIZONS_S: Final = (1.2, 2.4, 4.8)
COVERAGE_LEVELS: Final = (0.5, 0.9, 0.95)


@dataclass(frozen=True)
class ForecastScore:
    """The accuracy and calibration of a set of predictions."""

    forecasts: int
    """The number of predictions."""
    ade_m: tuple[float, ...]
    """Average displacement error: the mean distance over all steps up to each of `HORIZONS_S`."""
    fde_m: tuple[float, ...]
    """Final displacement error: the mean distance at each of `HORIZONS_S`."""
    negative_log_likelihood: float
    """The mean over all steps; the density is in 1/m²."""
    coverage: tuple[float, ...]
    """The share of positions inside the circle that is predicted to hold each of
    `COVERAGE_LEVELS`, over all steps."""


def score_forecasts(forecasts: Forecasts, spread: Spread) -> ForecastScore:
    """Score at least one prediction; `spread` is the predicted distribution of the errors."""
    distances = np.linalg.norm(forecasts.errors, axis=2)
    by_step = distances.mean(axis=0)
    steps = [round(horizon_s / STEP_S) for horizon_s in HORIZONS_S]
    normalised = distances / forecasts.sigmas
    return ForecastScore(
        forecasts=len(distances),
        ade_m=tuple(float(by_step[:step].mean()) for step in steps),
        fde_m=tuple(float(by_step[step - 1]) for step in steps),
        negative_log_likelihood=negative_log_likelihood(forecasts, forecasts.sigmas, spread),
        coverage=tuple(
            float(np.mean(normalised <= spread.radius_of(level))) for level in COVERAGE_LEVELS
        ),
    )


def pool(forecasts: Sequence[Forecasts]) -> Forecasts:
    """Concatenate the predictions of several recordings."""
    return Forecasts(
        np.concatenate([f.errors for f in forecasts]), np.concatenate([f.sigmas for f in forecasts])
    )


def negative_log_likelihood(forecasts: Forecasts, sigmas: Floats, spread: Spread) -> float:
    """Mean negative log-likelihood of the recorded positions under the predicted density.

    The density is eq. (4) of Lei & Li in the plane, or a mixture of such Gaussians. `sigmas` are
    deviations in metres that broadcast to (F, STEPS).
    """
    return float(-np.mean(spread.log_density(forecasts.errors, sigmas)))

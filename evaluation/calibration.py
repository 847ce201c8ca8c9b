"""How good predictions are, and how well they know it."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.forecasts import STEP_S, Forecasts
from esplanade.planning import Spread

Floats = NDArray[np.float64]

HORIZONS_S: Final = (1.2, 2.4, 4.8)
SHARES: Final = (0.5, 0.9, 0.95)


@dataclass(frozen=True)
class ForecastScore:
    """How predictions held. One value for each of `HORIZONS_S`, and of `SHARES`."""

    forecasts: int
    average_m: tuple[float, ...]
    """ADE: mean distance over all steps up to the horizon."""
    final_m: tuple[float, ...]
    """FDE: mean distance at the horizon."""
    negative_log_likelihood: float
    """Mean over all steps, of a density in 1/m²."""
    inside: tuple[float, ...]
    """Share of people inside the circle that should hold this share, over all steps."""


def score_forecasts(forecasts: Forecasts, spread: Spread) -> ForecastScore:
    """Put predictions together, at least one, whose errors are expected to be so spread."""
    distances = np.linalg.norm(forecasts.errors, axis=2)
    by_step = distances.mean(axis=0)
    steps = [round(horizon_s / STEP_S) for horizon_s in HORIZONS_S]
    strayed = distances / forecasts.sigmas
    return ForecastScore(
        forecasts=len(distances),
        average_m=tuple(float(by_step[:step].mean()) for step in steps),
        final_m=tuple(float(by_step[step - 1]) for step in steps),
        negative_log_likelihood=negative_log_likelihood(forecasts, forecasts.sigmas, spread),
        inside=tuple(float(np.mean(strayed <= spread.radius_of(share))) for share in SHARES),
    )


def pool(forecasts: Sequence[Forecasts]) -> Forecasts:
    """Predictions of several recordings as one."""
    return Forecasts(
        np.concatenate([f.errors for f in forecasts]), np.concatenate([f.sigmas for f in forecasts])
    )


def negative_log_likelihood(forecasts: Forecasts, sigmas: Floats, spread: Spread) -> float:
    """Of eq. (4) in the plane, or of a mixture; deviations broadcast to (F, STEPS)."""
    return float(-np.mean(spread.log_density(forecasts.errors, sigmas)))

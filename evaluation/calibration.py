"""How good predictions are, how sure they may be, and the deviation that suits them best."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import minimize

from evaluation.forecasts import STEP_S, Forecasts, ahead_s

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


def score_forecasts(forecasts: Forecasts) -> ForecastScore:
    """Put predictions together, at least one."""
    distances = np.linalg.norm(forecasts.errors, axis=2)
    by_step = distances.mean(axis=0)
    steps = [round(horizon_s / STEP_S) for horizon_s in HORIZONS_S]
    squares = (distances / forecasts.sigmas) ** 2
    return ForecastScore(
        forecasts=len(distances),
        average_m=tuple(float(by_step[:step].mean()) for step in steps),
        final_m=tuple(float(by_step[step - 1]) for step in steps),
        negative_log_likelihood=negative_log_likelihood(forecasts, forecasts.sigmas),
        inside=tuple(float(np.mean(squares <= -2.0 * np.log(1.0 - share))) for share in SHARES),
    )


def pool(forecasts: Sequence[Forecasts]) -> Forecasts:
    """Predictions of several recordings as one."""
    return Forecasts(
        np.concatenate([f.errors for f in forecasts]), np.concatenate([f.sigmas for f in forecasts])
    )


def negative_log_likelihood(forecasts: Forecasts, sigmas: Floats) -> float:
    """Of even Gaussians in the plane, eq. (4), with deviations that broadcast to (F, STEPS)."""
    squares = (forecasts.errors**2).sum(axis=2)
    return float(np.mean(np.log(2.0 * np.pi * sigmas**2) + squares / (2.0 * sigmas**2)))


@dataclass(frozen=True)
class Fit:
    """Deviation sigma_0 + growth × seconds ahead, eq. (3)."""

    sigma_0_m: float
    growth_mps: float

    def sigmas(self) -> Floats:
        """Deviations of the steps, (STEPS,), metres."""
        return self.sigma_0_m + self.growth_mps * ahead_s()


def fit_deviation(recordings: Sequence[Forecasts]) -> Fit:
    """The most likely deviation. Every recording weighs the same, however many people it has."""

    def mean_cost(logarithms: Floats) -> float:
        sigmas = Fit(*np.exp(logarithms)).sigmas()
        return float(np.mean([negative_log_likelihood(f, sigmas) for f in recordings]))

    found = minimize(mean_cost, np.log([0.05, 0.17]), bounds=[(-9.0, 2.0)] * 2, method="L-BFGS-B")
    sigma_0_m, growth_mps = np.exp(found.x).tolist()
    return Fit(sigma_0_m, growth_mps)

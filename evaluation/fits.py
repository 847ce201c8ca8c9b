"""The errors that suit recorded people best, fitted to recordings and held against others."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final, Generic, NamedTuple, TypeVar

import numpy as np
from scipy.optimize import minimize
from scipy.special import expit

from esplanade.evaluation.calibration import negative_log_likelihood, pool
from esplanade.evaluation.forecasts import Floats, Forecasts, ahead_s
from esplanade.planning import GAUSSIAN, Spread

STOOD_M: Final = 0.01
"""Who is within a centimetre of where they were expected, at every step, has stood."""


@dataclass(frozen=True)
class Growth:
    """Deviation sigma_0 + growth × seconds ahead, eq. (3)."""

    sigma_0_m: float
    growth_mps: float

    def sigmas(self) -> Floats:
        """Deviations of the steps, (STEPS,), metres."""
        return self.sigma_0_m + self.growth_mps * ahead_s()


Fitted = TypeVar("Fitted", Growth, Spread)


class FitRow(NamedTuple, Generic[Fitted]):
    """What was fitted to all recordings but one, held against that one."""

    left_out: str | None
    """None: fitted to all, held against all."""
    fit: Fitted
    fitted: float
    """Negative log-likelihood of what was left out, with the fit."""
    default: float
    """The same with what the fit would replace."""


class Fits(NamedTuple):
    """Fits to all recordings but each in turn, and to all of them."""

    growths: Sequence[FitRow[Growth]] = ()
    """The same for everyone, instead of each person's own; one Gaussian."""
    spreads: Sequence[FitRow[Spread]] = ()
    """Of the errors in each person's own deviations, instead of the default."""


def fit_growth(recordings: Sequence[Forecasts]) -> Growth:
    """The most likely deviation. Every recording weighs the same, however many people it has."""

    def mean_cost(logarithms: Floats) -> float:
        sigmas = Growth(*np.exp(logarithms)).sigmas()
        return float(np.mean([negative_log_likelihood(f, sigmas, GAUSSIAN) for f in recordings]))

    found = minimize(mean_cost, np.log([0.05, 0.17]), bounds=[(-9.0, 2.0)] * 2, method="L-BFGS-B")
    sigma_0_m, growth_mps = np.exp(found.x).tolist()
    return Growth(sigma_0_m, growth_mps)


def fit_spread(recordings: Sequence[Forecasts]) -> Spread:
    """The most likely mixture of two, the narrower first. Every recording weighs the same."""

    def spread_of(free: Floats) -> Spread:
        one, other = np.exp(free[:2]).tolist()
        weight = float(expit(free[2]))
        (narrow, often), (wide, seldom) = sorted([(one, weight), (other, 1.0 - weight)])
        return Spread((narrow, wide), (often, seldom))

    def mean_cost(free: Floats) -> float:
        spread = spread_of(free)
        return float(np.mean([negative_log_likelihood(f, f.sigmas, spread) for f in recordings]))

    start, bounds = [np.log(0.5), np.log(1.5), 0.0], [(-4.0, 3.0), (-4.0, 3.0), (-6.0, 6.0)]
    return spread_of(minimize(mean_cost, start, bounds=bounds, method="L-BFGS-B").x)


def those_who_moved(forecasts: Forecasts) -> Forecasts:
    """Without those who stood.

    Recordings have them stand on one spot. Without any error the narrower the likelier, without
    end: they would tell the spread about drawing, not about walking.
    """
    moved = np.linalg.norm(forecasts.errors, axis=2).max(axis=1, initial=0.0) > STOOD_M
    return Forecasts(forecasts.errors[moved], forecasts.sigmas[moved])


def fit_each(recordings: Sequence[tuple[str, Forecasts]], spread: Spread) -> Fits:
    """Fit to recordings by name, predicted with deviations of each person and with a spread."""

    def growth_row(left_out: str | None, fit: Growth, found: Forecasts) -> FitRow[Growth]:
        own = negative_log_likelihood(found, found.sigmas, GAUSSIAN)
        return FitRow(left_out, fit, negative_log_likelihood(found, fit.sigmas(), GAUSSIAN), own)

    def spread_row(left_out: str | None, fit: Spread, found: Forecasts) -> FitRow[Spread]:
        default = negative_log_likelihood(found, found.sigmas, spread)
        return FitRow(left_out, fit, negative_log_likelihood(found, found.sigmas, fit), default)

    moved = [(name, those_who_moved(found)) for name, found in recordings]
    return Fits(
        [growth_row(*of) for of in _leaving_out(recordings, fit_growth)],
        [
            spread_row(*of)
            for of in _leaving_out([of for of in moved if len(of[1].errors)], fit_spread)
        ],
    )


def _leaving_out(
    recordings: Sequence[tuple[str, Forecasts]], fit: Callable[[Sequence[Forecasts]], Fitted]
) -> list[tuple[str | None, Fitted, Forecasts]]:
    """What is left out, the fit to the others, and what it is held against.

    The last leaves out nothing. With one recording, it is the only one.
    """
    if not recordings:
        return []
    everyone = [found for _, found in recordings]
    rows: list[tuple[str | None, Fitted, Forecasts]] = [
        (name, fit([other for other in everyone if other is not found]), found)
        for name, found in recordings
        if len(recordings) > 1
    ]
    rows.append((None, fit(everyone), pool(everyone)))
    return rows

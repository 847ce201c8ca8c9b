"""Error distributions fitted to recordings by maximum likelihood, with cross-validation."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final, Generic, NamedTuple, TypeVar

import numpy as np
from scipy.optimize import minimize
from scipy.special import expit

from esplanade.evaluation.calibration import negative_log_likelihood, pool
from esplanade.evaluation.forecasts import Floats, Forecasts, ahead_s
from esplanade.planning import GAUSSIAN, Spread

STANDING_M: Final = 0.01
"""People whose error stays below this at every step are taken to have stood still."""


@dataclass(frozen=True)
class Growth:
    """A deviation of sigma_0 + growth × seconds ahead, eq. (3) of Lei & Li."""

    sigma_0_m: float
    growth_mps: float

    def sigmas(self) -> Floats:
        """Deviations at each step ahead, (STEPS,), metres."""
        return self.sigma_0_m + self.growth_mps * ahead_s()


Fitted = TypeVar("Fitted", Growth, Spread)


class LeaveOneOutFit(NamedTuple, Generic[Fitted]):
    """A fit to all recordings but one, tested on the recording that was left out."""

    left_out: str | None
    """The name of the recording; None if the fit was made and tested on all recordings."""
    fit: Fitted
    negative_log_likelihood: float
    """The value of the test recording under the fit."""
    default_negative_log_likelihood: float
    """The value of the test recording under the default distribution."""


class Fits(NamedTuple):
    """Leave-one-out fits; the last one of each kind is to all recordings."""

    growths: Sequence[LeaveOneOutFit[Growth]] = ()
    """Deviations that are the same for everyone, with one Gaussian."""
    spreads: Sequence[LeaveOneOutFit[Spread]] = ()
    """Mixtures for errors that are expressed in each person's own deviation."""


def fit_growth(recordings: Sequence[Forecasts]) -> Growth:
    """Fit the most likely deviation; every recording has the same weight, whatever its size."""

    def mean_cost(logarithms: Floats) -> float:
        sigmas = Growth(*np.exp(logarithms)).sigmas()
        return float(np.mean([negative_log_likelihood(f, sigmas, GAUSSIAN) for f in recordings]))

    found = minimize(mean_cost, np.log([0.05, 0.17]), bounds=[(-9.0, 2.0)] * 2, method="L-BFGS-B")
    sigma_0_m, growth_mps = np.exp(found.x).tolist()
    return Growth(sigma_0_m, growth_mps)


def fit_spread(recordings: Sequence[Forecasts]) -> Spread:
    """Fit the most likely mixture of two Gaussians, the narrower one first.

    Every recording has the same weight, whatever its size.
    """

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


def without_standing(forecasts: Forecasts) -> Forecasts:
    """Leave out the predictions of people who stood still.

    In recordings they stand on exactly one spot. Errors of zero make a mixture the likelier the
    narrower it is, without limit, and say nothing about walking.
    """
    moved = np.linalg.norm(forecasts.errors, axis=2).max(axis=1, initial=0.0) > STANDING_M
    return Forecasts(forecasts.errors[moved], forecasts.sigmas[moved])


def fit_each(recordings: Sequence[tuple[str, Forecasts]], spread: Spread) -> Fits:
    """Fit growths and spreads to named recordings, leaving out each recording in turn.

    The forecasts hold each person's own deviation; `spread` is the default distribution that the
    fitted spreads are compared with.
    """

    def growth_row(left_out: str | None, fit: Growth, found: Forecasts) -> LeaveOneOutFit[Growth]:
        own = negative_log_likelihood(found, found.sigmas, GAUSSIAN)
        return LeaveOneOutFit(
            left_out, fit, negative_log_likelihood(found, fit.sigmas(), GAUSSIAN), own
        )

    def spread_row(left_out: str | None, fit: Spread, found: Forecasts) -> LeaveOneOutFit[Spread]:
        default = negative_log_likelihood(found, found.sigmas, spread)
        return LeaveOneOutFit(
            left_out, fit, negative_log_likelihood(found, found.sigmas, fit), default
        )

    moved = [(name, without_standing(found)) for name, found in recordings]
    return Fits(
        [growth_row(*split) for split in _leave_one_out(recordings, fit_growth)],
        [
            spread_row(*split)
            for split in _leave_one_out([m for m in moved if len(m[1].errors)], fit_spread)
        ],
    )


def _leave_one_out(
    recordings: Sequence[tuple[str, Forecasts]], fit: Callable[[Sequence[Forecasts]], Fitted]
) -> list[tuple[str | None, Fitted, Forecasts]]:
    """The name of each test recording, the fit to the others, and the test recording.

    The last row is fitted to all recordings and tested on all; with one recording it is the only
    row.
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

"""The measures that studies compare: their means over recordings, and bootstrap intervals."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.scores import Score

Floats = NDArray[np.float64]

RESAMPLES: Final = 1000
CONFIDENCE_PERCENT: Final = 95.0


class Measure(NamedTuple):
    """One figure of an episode."""

    name: str
    """The key in JSON."""
    label: str
    """The heading in pictures."""
    short: str
    """The heading in tables."""
    digits: int
    """The digits after the decimal point."""
    goal: float
    """A mean over recordings that is good enough."""
    best: float
    """The best possible value."""
    of: Callable[[Score], float]
    """Gives the figure of an episode; nan if the episode has none."""


MEASURES: Final = (
    Measure("contacts_percent", "contacts, %", "touch %", 1, 1.0, 0.0, lambda s: 100.0 * s.touched),
    Measure("near_s", "within 0.2 m, s", "near s", 3, 0.08, 0.0, lambda s: s.near_s),
    Measure("time_ratio", "time / straight way", "time", 3, 1.09, 1.0, lambda s: s.time_ratio),
    Measure("turn_rms_radps", "turn rate, rad/s", "turn", 2, 0.6, 0.0, lambda s: s.turn_rms_radps),
    Measure(
        "missed_percent", "not arrived, %", "lost %", 1, 0.0, 0.0, lambda s: 100.0 * (not s.reached)
    ),
)


def table(scores: Sequence[Score]) -> Floats:
    """The M measures of E episodes, float64 (E, M)."""
    return np.array([[measure.of(score) for measure in MEASURES] for score in scores])


def named(measures: Floats) -> dict[str, float]:
    """The measures (M,) by their names."""
    return {measure.name: value for measure, value in zip(MEASURES, measures.tolist(), strict=True)}


def mean_over_recordings(tables: Iterable[Floats]) -> Floats:
    """The mean over recordings of the means over their episodes, (M,)."""
    return _even([_means(np.ones((1, len(t))), t)[0] for t in tables])


def bootstrap(tables: Iterable[Floats], seed: int) -> Floats:
    """`mean_over_recordings` of R bootstrap resamples, float64 (R, M).

    Episodes are resampled with replacement within each recording. The same seed and numbers of
    episodes give the same resamples, so that differences between variants are paired.
    """
    rng = np.random.default_rng(seed)
    return _even(
        [_means(rng.multinomial(len(t), np.full(len(t), 1 / len(t)), RESAMPLES), t) for t in tables]
    )


def percentile_interval(resamples: Floats) -> tuple[Floats, Floats]:
    """The bounds, each (...), of the percentile interval that holds 95 % of resamples (R, ...)."""
    tail = (100.0 - CONFIDENCE_PERCENT) / 2.0
    low, high = np.percentile(resamples, [tail, 100.0 - tail], axis=0)
    return low, high


def _even(means: Sequence[Floats]) -> Floats:
    """The mean over recordings, which all have the same weight, (..., M)."""
    return np.asarray(np.mean(means, axis=0))


def _means(counts: NDArray[Any], values: Floats) -> Floats:
    """Means (R, M) of values (E, M) that are weighted by counts (R, E); nan is left out."""
    known = np.isfinite(values)
    with np.errstate(invalid="ignore"):
        return np.asarray(counts @ np.where(known, values, 0.0) / (counts @ known))

"""What studies compare: a few measures, their means over recordings, and how sure those are."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any, Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.scores import Score

Floats = NDArray[np.float64]

RESAMPLES: Final = 1000
CONFIDENCE_PERCENT: Final = 95.0


class Measure(NamedTuple):
    """One figure of an episode; nan where the episode has none."""

    name: str
    label: str
    short: str
    digits: int
    goal: float
    """What is good enough, as a mean over recordings."""
    best: float
    """What could not be better."""
    of: Callable[[Score], float]


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
    """Measures of episodes, (E, M)."""
    return np.array([[measure.of(score) for measure in MEASURES] for score in scores])


def named(measures: Floats) -> dict[str, float]:
    """Measures (M,) by their names."""
    return {measure.name: value for measure, value in zip(MEASURES, measures.tolist(), strict=True)}


def pooled(tables: Iterable[Floats]) -> Floats:
    """The mean over recordings of the means over their episodes, (M,)."""
    return _even([_means(np.ones((1, len(t))), t)[0] for t in tables])


def resampled(tables: Iterable[Floats], seed: int) -> Floats:
    """`pooled` of episodes drawn anew, with replacement and within each recording, (R, M).

    For the same seed and numbers of episodes the same ones are drawn: differences between variants
    are differences on the same episodes.
    """
    rng = np.random.default_rng(seed)
    return _even(
        [_means(rng.multinomial(len(t), np.full(len(t), 1 / len(t)), RESAMPLES), t) for t in tables]
    )


def interval(resamples: Floats) -> tuple[Floats, Floats]:
    """The middle range of resamples (R, ...) that holds 95 % of them."""
    tail = (100.0 - CONFIDENCE_PERCENT) / 2.0
    low, high = np.percentile(resamples, [tail, 100.0 - tail], axis=0)
    return low, high


def _even(means: Sequence[Floats]) -> Floats:
    """Every recording weighs the same."""
    return np.asarray(np.mean(means, axis=0))


def _means(counts: NDArray[Any], values: Floats) -> Floats:
    """Means of values (E, M) that count so often (R, E), leaving out nan; (R, M)."""
    known = np.isfinite(values)
    with np.errstate(invalid="ignore"):
        return np.asarray(counts @ np.where(known, values, 0.0) / (counts @ known))

"""The comparison of runs with a change and without it, seed by seed."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from esplanade.server.whatif.measures import Measure, shown
from esplanade.server.whatif.runs import Run
from esplanade.stats import Difference, Sample, compare, interval_of, resampled_means

Floats = NDArray[np.float64]

RESAMPLING_SEED: Final = 0


@dataclass(frozen=True)
class Row:
    """A figure with and without the change."""

    measure: Measure
    unchanged: Floats
    """(S,): the figure of each run without the change."""
    changed: Floats
    """(S,): the same with the change, by the same seeds."""
    difference: Difference
    """Changed less unchanged."""

    @property
    def means(self) -> tuple[float, float]:
        """The means without the change and with it, over the runs that have the figure."""
        return _mean(self.unchanged), _mean(self.changed)


@dataclass(frozen=True)
class Strip:
    """The distance to which a change carries a world, piece by piece of the stretch."""

    begins_s: Floats
    """(P,): where each piece begins, seconds after the beginning of the stretch."""
    piece_s: float
    conflicts_s: Floats
    """(P,): the mean difference of the seconds that people are in conflict with actors."""
    low_s: Floats
    """(P,): the lower bound of its interval, of each piece by itself; nan with one seed."""
    high_s: Floats
    apart_m: Floats
    """(P,): the mean distance of each actor from where it is without the change; nan for none."""


def compared(unchanged: Sequence[Run], changed: Sequence[Run], *, reacting: bool) -> list[Row]:
    """The rows of all figures; runs stand in the order of their seeds, one at least."""
    measures = shown(reacting=reacting)
    ours, theirs = _values(changed, measures), _values(unchanged, measures)
    # A figure that no pair of runs has is left out, as are those that count for nothing then.
    known = np.isfinite(ours - theirs).any(axis=0)
    seeds = list(range(len(ours)))
    pair = [Sample.of(ours[:, known], seeds)], [Sample.of(theirs[:, known], seeds)]
    differences = compare({"changed": pair}, RESAMPLING_SEED, even=False)["changed"]
    return [
        Row(measures[k], theirs[:, k], ours[:, k], difference)
        for k, difference in zip(np.flatnonzero(known).tolist(), differences, strict=True)
    ]


def strip(unchanged: Sequence[Run], changed: Sequence[Run], duration_s: float) -> Strip:
    """The course of the difference."""
    less = np.array(
        [c.conflicts_s - u.conflicts_s for u, c in zip(unchanged, changed, strict=True)]
    )
    sample = [Sample.of(less, list(range(len(less))))]
    bounds = np.array(interval_of(resampled_means(sample, RESAMPLING_SEED, even=False), sample))
    apart = [_apart(u, c) for u, c in zip(unchanged, changed, strict=True)]
    pieces = less.shape[1]
    piece_s = duration_s / pieces
    return Strip(
        piece_s * np.arange(pieces),
        piece_s,
        less.mean(axis=0),
        bounds[:, 0],
        bounds[:, 1],
        np.array([_mean(column) for column in np.array(apart).T]),
    )


def _apart(unchanged: Run, changed: Run) -> Floats:
    """The mean distance (P,), metres, of the actors that both have."""
    both = [actor for actor in unchanged.places if actor in changed.places]
    away = [changed.places[actor] - unchanged.places[actor] for actor in both]
    pieces = len(unchanged.conflicts_s)
    distances = np.hypot(*np.array(away).reshape(len(both), pieces, 2).transpose(2, 0, 1))
    return np.array([_mean(column) for column in distances.T] if both else [math.nan] * pieces)


def _values(runs: Sequence[Run], measures: Sequence[Measure]) -> Floats:
    return np.array([[run.figures[each.name] for each in measures] for run in runs])


def _mean(values: Floats) -> float:
    known = values[np.isfinite(values)]
    return float(known.mean()) if len(known) else math.nan

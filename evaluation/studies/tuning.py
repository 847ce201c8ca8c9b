"""Tuning: the best settings by cost, with leave-one-out cross-validation over places."""

import itertools
import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from esplanade.evaluation.measures import MEASURES, Floats, named
from esplanade.evaluation.settings import SettingError
from esplanade.evaluation.studies.subjects import OUR_ACTOR, Subject
from esplanade.evaluation.studies.variants import Tables, Variant
from esplanade.files.content import ContentError
from esplanade.files.text import read_text
from esplanade.stats import Interval, Sample, interval_of, means_of, resampled_means

WEIGHT_BEYOND_GOALS: Final = 0.1
"""The weight of improvements once a goal is met; before that, their weight is 1 more."""

_GOALS: Final = np.array([m.goal - m.best for m in MEASURES if m.goal > m.best])
_BEST: Final = np.array([m.best for m in MEASURES])
_HAS_GOAL: Final = np.array([m.goal > m.best for m in MEASURES])


@dataclass(frozen=True)
class Fold:
    """A candidate chosen on all places but one, and its results there."""

    left_out: str
    chosen: Variant
    measures: Floats
    intervals: Sequence[Interval]
    cost: float
    baseline_cost: float
    least_cost: float
    """The cost of the candidate that is best at the place left out."""


@dataclass(frozen=True)
class Tuning:
    """The candidates ranked on all places, and one fold for each place."""

    baseline: Variant
    ranked: tuple[tuple[Variant, Floats, float], ...]
    """Rows of (candidate, measures, cost), the best first."""
    intervals: Mapping[Variant, Sequence[Interval]]
    """The intervals of each candidate's measures."""
    folds: tuple[Fold, ...]
    confidence_percent: float
    """The share of bootstrap resamples in which the best candidate costs less than the baseline."""


def candidates(
    grid: Mapping[str, Sequence[Any]],
    listed: Sequence[Mapping[str, Any]],
    base: Mapping[str, Any],
    subject: Subject = OUR_ACTOR,
) -> list[dict[str, Any]]:
    """The settings to compare: the baseline, all combinations of a grid, and those listed."""
    combined = [
        dict(zip(grid, values, strict=True)) for values in itertools.product(*grid.values()) if grid
    ]
    return [subject.check({**base, **changes}) for changes in [{}, *combined, *listed]]


def read_candidates(path: Path, subject: Subject = OUR_ACTOR) -> list[dict[str, Any]]:
    """Read candidates from a file that has a JSON object of settings in every line.

    Raises
    ------
    SettingError
        The file cannot be read, or a line is not an object of valid settings.
    """
    try:
        lines = read_text(path).splitlines()
    except ContentError as error:
        raise SettingError(f"{path}: {error}") from None
    found = []
    for number, line in enumerate(lines, start=1):
        if not line.strip():
            continue
        try:
            settings = json.loads(line)
            if not isinstance(settings, dict):
                raise SettingError('a line must be one object of settings, {"NAME": VALUE, ..}')
            found.append(subject.check(settings))
        except ValueError as error:
            raise SettingError(f"{path}:{number}: {error}") from None
    return found


def cost(measures: Floats) -> Floats:
    """The cost (...) that tuning minimises, of measures (..., M).

    Each measure is scaled so that 0 is the best possible value and 1 is its goal. The cost is the
    sum of the excesses over the goals, plus a tenth of the sum of all scaled measures, plus 1 for
    each per cent of trips that did not arrive. It is infinite if no trip arrived.
    """
    missed = measures[..., ~_HAS_GOAL].sum(axis=-1)
    scaled = (measures - _BEST)[..., _HAS_GOAL] / _GOALS
    excess = np.maximum(scaled - 1.0, 0.0)
    total = excess.sum(axis=-1) + WEIGHT_BEYOND_GOALS * scaled.sum(axis=-1) + missed
    return np.where(np.isnan(total), np.inf, total)  # without arrivals the time is nan


def tune(tables: Mapping[Variant, Tables], baseline: Variant, seed: int) -> Tuning:
    """Rank the candidates on all places, and cross-validate the choice at each in turn."""
    measured = {variant: _mean(rows.values()) for variant, rows in tables.items()}
    ranked = sorted(
        ((variant, found, float(cost(found))) for variant, found in measured.items()),
        key=lambda row: row[2],
    )
    best = cost(resampled_means(list(tables[ranked[0][0]].values()), seed, even=True))
    before = cost(resampled_means(list(tables[baseline].values()), seed, even=True))
    return Tuning(
        baseline,
        tuple(ranked),
        {variant: _intervals(rows.values(), seed) for variant, rows in tables.items()},
        tuple(_fold(tables, baseline, place, seed) for place in tables[baseline]),
        float(100.0 * np.mean(best < before)),
    )


def _fold(tables: Mapping[Variant, Tables], baseline: Variant, left_out: str, seed: int) -> Fold:
    there = {variant: _mean([t[left_out]]) for variant, t in tables.items()}
    elsewhere = {
        variant: float(cost(_mean(rows for place, rows in t.items() if place != left_out)))
        for variant, t in tables.items()
    }
    chosen = min(elsewhere, key=elsewhere.__getitem__)
    return Fold(
        left_out,
        chosen,
        there[chosen],
        _intervals([tables[chosen][left_out]], seed),
        float(cost(there[chosen])),
        float(cost(there[baseline])),
        min(float(cost(measures)) for measures in there.values()),
    )


def _mean(samples: Iterable[Sample]) -> Floats:
    """The mean over places, which all have the same weight."""
    return means_of(list(samples), even=True)


def _intervals(samples: Iterable[Sample], seed: int) -> Sequence[Interval]:
    """The intervals of the mean over places."""
    taken = list(samples)
    return interval_of(resampled_means(taken, seed, even=True), taken)


def figures(tuning: Tuning) -> dict[str, Any]:
    """All candidates and folds, ready for JSON."""
    return {
        "candidates": [
            {
                "settings": dict(variant.settings),
                "cost": cost,
                **named(measures),
                "intervals": _named(tuning.intervals[variant]),
            }
            for variant, measures, cost in tuning.ranked
        ],
        "folds": [
            {
                "left_out": fold.left_out,
                "chosen": dict(fold.chosen.settings),
                "cost": fold.cost,
                "baseline_cost": fold.baseline_cost,
                "least_cost": fold.least_cost,
                **named(fold.measures),
                "intervals": _named(fold.intervals),
            }
            for fold in tuning.folds
        ],
        "confidence_percent": tuning.confidence_percent,
    }


def _named(intervals: Sequence[Interval]) -> dict[str, list[float]]:
    return {m.name: list(bounds) for m, bounds in zip(MEASURES, intervals, strict=True)}

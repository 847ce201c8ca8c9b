"""Which settings are best, and whether that holds on a recording they were not chosen on."""

import itertools
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from esplanade.evaluation.settings import SettingError, check
from esplanade.evaluation.studies.measures import MEASURES, Floats, named, pooled, resampled
from esplanade.evaluation.studies.variants import Tables, Variant
from esplanade.evaluation.trials import Source

BEYOND_GOALS: Final = 0.1
"""What getting better is still worth once a goal is met; before that, it is worth one more."""

_GOALS: Final = np.array([m.goal - m.best for m in MEASURES if m.goal > m.best])
_BEST: Final = np.array([m.best for m in MEASURES])
_HAS_GOAL: Final = np.array([m.goal > m.best for m in MEASURES])


@dataclass(frozen=True)
class Fold:
    """What is chosen without one recording, and what comes of it there."""

    left_out: Source
    chosen: Variant
    measures: Floats
    cost: float
    unchanged_cost: float
    least_cost: float
    """Of whatever candidate would have been best there."""


@dataclass(frozen=True)
class Tuning:
    """Candidates on all recordings, best first, and one fold for each recording."""

    unchanged: Variant
    ranked: tuple[tuple[Variant, Floats, float], ...]
    """Candidate, measures, cost."""
    folds: tuple[Fold, ...]
    sure_percent: float
    """So often, when episodes are drawn anew, is the first better than what is unchanged."""


def candidates(
    grid: Mapping[str, Sequence[Any]], listed: Sequence[Mapping[str, Any]], base: Mapping[str, Any]
) -> list[dict[str, Any]]:
    """Settings to compare: the unchanged first, all combinations of a grid, and those listed."""
    combined = [
        dict(zip(grid, values, strict=True)) for values in itertools.product(*grid.values()) if grid
    ]
    return [check({**base, **changes}) for changes in [{}, *combined, *listed]]


def read_candidates(path: Path) -> list[dict[str, Any]]:
    """Candidates from a file that has a JSON object of settings in every line.

    Raises
    ------
    SettingError
        The file cannot be read, or a line is none; the message names it.
    """
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise SettingError(f"{path}: cannot be read: {error}") from None
    found = []
    for number, line in enumerate(lines, start=1):
        if not line.strip():
            continue
        try:
            settings = json.loads(line)
            if not isinstance(settings, dict):
                raise SettingError('a line is one object of settings, {"NAME": VALUE, ..}')
            found.append(check(settings))
        except ValueError as error:
            raise SettingError(f"{path}:{number}: {error}") from None
    return found


def cost(measures: Floats) -> Floats:
    """What is to be least, of measures (..., M).

    Each measure is expressed in goals: 1 is just good enough, 0 could not be better. The cost is
    what they are short of their goals, and a tenth of them all; each per cent of trips that do not
    arrive costs 1 beside it.
    """
    missed = measures[..., ~_HAS_GOAL].sum(axis=-1)
    in_goals = (measures - _BEST)[..., _HAS_GOAL] / _GOALS
    short = np.maximum(in_goals - 1.0, 0.0)
    total = short.sum(axis=-1) + BEYOND_GOALS * in_goals.sum(axis=-1) + missed
    return np.where(np.isnan(total), np.inf, total)  # nobody arrived, so there is no time


def tune(tables: Mapping[Variant, Tables], unchanged: Variant, seed: int) -> Tuning:
    """Rank candidates on all recordings; choose on all but one, and hold against that one."""
    measured = {variant: pooled(rows.values()) for variant, rows in tables.items()}
    ranked = sorted(
        ((variant, found, float(cost(found))) for variant, found in measured.items()),
        key=lambda row: row[2],
    )
    best = cost(resampled(tables[ranked[0][0]].values(), seed))
    before = cost(resampled(tables[unchanged].values(), seed))
    return Tuning(
        unchanged,
        tuple(ranked),
        tuple(_fold(tables, unchanged, source) for source in tables[unchanged]),
        float(100.0 * np.mean(best < before)),
    )


def _fold(tables: Mapping[Variant, Tables], unchanged: Variant, left_out: Source) -> Fold:
    there = {variant: pooled([t[left_out]]) for variant, t in tables.items()}
    elsewhere = {
        variant: float(cost(pooled(rows for source, rows in t.items() if source != left_out)))
        for variant, t in tables.items()
    }
    chosen = min(elsewhere, key=elsewhere.__getitem__)
    return Fold(
        left_out,
        chosen,
        there[chosen],
        float(cost(there[chosen])),
        float(cost(there[unchanged])),
        min(float(cost(measures)) for measures in there.values()),
    )


def figures(tuning: Tuning, names: Mapping[Source, str]) -> dict[str, Any]:
    """Everything that was compared, for JSON."""
    return {
        "candidates": [
            {"settings": dict(variant.settings), "cost": cost, **named(measures)}
            for variant, measures, cost in tuning.ranked
        ],
        "folds": [
            {
                "left_out": names[fold.left_out],
                "chosen": dict(fold.chosen.settings),
                "cost": fold.cost,
                "unchanged_cost": fold.unchanged_cost,
                "least_cost": fold.least_cost,
                **named(fold.measures),
            }
            for fold in tuning.folds
        ],
        "sure_percent": tuning.sure_percent,
    }

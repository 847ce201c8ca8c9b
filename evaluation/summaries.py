"""Summaries of many episodes with the intervals of their figures, recording by recording."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Final, NamedTuple

import numpy as np

from esplanade.evaluation.guidelines import Guideline
from esplanade.evaluation.measures import IMPOSED, MEASURES, Measure, pieces, sample
from esplanade.evaluation.runner import TrialResult
from esplanade.evaluation.scores import Score, Summary, summarise
from esplanade.stats import (
    Difference,
    Interval,
    Sample,
    compare,
    interval_of,
    means_of,
    resampled_means,
    resampled_medians,
    share_interval,
)

POOLED: Final = "all together"

_SHARES: Final[Mapping[str, Callable[[Score], bool]]] = {
    "contacts_percent": lambda s: s.touched,
    "moved_toward_percent": lambda s: s.moved_toward,
    "reached_percent": lambda s: s.reached,
    "wall_contacts_percent": lambda s: s.wall_contact,
    "faults_percent": lambda s: bool(s.fault),
}
_MEANS: Final[Mapping[str, Callable[[Score], float]]] = {
    "clearance_m": lambda s: s.clearance_m,
    "near_s": lambda s: s.near_s,
    "time_ratio": lambda s: s.time_ratio if s.reached else np.nan,
    "path_ratio": lambda s: s.path_ratio if s.reached else np.nan,
    "displacement_m": lambda s: s.displacement_m,
    "turn_rms_radps": lambda s: s.turn_rms_radps,
    "decisions_ms": lambda s: s.decision_ms * s.decisions,
    "decisions": lambda s: s.decisions,
}
"""The last two are those whose ratio is the mean time of a decision."""
_MEDIANS: Final[Mapping[str, Callable[[Score], float]]] = {
    "acceleration_max_mps2": lambda s: s.acceleration_max_mps2,
}


class Row(NamedTuple):
    """The results of one policy on one recording, or on all of them together."""

    recording: str
    policy: str
    summary: Summary
    intervals: Mapping[str, Interval]
    """The 95 % interval of each field of the summary but counts and greatest values."""
    guidelines: Mapping[str, tuple[float, Interval]] = {}
    """The chosen measures of the guidelines by name, each a mean over episodes."""


def rows_of(
    results: Sequence[TrialResult],
    names: Mapping[Any, str],
    seed: int,
    chosen: Sequence[Guideline] = (),
) -> list[Row]:
    """The rows of every recording, then of all together if there are several.

    `seed` is that of the resamples; `chosen` are the guidelines' measures that each row has too.
    """
    parts: dict[tuple[str, str], list[Sequence[Score]]] = {}
    for result in results:
        parts[names[result.trial.source], result.trial.label] = [result.scores]
    if len({result.trial.source for result in results}) > 1:
        for result in results:
            parts.setdefault((POOLED, result.trial.label), []).append(result.scores)
    return [
        Row(
            recording,
            policy,
            summarise([s for part in scores for s in part]),
            _of(scores, seed),
            _guided(scores, seed, chosen),
        )
        for (recording, policy), scores in parts.items()
    ]


def _guided(
    parts: Sequence[Sequence[Score]], seed: int, chosen: Sequence[Guideline]
) -> dict[str, tuple[float, Interval]]:
    """The means of the guidelines' measures over all episodes, with their intervals."""
    samples = [
        Sample.of([[each.of(score) for each in chosen] for score in scores], pieces(scores))
        for scores in parts
        if chosen and scores
    ]
    if not samples:
        return {}
    means = means_of(samples, even=False)
    intervals = interval_of(resampled_means(samples, seed, even=False), samples)
    return {
        each.name: (float(mean), interval)
        for each, mean, interval in zip(chosen, means, intervals, strict=True)
    }


def differences(
    results: Sequence[TrialResult], seed: int, *, reacting: bool
) -> dict[str, dict[Measure, Difference]]:
    """The paired differences of each other policy from the first one, on all recordings.

    They are means over all episodes that both walked. All intervals hold together.
    """
    first = results[0].trial.label
    by_policy: dict[str, list[TrialResult]] = {}
    for result in results:
        by_policy.setdefault(result.trial.label, []).append(result)
    measures = (*MEASURES, IMPOSED) if reacting else MEASURES
    pairs = {
        label: _paired(found, by_policy[first], measures)
        for label, found in by_policy.items()
        if label != first
    }
    compared = compare({n: p for n, p in pairs.items() if p[0]}, seed, even=False)
    return {label: dict(zip(measures, found, strict=True)) for label, found in compared.items()}


def _paired(
    results: Sequence[TrialResult], others: Sequence[TrialResult], measures: Sequence[Measure]
) -> tuple[list[Sample], list[Sample]]:
    """The samples of two policies, of the episodes that both walked."""
    made: tuple[list[Sample], list[Sample]] = ([], [])
    there = {result.trial.source: result.scores for result in others}
    for result in results:
        theirs = {score.number: score for score in there[result.trial.source]}
        ours = [score for score in result.scores if score.number in theirs]
        if ours:
            made[0].append(sample(ours, measures))
            made[1].append(sample([theirs[score.number] for score in ours], measures))
    return made


def _of(parts: Sequence[Sequence[Score]], seed: int) -> dict[str, Interval]:
    """The intervals of the figures of some recordings."""

    def samples(of: Mapping[str, Callable[[Score], float]]) -> list[Sample]:
        return [
            Sample.of([[float(take(s)) for take in of.values()] for s in scores], pieces(scores))
            for scores in parts
            if scores
        ]

    shares, means, medians = samples(_SHARES), samples(_MEANS), samples(_MEDIANS)
    found = {
        name: Interval(*(100.0 * bound for bound in share_interval(shares, column)))
        for column, name in enumerate(_SHARES)
    }
    resamples = resampled_means(means, seed, even=False)
    *plain, _, _ = _MEANS
    found |= zip(plain, interval_of(resamples[:, :-2], means), strict=True)
    (found["decision_ms"],) = interval_of(resamples[:, -2:-1] / resamples[:, -1:], means)
    found |= zip(_MEDIANS, interval_of(resampled_medians(medians, seed), medians), strict=True)
    return found

"""Variants of a policy, and the trials that compare them on the same episodes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

from esplanade.evaluation.measures import pieces, table
from esplanade.evaluation.rules import Rules
from esplanade.evaluation.runner import TrialResult
from esplanade.evaluation.settings import DEFAULTS
from esplanade.evaluation.trials import Source, Trial, plan_trials
from esplanade.stats import Sample

OURS: Final = "esplanade"
LIMIT: Final = "max_acceleration_mps2"
"""This parameter belongs to the body, so the limit of the rules follows it."""


@dataclass(frozen=True)
class Variant:
    """A policy, our actor or one from outside, with some settings changed, under some rules."""

    rules: Rules
    settings: tuple[tuple[str, Any], ...] = ()
    policy: str = OURS

    @classmethod
    def of(cls, rules: Rules, settings: Mapping[str, Any]) -> "Variant":
        """The variant of our actor with some settings, without those that have their default value.

        The limit of acceleration becomes a rule. So variants are equal if they behave the same.
        """
        if LIMIT in settings:
            rules = replace(rules, max_acceleration_mps2=settings[LIMIT])
        changed = {
            name: value
            for name, value in settings.items()
            if name != LIMIT and (name in GIVEN or value != DEFAULTS[name])
        }
        return cls(rules, tuple(sorted(changed.items())))


GIVEN: Final = frozenset({"radius_m", "speed_mps", "max_speed_mps"})
"""The rules give these parameters if no setting does, so their defaults are not the actor's."""

Tables = Mapping[str, Sample]
"""The results of one variant: for each place, the measures of the episodes there."""


def trials_of(
    variants: Sequence[Variant], sources: Sequence[Source], count: int, seed: int
) -> list[Trial]:
    """Plan every variant once on the same episodes of every recording."""
    return [
        trial
        for variant in dict.fromkeys(variants)
        for trial in plan_trials(
            sources,
            [variant.policy],
            variant.rules,
            count,
            seed,
            dict(variant.settings),
            variant.settings,
        )
    ]


def tables_of(
    results: Sequence[TrialResult], places: Mapping[Source, str]
) -> dict[Variant, Tables]:
    """The measures of every variant at every place, whose recordings count as one."""
    found: dict[Variant, dict[str, list[TrialResult]]] = {}
    for result in results:
        variant = Variant(result.trial.rules, result.trial.settings, result.trial.policy)
        at = found.setdefault(variant, {})
        at.setdefault(places[result.trial.source], []).append(result)
    return {
        variant: {place: _sample(there) for place, there in at.items()}
        for variant, at in found.items()
    }


def _sample(results: Sequence[TrialResult]) -> Sample:
    values = [row for result in results for row in table(result.scores)]
    labels = [(k, piece) for k, result in enumerate(results) for piece in pieces(result.scores)]
    return Sample.of(values, labels)

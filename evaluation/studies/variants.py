"""Variants of our actor, and the trials that compare them on the same episodes."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

from esplanade.evaluation.rules import Rules
from esplanade.evaluation.runner import Result
from esplanade.evaluation.settings import DEFAULTS
from esplanade.evaluation.studies.measures import Floats, table
from esplanade.evaluation.trials import Source, Trial, plan_trials

OURS: Final = "esplanade"
LIMIT: Final = "max_acceleration_mps2"
"""Belongs to the body, so that the rules of the episode follow it."""


@dataclass(frozen=True)
class Variant:
    """Our actor with some settings changed, under some rules."""

    rules: Rules
    settings: tuple[tuple[str, Any], ...] = ()

    @classmethod
    def of(cls, rules: Rules, settings: Mapping[str, Any]) -> "Variant":
        """Equal for equal behaviour: what is as by default, or said by the rules, is left out."""
        if LIMIT in settings:
            rules = replace(rules, max_acceleration_mps2=settings[LIMIT])
        changed = {
            name: value
            for name, value in settings.items()
            if name != LIMIT and (name in GIVEN or value != DEFAULTS[name])
        }
        return cls(rules, tuple(sorted(changed.items())))


GIVEN: Final = frozenset({"radius_m", "speed_mps", "max_speed_mps"})
"""What the rules say of the body where no setting does: their defaults are not the actor's."""

Tables = Mapping[Source, Floats]
"""What came of one variant: for each recording, the measures of its episodes."""


def trials_of(
    variants: Sequence[Variant], sources: Sequence[Source], count: int, seed: int
) -> list[Trial]:
    """Every variant, each once, on the same episodes of every recording."""
    return [
        trial
        for variant in dict.fromkeys(variants)
        for trial in plan_trials(
            sources, [OURS], variant.rules, count, seed, dict(variant.settings)
        )
    ]


def tables_of(results: Sequence[Result]) -> dict[Variant, Tables]:
    """The measures of every variant on every recording."""
    found: dict[Variant, dict[Source, Floats]] = {}
    for result in results:
        variant = Variant(result.trial.rules, result.trial.settings)
        found.setdefault(variant, {})[result.trial.source] = table(result.scores)
    return dict(found)

"""Sensitivity analysis: one setting takes other values while all others stay as they are."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from esplanade.actors import ActorParameters
from esplanade.evaluation.measures import MEASURES
from esplanade.evaluation.rules import Rules
from esplanade.evaluation.settings import SettingError
from esplanade.evaluation.studies.subjects import OUR_ACTOR, Subject
from esplanade.evaluation.studies.variants import Tables, Variant
from esplanade.stats import interval_of, means_of, resampled_means

BODY_PARAMETERS: Final = frozenset(
    {
        "radius_m",
        "speed_mps",
        "max_speed_mps",
        "goal_tolerance_m",
        "height_m",
        "step_on_m",
        "leg_length_m",
        "edge_cells",
        "stride",
    }
)
"""Parameters of the body, which are not varied by default."""
MULTI_ACTOR_PARAMETERS: Final = frozenset({"keep_right_weight", "patience_s"})
"""Parameters that have no effect on a single actor among people who walk."""
BEHAVIOUR_PARAMETERS: Final = tuple(
    name
    for name in ActorParameters.model_fields
    if name not in BODY_PARAMETERS | MULTI_ACTOR_PARAMETERS
)
VALUES_EACH_SIDE: Final = 2
FACTOR: Final = 2.0
"""By default a setting takes `VALUES_EACH_SIDE` values below and above its own, each `FACTOR` times
its neighbour; a setting that is zero takes fractions of its upper limit instead."""


@dataclass(frozen=True)
class Point:
    """The results of one value of a setting, one figure for each of `MEASURES`."""

    value: Any
    means: tuple[float, ...]
    lows: tuple[float, ...]
    highs: tuple[float, ...]
    differs: tuple[bool, ...]
    """Whether the 95 % interval of the paired difference from the baseline excludes 0."""


@dataclass(frozen=True)
class Curve:
    """The results of all values of one setting."""

    name: str
    unit: str
    baseline: Any
    points: tuple[Point, ...]


def ranges(
    choices: Mapping[str, tuple[Any, ...] | None],
    base: Mapping[str, Any],
    subject: Subject = OUR_ACTOR,
) -> dict[str, tuple[Any, ...]]:
    """The values of each setting in ascending order, with that of the baseline among them.

    Raises
    ------
    SettingError
        No values are given for a setting that has no value to scale and no upper limit.
    """
    return {name: _values(name, given, base, subject) for name, given in choices.items()}


def variant_of(
    rules: Rules, base: Mapping[str, Any], name: str, value: Any, subject: Subject = OUR_ACTOR
) -> Variant:
    """The variant that has one setting at one value."""
    return subject.variant(rules, subject.check({**base, name: value}))


def curves(
    values: Mapping[str, Sequence[Any]],
    base: Mapping[str, Any],
    rules: Rules,
    tables: Mapping[Variant, Tables],
    seed: int,
    subject: Subject = OUR_ACTOR,
) -> list[Curve]:
    """Collect the results of every value of every setting."""
    found = []
    for name, taken in values.items():
        baseline = subject.baseline(name, base)
        unchanged = list(tables[variant_of(rules, base, name, baseline, subject)].values())
        reference = resampled_means(unchanged, seed, even=True)
        points = []
        for value in taken:
            measured = list(tables[variant_of(rules, base, name, value, subject)].values())
            resamples = resampled_means(measured, seed, even=True)
            intervals = interval_of(resamples, measured)
            differences = interval_of(resamples - reference, measured)
            points.append(
                Point(
                    value,
                    tuple(means_of(measured, even=True).tolist()),
                    tuple(interval.low for interval in intervals),
                    tuple(interval.high for interval in intervals),
                    tuple(found.low > 0.0 or found.high < 0.0 for found in differences),
                )
            )
        found.append(Curve(name, subject.schema(name).get("unit", ""), baseline, tuple(points)))
    return found


def figures(found: Sequence[Curve]) -> list[dict[str, Any]]:
    """All points, ready for JSON."""
    return [
        {
            "setting": curve.name,
            "unit": curve.unit,
            "baseline": curve.baseline,
            "value": point.value,
            **{
                measure.name: {"mean": mean, "low": low, "high": high, "differs": differs}
                for measure, mean, low, high, differs in zip(
                    MEASURES, point.means, point.lows, point.highs, point.differs, strict=True
                )
            },
        }
        for curve in found
        for point in curve.points
    ]


def _values(
    name: str, given: tuple[Any, ...] | None, base: Mapping[str, Any], subject: Subject
) -> tuple[Any, ...]:
    baseline = subject.baseline(name, base)
    if given is not None:
        try:
            return tuple(sorted({*given, baseline}))
        except TypeError:
            raise SettingError(f"{name} is {baseline}: its values are of several types") from None
    limits = subject.schema(name)
    least, most = limits.get("minimum", 0.0), limits.get("maximum", np.inf)
    if not isinstance(baseline, int | float):
        raise SettingError(f"{name} is {baseline}: give its values as {name}=V1,V2,..")
    if baseline == 0 and most < np.inf and not isinstance(baseline, bool):
        spread = [0.0, *(most / FACTOR**step for step in range(2 * VALUES_EACH_SIDE, 0, -1))]
    elif 0.0 < baseline < np.inf and not isinstance(baseline, bool):
        steps = range(-VALUES_EACH_SIDE, VALUES_EACH_SIDE + 1)
        spread = [min(most, max(least, baseline * FACTOR**step)) for step in steps]
    else:
        raise SettingError(f"{name} is {baseline}: give its values as {name}=V1,V2,..")
    whole = isinstance(baseline, int)
    return tuple(sorted({round(value) if whole else value for value in spread}))

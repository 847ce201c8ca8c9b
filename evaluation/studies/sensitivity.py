"""What each setting does: some values of one, all others as they are."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from esplanade.actors import ActorParameters
from esplanade.evaluation.rules import Rules
from esplanade.evaluation.settings import DEFAULTS, SettingError, check
from esplanade.evaluation.studies.measures import MEASURES, interval, pooled, resampled
from esplanade.evaluation.studies.variants import Tables, Variant

BODY: Final = frozenset(
    {
        "radius_m",
        "speed_mps",
        "max_speed_mps",
        "goal_tolerance_m",
        "height_m",
        "step_on_m",
        "leg_length_m",
        "edge_cells",
    }
)
"""Parameters that say what an actor is, not how it behaves."""
AMONG_ACTORS: Final = frozenset({"keep_right_weight"})
"""Parameters that one actor alone never asks for."""
TEMPER: Final = tuple(
    name for name in ActorParameters.model_fields if name not in BODY | AMONG_ACTORS
)
EACH_SIDE: Final = 2
FACTOR: Final = 2.0
"""By default a setting takes so many values on each side, each so many times its neighbour; one
that is zero takes parts of its limit."""


@dataclass(frozen=True)
class Point:
    """What came of one value; a figure for each of `MEASURES`."""

    value: Any
    means: tuple[float, ...]
    lows: tuple[float, ...]
    highs: tuple[float, ...]
    differs: tuple[bool, ...]
    """Whether the difference from the unchanged setting, on the same episodes, is beyond chance."""


@dataclass(frozen=True)
class Curve:
    """What came of all values of one setting."""

    name: str
    unit: str
    unchanged: Any
    points: tuple[Point, ...]


def ranges(
    choices: Mapping[str, tuple[Any, ...] | None], base: Mapping[str, Any]
) -> dict[str, tuple[Any, ...]]:
    """The values each setting takes, in order; the unchanged one is among them.

    Raises
    ------
    SettingError
        No values are given, and there is nothing to multiply or divide.
    """
    return {name: _values(name, given, base) for name, given in choices.items()}


def variant_of(rules: Rules, base: Mapping[str, Any], name: str, value: Any) -> Variant:
    """Our actor with one setting at one value."""
    return Variant.of(rules, check({**base, name: value}))


def curves(
    values: Mapping[str, Sequence[Any]],
    base: Mapping[str, Any],
    rules: Rules,
    tables: Mapping[Variant, Tables],
    seed: int,
) -> list[Curve]:
    """Put together what came of every value of every setting."""
    found = []
    for name, taken in values.items():
        unchanged = _unchanged(name, base)
        at_rest = resampled(tables[variant_of(rules, base, name, unchanged)].values(), seed)
        points = []
        for value in taken:
            measured = tables[variant_of(rules, base, name, value)].values()
            resamples = resampled(measured, seed)
            low, high = interval(resamples)
            less, more = interval(resamples - at_rest)
            points.append(
                Point(
                    value,
                    tuple(pooled(measured).tolist()),
                    tuple(low.tolist()),
                    tuple(high.tolist()),
                    tuple(np.asarray((less > 0) | (more < 0)).tolist()),
                )
            )
        found.append(Curve(name, _schema(name).get("unit", ""), unchanged, tuple(points)))
    return found


def figures(found: Sequence[Curve]) -> list[dict[str, Any]]:
    """Every point, for JSON."""
    return [
        {
            "setting": curve.name,
            "unit": curve.unit,
            "unchanged": curve.unchanged,
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


def _values(name: str, given: tuple[Any, ...] | None, base: Mapping[str, Any]) -> tuple[Any, ...]:
    unchanged = _unchanged(name, base)
    if given is not None:
        return tuple(sorted({*given, unchanged}))
    limits = _schema(name)
    least, most = limits.get("minimum", 0.0), limits.get("maximum", np.inf)
    if unchanged == 0 and most < np.inf and not isinstance(unchanged, bool):
        spread = [0.0, *(most / FACTOR**step for step in range(2 * EACH_SIDE, 0, -1))]
    elif 0.0 < unchanged < np.inf and not isinstance(unchanged, bool):
        steps = range(-EACH_SIDE, EACH_SIDE + 1)
        spread = [min(most, max(least, unchanged * FACTOR**step)) for step in steps]
    else:
        raise SettingError(f"{name} is {unchanged}: say which values, as {name}=V1,V2,..")
    whole = isinstance(unchanged, int)
    return tuple(sorted({round(value) if whole else value for value in spread}))


def _unchanged(name: str, base: Mapping[str, Any]) -> Any:
    return base.get(name, DEFAULTS[name])


def _schema(name: str) -> dict[str, Any]:
    """What is said of a parameter; nothing of a model's field."""
    found: dict[str, Any] = ActorParameters.model_json_schema()["properties"].get(name, {})
    return found

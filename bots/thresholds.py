"""Thresholds of a run, like `snapshot_age.p99>200ms`: read before it, held against its result."""

import difflib
import operator
import re
from collections.abc import Callable, Mapping
from typing import Final, NamedTuple

from esplanade.bots.measures import AMOUNTS, SPREADS, Amount, Spread
from esplanade.bots.tally import Tally

_FORM: Final = re.compile(
    r"(?P<measure>[a-z_]\w*(?:\.[\w.]+)?)\s*(?P<sign><=|>=|<|>)\s*"
    r"(?P<value>\d+(?:\.\d*)?(?:[eE][+-]?\d+)?)\s*(?P<unit>%|[a-zA-Zµ/]*)"
)
_PERCENTILE: Final = re.compile(r"p(\d{1,3}(?:\.\d{1,3})?)")
_SIGNS: Final[Mapping[str, Callable[[float, float], bool]]] = {
    ">": operator.gt,
    ">=": operator.ge,
    "<": operator.lt,
    "<=": operator.le,
}
_ERROR: Final = "errors."
DEFAULT_RULE: Final = frozenset({"clients.failed", "clients.lost", "errors"})
"""Thresholds on these, and on single errors, take the place of the rule that none is allowed."""


class Threshold(NamedTuple):
    """A run fails where this holds."""

    text: str
    measure: str
    value: Callable[[Tally], float | None]
    """The measured value, in units of the threshold; None where nothing was measured."""
    sign: str
    limit: float
    unit: str
    replay_only: bool

    def verdict(self, tally: Tally) -> "Verdict":
        """Whether the run fails. What nothing was measured of cannot be within a limit."""
        value = self.value(tally)
        return Verdict(self, value, value is None or _SIGNS[self.sign](value, self.limit))


class Verdict(NamedTuple):
    """A threshold, the value that it was held against, and whether the run fails by it."""

    threshold: Threshold
    value: float | None
    failed: bool

    def __str__(self) -> str:
        measured = "nothing was measured"
        if self.value is not None:
            gap = "" if self.threshold.unit in {"", "%"} else " "
            measured = f"it is {told(self.value)}{gap}{self.threshold.unit}"
        return f"{self.threshold.text}: {measured}"


def told(value: float) -> str:
    """A measured value as people read it."""
    return f"{value:.4g}" if abs(value) < 1000.0 else f"{value:,.0f}"


def read_thresholds(text: str) -> tuple[Threshold, ...]:
    """Thresholds with commas between them.

    Raises
    ------
    ValueError
        One of them means nothing; the message says which, and what is expected.
    """
    return tuple(_read(word.strip()) for word in text.split(","))


def _read(word: str) -> Threshold:
    found = _FORM.fullmatch(word)
    if found is None:
        raise ValueError(f"{word!r} is no threshold, expected one like snapshot_age.p99>200ms")
    name, unit = found["measure"], found["unit"]
    limit = float(found["value"])
    if name.startswith(_ERROR):
        code = name.removeprefix(_ERROR)
        _check_unit(word, unit, {"": 1.0})
        return Threshold(
            word, "errors", lambda tally: float(tally.errors[code]), found["sign"], limit, "", False
        )
    if name in AMOUNTS:
        value = _amount(word, AMOUNTS[name], unit)
        return Threshold(word, name, value, found["sign"], limit, unit, replay_only=False)
    base, _, part = name.partition(".")
    if base not in SPREADS:
        raise ValueError(f"{word!r}: there is no measure {name}{_near(base, name)}")
    spread = SPREADS[base]
    of_spread = _spread(word, spread, part, unit)
    return Threshold(word, base, of_spread, found["sign"], limit, unit, spread.replay_only)


def _amount(word: str, amount: Amount, unit: str) -> Callable[[Tally], float | None]:
    whole = amount.whole
    if unit == "%" and whole is not None:
        return lambda tally: 100.0 * amount.value(tally) / whole(tally) if whole(tally) else None
    units = amount.units or {"": 1.0}
    _check_unit(word, unit, units, percent=whole is not None)
    return lambda tally: amount.value(tally) / units[unit]


def _spread(word: str, spread: Spread, part: str, unit: str) -> Callable[[Tally], float | None]:
    _check_unit(word, unit, spread.units)
    size = spread.units[unit]
    if part in {"max", "mean"}:
        return lambda tally: _over(
            spread.histogram(tally).mean if part == "mean" else spread.histogram(tally).highest,
            size,
        )
    found = _PERCENTILE.fullmatch(part)
    percent = float(found[1]) if found else 0.0
    if not 0.0 < percent <= 100.0:
        told = f"there is no {part!r}" if part else "something is missing after the measure"
        raise ValueError(f"{word!r}: {told}, expected .p50 or another percentile, .mean or .max")
    return lambda tally: _over(spread.histogram(tally).percentile(percent), size)


def _over(value: float | None, size: float) -> float | None:
    return None if value is None else value / size


def _check_unit(word: str, unit: str, units: Mapping[str, float], *, percent: bool = False) -> None:
    if unit not in units:
        known = [
            repr(each) if each else "no unit" for each in (*units, *(["%"] if percent else []))
        ]
        raise ValueError(f"{word!r}: {_told(unit)}, expected {' or '.join(known)}")


def _told(unit: str) -> str:
    return f"unit {unit!r} does not fit" if unit else "the unit is missing"


def _near(base: str, name: str) -> str:
    known = [*SPREADS, *AMOUNTS]
    near = difflib.get_close_matches(name, known, 1) or difflib.get_close_matches(base, known, 1)
    return f"; did you mean {near[0]}?" if near else f"; there are {', '.join(known)}"

"""Records of parameters, many at once: what may stand in them, checked for all in one go."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from esplanade.actors.parameters import ActorParameters
from esplanade.planning import PARAMETERS

NAMES: Final = PARAMETERS.names or ()
MEASURES: Final = ("radius_m", "height_m", "step_on_m", "leg_length_m")
"""The fields that make another kind of body."""
FaultCode = Literal["unknown", "unfit", "not_finite", "not_whole", "below", "above", "order"]

_SCHEMA: Final = ActorParameters.model_json_schema()["properties"]
RADII_M: Final = tuple(_SCHEMA["radius_m"][name] for name in ("minimum", "maximum"))
"""The least and the greatest radius of an actor."""
_LEAST: Final = np.array([_SCHEMA[name]["minimum"] for name in NAMES], dtype=np.float64)
_MOST: Final = np.array([_SCHEMA[name]["maximum"] for name in NAMES], dtype=np.float64)
_WHOLE: Final = np.array([_SCHEMA[name]["type"] == "integer" for name in NAMES])
_ORDERS: Final = (("step_on_m", "leg_length_m"), ("speed_mps", "max_speed_mps"))
"""The first of each must not be above the second."""


@dataclass(frozen=True)
class ParameterFault:
    """A value that an actor cannot have."""

    actor: Hashable
    field: str
    code: FaultCode
    value: float | None = None
    limit: float | None = None
    """The bound that it is beyond, or the value of the other field."""
    other: str | None = None
    """The field that has that bound, where two do not go together."""

    def __str__(self) -> str:
        match self.code:
            case "unknown":
                return f"{self.field} is no parameter of actors"
            case "unfit":
                return f"{self.field} needs one number, or one for each actor"
            case "not_finite" | "not_whole":
                kind = "finite" if self.code == "not_finite" else "whole"
                return f"{self.field} of {self.actor} must be a {kind} number, got {self.value}"
            case "order":
                return (
                    f"{self.field} ({self.value:g}) of {self.actor} must not be above "
                    f"{self.other} ({self.limit:g})"
                )
        return (
            f"{self.field} of {self.actor} must not be {self.code} {self.limit:g}, "
            f"got {self.value:g}"
        )


class ParameterError(ValueError):
    """Values that actors cannot have; nothing was changed."""

    def __init__(self, faults: Sequence[ParameterFault]) -> None:
        super().__init__("; ".join(map(str, faults)))
        self.faults = tuple(faults)


def with_values(
    records: NDArray[np.void], ids: Sequence[Hashable], values: Mapping[str, ArrayLike]
) -> NDArray[np.void]:
    """Copies of the records (N,) of some actors, with other values in some fields.

    A field's values are one number, or N. Cost O(N), some microseconds for each hundred.

    Raises
    ------
    ParameterError
        An actor cannot have its values; the first few faults are named.
    """
    changed = records.copy()
    faults = []
    for name, column in values.items():
        if name not in NAMES:
            faults.append(ParameterFault(None, name, "unknown"))
            continue
        try:
            changed[name] = column
        except (TypeError, ValueError):
            faults.append(ParameterFault(None, name, "unfit"))
    faults += _faults(changed, ids)
    if faults:
        raise ParameterError(faults)
    return changed


def measures(records: NDArray[np.void]) -> NDArray[np.float64]:
    """Return the measures that make the kinds of body of some actors, float64 (N, 4), metres."""
    return np.stack([records[name] for name in MEASURES], axis=1)


def _faults(records: NDArray[np.void], ids: Sequence[Hashable]) -> list[ParameterFault]:
    table = np.ascontiguousarray(records).view(np.float64).reshape(len(records), len(NAMES))
    finite = np.isfinite(table)
    whole = finite & _WHOLE
    checks: tuple[tuple[FaultCode, NDArray[np.bool_], NDArray[np.float64]], ...] = (
        ("not_finite", ~finite, _LEAST),
        ("not_whole", whole & (table != np.floor(np.where(whole, table, 0.0))), _LEAST),
        ("below", finite & (table < _LEAST), _LEAST),
        ("above", finite & (table > _MOST), _MOST),
    )
    faults = [
        ParameterFault(
            ids[row], NAMES[column], code, float(table[row, column]), float(bounds[column])
        )
        for code, wrong, bounds in checks
        if wrong.any()
        for row, column in np.argwhere(wrong)[:_TOLD].tolist()
    ]
    for low, high in _ORDERS:
        for row in np.flatnonzero(records[low] > records[high])[:_TOLD].tolist():
            value, limit = float(records[low][row]), float(records[high][row])
            faults.append(ParameterFault(ids[row], low, "order", value, limit, high))
    return faults


_TOLD: Final = 8
"""No more faults of one sort are told."""

"""The inner state of behaviours as plain data, checked when it is read."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Final

from pydantic import Field, TypeAdapter

_Metres = Annotated[float, Field(allow_inf_nan=False, ge=-100_000.0, le=100_000.0)]
MOMENT: Final[TypeAdapter[Any]] = TypeAdapter(Annotated[float, Field(ge=float("-inf"))])
"""A time of the world in seconds; it may lie at either end of all time."""
PERHAPS_MOMENT: Final[TypeAdapter[Any]] = TypeAdapter(
    Annotated[float, Field(allow_inf_nan=False)] | None
)
PLACE: Final[TypeAdapter[Any]] = TypeAdapter(tuple[_Metres, _Metres, _Metres] | None)
NUMBER: Final[TypeAdapter[Any]] = TypeAdapter(Annotated[int, Field(ge=0, le=1_000_000)])
FLAG: Final[TypeAdapter[Any]] = TypeAdapter(bool)
PEOPLE: Final[TypeAdapter[Any]] = TypeAdapter(set[int])
MOMENTS: Final[TypeAdapter[Any]] = TypeAdapter(
    dict[int, Annotated[float, Field(allow_inf_nan=False)]]
)

Memory = Mapping[str, TypeAdapter[Any]]
"""The attributes that a behaviour keeps from one call of `update` to the next, and their kinds."""

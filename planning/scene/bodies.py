"""Bodies: an upright cylinder that steps up and down. Different bodies see different worlds."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from typing import Self

LIMITS = {
    "radius_m": (0.05, 1.0),
    "height_m": (0.2, 4.0),
    "step_on_m": (0.0, 1.2),
    "leg_length_m": (0.0, 2.0),
    "edge_cells": (1, 10_000),
}
"""Least and greatest value of each measure. Cells link surfaces up to 1.2 m apart in height, so
nobody steps higher."""

MOST_BODIES = 64
"""Kinds of body that a zone tells apart."""


@dataclass(frozen=True)
class Body:
    """The sizes of a person or an actor that decide where it can go (Huang & Li, sec. 3).

    Raises
    ------
    ValueError
        A measure is outside its `LIMITS`, or the leg is shorter than the highest step it takes.
    """

    radius_m: float = 0.25
    """R: half the width of the shoulders."""
    height_m: float = 1.80
    """H."""
    step_on_m: float = 0.60
    """Greatest difference in height that it steps up or down."""
    leg_length_m: float = 0.90
    """Greatest difference in height that is an edge; what is above it is an obstacle."""
    edge_cells: int = 64
    """M: fewer cells than these in a row may lie on edges."""

    def __post_init__(self) -> None:
        for field in fields(self):
            value, (least, most) = getattr(self, field.name), LIMITS[field.name]
            if not (math.isfinite(value) and least <= value <= most):
                raise ValueError(f"{field.name} must lie between {least} and {most}, got {value}")
        if self.edge_cells != int(self.edge_cells):
            raise ValueError(f"edge_cells must be a whole number, got {self.edge_cells}")
        if self.leg_length_m < self.step_on_m:
            raise ValueError(
                f"leg_length_m ({self.leg_length_m}) must not be less than "
                f"step_on_m ({self.step_on_m})"
            )

    @classmethod
    def adult(cls) -> Self:
        """The tall body of sec. 5.1: 1.80 m, steps of 0.60 m."""
        return cls()

    @classmethod
    def child(cls) -> Self:
        """The short body of sec. 5.1: 1.30 m, steps of 0.30 m."""
        return cls(radius_m=0.20, height_m=1.30, step_on_m=0.30, leg_length_m=0.65)

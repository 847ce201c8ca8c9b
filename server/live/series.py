"""Figures over time: values of each second, kept in three steps of different length."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Final, Literal, NamedTuple

import numpy as np
import numpy.typing as npt

STEPS: Final = {1: 3600, 10: 8640, 60: 43_200}
"""Lengths of steps in seconds, and how many of each are kept: an hour, a day, thirty days."""


class Figure(NamedTuple):
    """A figure that is measured each second."""

    name: str
    unit: str
    text: str
    over: Literal["mean", "max", "sum"] = "mean"
    """The way in which seconds become one longer step."""


@dataclass
class _Ring:
    """Steps of one length. A slot holds the step whose number stands in `steps`."""

    step_s: int
    steps: npt.NDArray[np.int64]
    values: npt.NDArray[np.float32]
    """(slots, figures)."""

    def write(self, step: int, row: npt.NDArray[np.float32]) -> None:
        slot = step % len(self.steps)
        self.steps[slot], self.values[slot] = step, row


class Series:
    """Values of figures, step by step. Seconds come in ascending order, some may be missing."""

    def __init__(self, figures: Iterable[Figure]) -> None:
        self.figures = {figure.name: figure for figure in figures}
        self.latest: dict[str, float] = {}
        """The values of the latest second; those that could not be told are left out."""
        self.at_us = 0
        names = list(self.figures)
        self._columns = {name: k for k, name in enumerate(names)}
        self._rings = {
            step_s: _Ring(
                step_s,
                np.full(slots, -1, dtype=np.int64),
                np.full((slots, len(names)), np.nan, dtype=np.float32),
            )
            for step_s, slots in STEPS.items()
        }
        self._pending: dict[int, tuple[int, list[npt.NDArray[np.float32]]]] = {}
        """Of each longer step: its number, and the rows of it so far."""

    def add(self, second: int, values: Mapping[str, float]) -> None:
        """Add the values of a second since 1970."""
        self.latest = {name: round(float(value), 4) for name, value in values.items()}
        self.at_us = second * 1_000_000
        row = np.full(len(self._columns), np.nan, dtype=np.float32)
        for name, value in values.items():
            row[self._columns[name]] = value
        self._rings[1].write(second, row)
        for step_s, ring in self._rings.items():
            if step_s == 1:
                continue
            step = second // step_s
            number, rows = self._pending.get(step_s, (step, []))
            if number != step:
                rows = []
            rows.append(row)
            self._pending[step_s] = step, rows
            ring.write(step, self._together(rows))

    def told(
        self, names: Iterable[str], from_us: int, to_us: int, step_s: int
    ) -> tuple[list[int], dict[str, list[float | None]]]:
        """Times and values of steps that begin within a span of time; None where nothing is known.

        Raises
        ------
        KeyError
            There is no figure of a name.
        """
        ring = self._rings[step_s]
        kept = ring.steps >= 0
        times_us = ring.steps * step_s * 1_000_000
        slots = np.flatnonzero(kept & (times_us >= from_us) & (times_us <= to_us))
        slots = slots[np.argsort(ring.steps[slots])]
        found: dict[str, list[float | None]] = {}
        for name in names:
            column = ring.values[slots, self._columns[name]]
            found[name] = [
                None if missing else round(value, 4)
                for missing, value in zip(np.isnan(column).tolist(), column.tolist(), strict=True)
            ]
        return times_us[slots].tolist(), found

    def names(self) -> list[dict[str, Any]]:
        """All figures as plain data."""
        return [
            {"name": each.name, "unit": each.unit, "text": each.text}
            for each in self.figures.values()
        ]

    def _together(self, rows: list[npt.NDArray[np.float32]]) -> npt.NDArray[np.float32]:
        stacked = np.stack(rows)
        row = np.full(stacked.shape[1], np.nan, dtype=np.float32)
        for k, figure in enumerate(self.figures.values()):
            column = stacked[:, k]
            known = column[~np.isnan(column)]
            if len(known):
                row[k] = getattr(known, figure.over)()
        return row

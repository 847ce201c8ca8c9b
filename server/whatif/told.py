"""A what-if in words and figures: its sentences, the cells of its table, and plain data."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

from esplanade.server.whatif.changes import Changes, People
from esplanade.server.whatif.comparison import Row, Strip
from esplanade.server.whatif.runs import Run

HEADS: Final = ("", "unchanged", "changed", "difference")
ENOUGH_SEEDS: Final = 10
"""With fewer, whole seeds that are drawn anew do not reach as far as intervals should."""
PEOPLE: Final = {
    "recorded": "People are where they were recorded, whatever actors do: they do not answer to "
    "what is changed. Figures are those of people who evade nobody anew.",
    "reacting": "People walk toward where they were recorded, and evade actors by a social force "
    "model as far as these are in the way more than when they were recorded. They choose no other "
    "ways, goals or times: a door in their way holds them up.",
}


@dataclass(frozen=True)
class WhatIf:
    """All that came of a what-if."""

    file: str
    command: str
    from_s: float
    duration_s: float
    changes: Changes
    people: People
    seeds: int | None
    """The number of seeds; None for one run with what chance drew in the recording."""
    unchanged: Sequence[Run]
    changed: Sequence[Run]
    rows: Sequence[Row]
    strip: Strip

    @property
    def sentences(self) -> list[str]:
        """The question, the way it was run, and the meaning of that."""
        end_s = self.from_s + self.duration_s
        told = [
            f"The stretch from {self.from_s:g} s to {end_s:g} s of {self.file}, changed: "
            + ", ".join(self.changes.texts)
            + ".",
            PEOPLE[self.people],
        ]
        if self.changes.scene is not None:
            told.append(
                "In both worlds actors begin anew: where they were, with their behaviours from the "
                "beginning. Recorded people walk through what stands in their way."
            )
        if self.seeds is None:
            told.append(
                "One run, with what actors' behaviours had drawn in the recording: nothing is "
                "known of chance. With --seeds there are intervals."
            )
        else:
            told.append(
                f"{self.seeds} runs each, in which actors' behaviours draw anew; a difference "
                "is that of two runs with one seed. Intervals hold together in 95 % of cases for "
                "chance of that kind: of another hour or other people they say nothing."
            )
            if self.seeds < ENOUGH_SEEDS:
                told.append(
                    f"With fewer than {ENOUGH_SEEDS} seeds intervals are narrower than they should "
                    "be: take them for a first look."
                )
            if all((row.changed == row.changed[0]).all() for row in self.rows) and self.seeds > 1:
                told.append("All seeds have the same figures: nothing in this world is drawn.")
        failed = sum(run.planning_failed for run in [*self.unchanged, *self.changed])
        if failed:
            told.append(f"In {failed} ticks planning failed, and the actors stood.")
        return told

    def cells(self, row: Row) -> tuple[str, ...]:
        """A row of the table as people read it; a star marks what differs beyond chance."""
        digits, found = row.measure.digits, row.difference
        told = _number(found.mean, digits, "+")
        if self.seeds is not None:
            low, high = (_number(bound, digits, "+") for bound in found.interval)
            told += f" ({low} to {high})" + ("*" if found.differs else "")
        means = (_number(mean, digits) for mean in row.means)
        return row.measure.label, *means, told

    def plain(self) -> dict[str, Any]:
        """Everything as plain data."""
        return {
            "file": self.file,
            "command": self.command,
            "from_s": self.from_s,
            "duration_s": self.duration_s,
            "changes": self.changes.texts,
            "people": self.people,
            "seeds": self.seeds,
            "told": self.sentences,
            "figures": [_plain(row, intervals=self.seeds is not None) for row in self.rows],
            "strip": {
                "begins_s": self.strip.begins_s.tolist(),
                "conflict_s": self.strip.conflicts_s.tolist(),
                "low_s": self.strip.low_s.tolist(),
                "high_s": self.strip.high_s.tolist(),
                "apart_m": self.strip.apart_m.tolist(),
            },
        }


def _plain(row: Row, *, intervals: bool) -> dict[str, Any]:
    found, (unchanged, changed) = row.difference, row.means
    told: dict[str, Any] = {
        "name": row.measure.name,
        "label": row.measure.label,
        "meaning": row.measure.meaning,
        "unchanged": unchanged,
        "changed": changed,
        "difference": found.mean,
    }
    if intervals:
        told |= {
            "low": found.interval.low,
            "high": found.interval.high,
            "differs": found.differs,
            "by_seed": {"unchanged": row.unchanged.tolist(), "changed": row.changed.tolist()},
        }
    return told


def _number(value: float, digits: int, sign: str = "") -> str:
    return f"{value:{sign}.{digits}f}" if math.isfinite(value) else "–"

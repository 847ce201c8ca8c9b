"""The tables of an evaluation: figures with their intervals, and differences of policies."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

from esplanade.evaluation.cells import number, with_interval
from esplanade.evaluation.guidelines import MEASURES
from esplanade.evaluation.measures import Measure
from esplanade.evaluation.summaries import Row
from esplanade.stats import Difference, Interval, needed

LINES: Final = (
    ("episodes", "episodes", 0),
    ("contacts, % of episodes", "contacts_percent", 1),
    ("  robot moving toward them, %", "moved_toward_percent", 1),
    ("smallest clearance, mean m", "clearance_m", 2),
    ("within 0.2 m, s an episode", "near_s", 2),
    ("goal reached, %", "reached_percent", 1),
    ("time / straight way", "time_ratio", 3),
    ("path / straight way", "path_ratio", 3),
    ("wall contacts, %", "wall_contacts_percent", 1),
    ("displacement imposed on people, m an episode", "displacement_m", 2),
    ("greatest acceleration, m/s²", "acceleration_max_mps2", 1),
    ("turn rate, rms rad/s", "turn_rms_radps", 2),
    ("decision, mean ms", "decision_ms", 2),
    ("decision, greatest ms", "decision_max_ms", 1),
    ("ended by a fault of the policy, %", "faults_percent", 1),
)
"""The rows of a recording: heading, field of `Summary`, digits after the decimal point."""
OF_REACTING_PEOPLE: Final = frozenset({"displacement_m"})
"""Rows that are left out where people do not react."""
FAULTS: Final = "faults_percent"
"""The row that is left out where no policy failed."""
DIFFERENCE_PERCENT: Final = 1.0
"""The difference of contacts for which the number of episodes is told."""


@dataclass(frozen=True)
class Cell:
    """A figure, its interval if it has one, and whether it differs from 0 beyond chance."""

    value: float
    digits: int
    interval: Interval | None = None
    differs: bool | None = None
    """None of what is no difference."""

    @property
    def text(self) -> str:
        """The figure as people read it; a star marks what differs."""
        if self.interval is None:
            return number(self.value, self.digits)
        sign = "" if self.differs is None else "+"
        told = with_interval(self.value, self.interval, self.digits, sign)
        return f"{told}*" if self.differs else told


class Table(NamedTuple):
    """A table with a column for each policy."""

    title: str
    policies: tuple[str, ...]
    rows: tuple[tuple[str, tuple[Cell, ...]], ...]


def of_recordings(rows: Sequence[Row], *, reacting: bool) -> list[Table]:
    """A table for each recording, and one for all together.

    `reacting` says whether people react, and something can be imposed on them.
    """
    found = []
    for recording in dict.fromkeys(row.recording for row in rows):
        shown = [row for row in rows if row.recording == recording]
        lines = []
        for heading, field, digits in LINES:
            values = [getattr(row.summary, field) for row in shown]
            if field in OF_REACTING_PEOPLE and not reacting:
                continue
            if field == FAULTS and not any(values):
                continue
            cells = (
                Cell(value, digits, row.intervals.get(field))
                for value, row in zip(values, shown, strict=True)
            )
            lines.append((heading, tuple(cells)))
        for name in shown[0].guidelines:
            measure = MEASURES[name]
            told = (row.guidelines[name] for row in shown)
            cells = (Cell(mean, measure.digits, interval) for mean, interval in told)
            lines.append((measure.label, tuple(cells)))
        found.append(Table(recording, tuple(row.policy for row in shown), tuple(lines)))
    return found


def of_differences(first: str, found: Mapping[str, Mapping[Measure, Difference]]) -> list[Table]:
    """The table of how the other policies differ from the first one, if there are others."""
    if not found:
        return []
    lines = [
        (
            measure.label,
            tuple(
                Cell(of[measure].mean, measure.digits, of[measure].interval, of[measure].differs)
                for of in found.values()
            ),
        )
        for measure in next(iter(found.values()))
    ]
    contacts = (next(iter(of.values())) for of in found.values())
    told = tuple(Cell(needed(each, DIFFERENCE_PERCENT), 0) for each in contacts)
    heading = f"episodes that show a difference of {DIFFERENCE_PERCENT:g} % of contacts"
    title = f"Differences from {first} in the same episodes (*: beyond chance)"
    return [Table(title, tuple(found), (*lines, (heading, told)))]

"""Reports of episodes: tables, and one object for JSON."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from rich import box
from rich.console import Console
from rich.table import Table

from esplanade.evaluation.cells import number, with_interval
from esplanade.evaluation.measures import Measure
from esplanade.evaluation.runner import TrialResult
from esplanade.evaluation.summaries import Row
from esplanade.stats import Difference, needed

LINES = (
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
"""The rows of the table: heading, field of `Summary`, digits after the decimal point."""
OF_REACTING_PEOPLE = frozenset({"displacement_m"})
"""Rows that are left out where people do not react."""
FAULTS = "faults_percent"
"""The row that is left out where no policy failed."""
DIFFERENCE_PERCENT = 1.0
"""The difference of contacts for which the number of episodes is told."""


def show(console: Console, rows: Sequence[Row], *, reacting: bool = False) -> None:
    """Print one table for each recording, with a column for each policy.

    `reacting` says whether people react, and something can be imposed on them.
    """
    for recording in dict.fromkeys(row.recording for row in rows):
        shown = [row for row in rows if row.recording == recording]
        table = Table("", title=recording, title_justify="left", box=box.SIMPLE_HEAD)
        for row in shown:
            table.add_column(row.policy, justify="right")
        for heading, field, digits in LINES:
            values = [getattr(row.summary, field) for row in shown]
            if field in OF_REACTING_PEOPLE and not reacting:
                continue
            if field == FAULTS and not any(values):
                continue
            cells = (
                with_interval(value, row.intervals[field], digits)
                if field in row.intervals
                else number(value, digits)
                for value, row in zip(values, shown, strict=True)
            )
            table.add_row(heading, *cells)
        console.print(table)


def show_differences(
    console: Console, first: str, found: Mapping[str, Mapping[Measure, Difference]]
) -> None:
    """Print how the other policies differ from the first one in the same episodes."""
    if not found:
        return
    title = f"Differences from {first} in the same episodes (*: beyond chance)"
    table = Table("", title=title, title_justify="left", box=box.SIMPLE_HEAD)
    for policy in found:
        table.add_column(policy, justify="right")
    for measure in dict.fromkeys(m for differences in found.values() for m in differences):
        cells = (
            with_interval(of[measure].mean, of[measure].interval, measure.digits, "+")
            + ("*" if of[measure].differs else " ")
            for of in found.values()
        )
        table.add_row(measure.label, *cells)
    told = [needed(next(iter(of.values())), DIFFERENCE_PERCENT) for of in found.values()]
    table.add_section()
    table.add_row(
        f"episodes that show a difference of {DIFFERENCE_PERCENT:g} % of contacts",
        *(number(count, 0) + " " for count in told),
    )
    console.print(table)


def show_faults(console: Console, results: Sequence[TrialResult], names: Mapping[Any, str]) -> None:
    """Print how policies failed, if any did: the first fault of each on each recording."""
    for result in results:
        failed = [score for score in result.scores if score.fault]
        if failed:
            trial = result.trial
            console.print(
                f"{trial.label} failed in {len(failed)} of {len(result.scores)} episodes of "
                f"{names[trial.source]}; in episode {failed[0].number} {failed[0].fault}",
                markup=False,
                highlight=False,
            )


def figures(
    results: Sequence[TrialResult],
    rows: Sequence[Row],
    differences: Mapping[str, Mapping[Measure, Difference]],
    names: Mapping[Any, str],
    settings: Mapping[str, Any],
) -> dict[str, Any]:
    """All summaries, differences and episodes, ready for JSON."""
    return {
        "settings": dict(settings),
        "summaries": [
            {
                "recording": row.recording,
                "policy": row.policy,
                **asdict(row.summary),
                "intervals": {name: list(bounds) for name, bounds in row.intervals.items()},
            }
            for row in rows
        ],
        "differences": [
            {
                "policy": policy,
                "from": results[0].trial.label,
                "measure": measure.name,
                "mean": found.mean,
                "interval": list(found.interval),
                "episodes": found.episodes,
                "differs": found.differs,
            }
            for policy, of in differences.items()
            for measure, found in of.items()
        ],
        "episodes": [
            {"recording": names[r.trial.source], "policy": r.trial.label, **asdict(score)}
            for r in results
            for score in r.scores
        ],
    }

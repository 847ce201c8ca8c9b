"""Reports of episodes: tables, and one object for JSON."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from rich import box
from rich.console import Console
from rich.table import Table

from esplanade.evaluation.runner import TrialResult
from esplanade.evaluation.scores import Score, Summary, summarise

POOLED = "all together"

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


def summaries(
    results: Sequence[TrialResult], names: Mapping[Any, str]
) -> list[tuple[str, str, Summary]]:
    """Rows of (recording, policy, summary), first for each recording, then for all together."""
    rows = [(names[r.trial.source], r.trial.label, summarise(r.scores)) for r in results]
    if len({r.trial.source for r in results}) > 1:
        pooled: dict[str, list[Score]] = {}
        for result in results:
            pooled.setdefault(result.trial.label, []).extend(result.scores)
        rows += [(POOLED, policy, summarise(scores)) for policy, scores in pooled.items()]
    return rows


def show(
    console: Console, rows: Sequence[tuple[str, str, Summary]], *, reacting: bool = False
) -> None:
    """Print one table for each recording, with a column for each policy.

    `reacting` says whether people react, and something can be imposed on them.
    """
    for recording in dict.fromkeys(name for name, _, _ in rows):
        shown = {policy: summary for name, policy, summary in rows if name == recording}
        table = Table("", title=recording, title_justify="left", box=box.SIMPLE_HEAD)
        for policy in shown:
            table.add_column(policy, justify="right")
        for heading, field, digits in LINES:
            values = [getattr(summary, field) for summary in shown.values()]
            if field in OF_REACTING_PEOPLE and not reacting:
                continue
            if field == FAULTS and not any(values):
                continue
            table.add_row(heading, *(_cell(value, digits) for value in values))
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
    rows: Sequence[tuple[str, str, Summary]],
    names: Mapping[Any, str],
    settings: Mapping[str, Any],
) -> dict[str, Any]:
    """All summaries and episodes, ready for JSON."""
    return {
        "settings": dict(settings),
        "summaries": [
            {"recording": name, "policy": policy, **asdict(summary)}
            for name, policy, summary in rows
        ],
        "episodes": [
            {"recording": names[r.trial.source], "policy": r.trial.label, **asdict(score)}
            for r in results
            for score in r.scores
        ],
    }


def _cell(value: float, digits: int) -> str:
    return f"{value:.{digits}f}" if math.isfinite(value) else "–"

"""Reports of episodes: tables, and one object for JSON."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

import rich.box
import rich.table
from rich.console import Console

from esplanade.evaluation.measures import Measure
from esplanade.evaluation.runner import TrialResult
from esplanade.evaluation.summaries import Row
from esplanade.evaluation.tables import Table
from esplanade.stats import Difference


def show(console: Console, tables: Sequence[Table]) -> None:
    """Print all tables, with a column for each policy."""
    for found in tables:
        shown = rich.table.Table(
            "", title=found.title, title_justify="left", box=rich.box.SIMPLE_HEAD
        )
        for policy in found.policies:
            shown.add_column(policy, justify="right")
        for heading, cells in found.rows:
            shown.add_row(heading, *(cell.text for cell in cells))
        console.print(shown)


def show_faults(console: Console, results: Sequence[TrialResult], names: Mapping[Any, str]) -> None:
    """Print how policies failed, if any did: the first fault of each on each recording."""
    for result in results:
        failed = [score for score in result.scores if score.fault]
        if failed:
            trial = result.trial
            given = ", ".join(f"{name}={value}" for name, value in trial.settings)
            policy = f"{trial.label} ({given})" if given else trial.label
            console.print(
                f"{policy} failed in {len(failed)} of {len(result.scores)} episodes of "
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
                **_guided(row),
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


def _guided(row: Row) -> dict[str, Any]:
    """The measures of the guidelines that were chosen, if any."""
    told = {
        name: {"mean": mean, "interval": list(interval)}
        for name, (mean, interval) in row.guidelines.items()
    }
    return {"guidelines": told} if told else {}

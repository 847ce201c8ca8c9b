"""The table of all trials, and the same as JSON."""

import dataclasses
import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from rich import box
from rich.console import Console
from rich.table import Table

from chaos.judging import Bars
from chaos.trial import Trial


def show(console: Console, alone: Trial, trials: Sequence[Trial], bars: Bars) -> None:
    """Print what the canary saw, what the server said, and what was missed."""
    table = Table(
        box=box.SIMPLE_HEAD,
        title="What the canary saw; times in ms, the longest or p99",
        pad_edge=False,
    )
    table.add_column("attack", no_wrap=True)
    for title in (
        *("gap", "missed/due", "dropped", "ping", "walk_to", "chat", "join", "lag"),
        *("ticks/s", "cpu %", "MB", "most", "after"),
    ):
        table.add_column(title, justify="right", no_wrap=True)
    table.add_column("", no_wrap=True)
    for trial in (alone, *trials):
        table.add_row(*_row(trial))
    console.print(table)
    console.print(
        f"bars: gap {bars.gap_ms:.0f} ms, walk_to {bars.way_ms:.0f} ms, nothing dropped,"
        " everyone let in and heard, memory +5 %, attackers named",
        highlight=False,
    )
    for trial in trials:
        _show_words(console, trial)


def _row(trial: Trial) -> list[str]:
    seen = trial.sighting
    verdict = "missed" if trial.missed else "ok"
    return [
        trial.attack or "(alone)",
        f"{seen.gap_ms:.0f}",
        f"{max(seen.due - seen.snapshots, 0)}/{seen.due}",
        str(seen.dropped),
        *(f"{each:.0f}" for each in (seen.ping_ms, seen.way_ms, seen.chat_ms, seen.join_ms)),
        f"{seen.own_lag_ms:.0f}",
        f"{trial.ticks_per_s:.1f}",
        f"{100 * trial.processor:.0f}",
        *(
            f"{each:.0f}"
            for each in (trial.memory_before_mb, trial.memory_most_mb, trial.memory_after_mb)
        ),
        verdict if trial.attack else "",
    ]


def _show_words(console: Console, trial: Trial) -> None:
    said = "; ".join(trial.lines) or "nothing"
    counted = ", ".join(
        f"{name.removeprefix('esplanade_')} {value:g}" for name, value in trial.named.items()
    )
    did = ", ".join(f"{name} {value}" for name, value in trial.counts.items())
    for line in (
        f"\n{trial.attack}",
        f"  it did:   {did or 'nothing'}",
        f"  log:      {said}",
        f"  metrics:  {counted or 'nothing'}",
        *(f"  MISSED    {bar}" for bar in trial.missed),
    ):
        console.print(line, highlight=False, markup=False, soft_wrap=True)


def write_json(path: Path, alone: Trial, trials: Sequence[Trial], bars: Bars) -> None:
    """Write everything that was seen, the canary alone first."""
    figures: dict[str, Any] = {
        "bars": dataclasses.asdict(bars),
        "alone": dataclasses.asdict(alone),
        "attacks": [dataclasses.asdict(trial) for trial in trials],
    }
    path.write_text(json.dumps(figures, indent=1) + "\n")

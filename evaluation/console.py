"""What all kinds of evaluation share: recordings that were named, progress, files, faults."""

import argparse
import json
import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from esplanade.evaluation.ledger import Ledger
from esplanade.evaluation.runner import Result, run_trials
from esplanade.evaluation.trials import Source, Trial

_ESTIMATE_OVER_S = 300.0
"""Some recordings take longer than others: the time that is left is estimated over many."""

_PAGE = 200
"""Columns of a file or pipe: nothing is cut off there."""


class UsageError(Exception):
    """What was asked for cannot be done; the message says what and why."""


def output() -> Console:
    """Where tables go: on a terminal as wide as that is."""
    console = Console()
    return console if console.is_terminal else Console(width=_PAGE)


def named_sources(options: argparse.Namespace) -> dict[Source, str]:
    """Recordings, with their own names, or their paths where these are the same."""
    if options.walls is not None and len(options.crowds) > 1:
        raise UsageError("--walls belongs to one recording; name them NAME.walls.json beside each")
    sources = dict.fromkeys(
        Source(path, options.walls, options.fps, options.interp) for path in options.crowds
    )
    names = {source: source.read()[0].name for source in sources}
    shared = {name for name in names.values() if list(names.values()).count(name) > 1}
    return {s: str(s.path.with_suffix("")) if n in shared else n for s, n in names.items()}


def check_targets(options: argparse.Namespace) -> None:
    """Say now, not after an hour, that nothing could be written."""
    for option, path in (("json", options.json), ("ledger", options.ledger)):
        if path is not None and not path.parent.is_dir():
            raise UsageError(f"--{option}: there is no folder {path.parent}")
    if options.plots is not None:
        try:
            options.plots.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise UsageError(f"--plots: {error}") from None


def walk(trials: Sequence[Trial], options: argparse.Namespace) -> list[Result]:
    """Run all trials before the eyes of who waits for them."""
    for trial in trials:
        if not trial.episodes:
            raise UsageError(f"{trial.source.path}: nobody in it makes a trip that can be judged")
    with Ledger(options.ledger) as ledger, progress() as shown:
        task = shown.add_task("walking", total=sum(len(trial.episodes) for trial in trials))
        try:
            return run_trials(trials, options.processes, lambda n: shown.advance(task, n), ledger)
        except KeyboardInterrupt:
            if options.ledger is not None:
                shown.console.print(
                    f"interrupted; {options.ledger} has what was walked: the same command goes on"
                )
            raise


def write_json(path: Path, figures: Mapping[str, Any]) -> None:
    """Write what was measured; null stands for what is not finite."""
    try:
        path.write_text(json.dumps(_plain(figures), indent=1, allow_nan=False) + "\n")
    except OSError as error:
        raise UsageError(f"--json: {error}") from None


def progress() -> Progress:
    """A bar on the error output, gone when all is done."""
    return Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
        console=Console(stderr=True),
        transient=True,
        speed_estimate_period=_ESTIMATE_OVER_S,
    )


def _plain(value: Any) -> Any:
    """As JSON has it."""
    match value:
        case Mapping():
            return {name: _plain(part) for name, part in value.items()}
        case list() | tuple():
            return [_plain(part) for part in value]
        case float() if not math.isfinite(value):
            return None
    return value

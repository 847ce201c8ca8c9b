"""`esplanade evaluate`: how actors, or predictions, do among recorded people."""

import argparse
import json
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from pydantic import ValidationError
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from actors import ActorParameters
from evaluation import forecast_report, plotting, report
from evaluation.options import parser
from evaluation.policies import PolicyError
from evaluation.rules import Rules
from evaluation.runner import Result, Source, plan_trials, ready_policy, run_trials
from recordings import RecordingError

EXIT_WELL: Final = 0
EXIT_FAILED: Final = 1
EXIT_USAGE: Final = 2


class UsageError(Exception):
    """What was asked for cannot be done; the message says what and why."""


def run(argv: Sequence[str]) -> int:
    """Evaluate as the command line says; returns the exit code."""
    options = parser().parse_args(argv)
    try:
        return _forecasts(options) if options.prediction or options.fit else _trips(options)
    except (UsageError, RecordingError, PolicyError) as error:
        print(f"esplanade evaluate: {error}", file=sys.stderr)
        return EXIT_USAGE


def _trips(options: argparse.Namespace) -> int:
    """Walk all episodes, show and write what came of them."""
    parameters = _parameters(options.set)
    sources = _sources(options)
    names = _names(sources)
    _check_targets(options)
    if options.plots is not None:
        plotting.require_matplotlib()
    rules = Rules(max_acceleration_mps2=options.a_max)
    policies = list(dict.fromkeys(options.policy))
    trials = plan_trials(sources, policies, rules, options.episodes, options.seed, parameters)
    for trial in trials:
        if not trial.episodes:
            raise UsageError(f"{trial.source.path}: nobody in it makes a trip that can be judged")
    drawn = _numbers(options.plot_episodes, min(len(trial.episodes) for trial in trials))
    with _progress() as progress:
        task = progress.add_task("walking", total=sum(len(trial.episodes) for trial in trials))
        results = run_trials(trials, options.processes, lambda n: progress.advance(task, n))
    rows = report.summaries(results, names)
    report.show(Console(), rows)
    if options.json is not None:
        settings = {**rules.__dict__, "seed": options.seed, "interpolation": options.interp}
        _write(options.json, report.figures(results, rows, names, {**settings, **parameters}))
    if options.plots is not None:
        _draw(options.plots, drawn, results, names)
    failed = any(score.failed for result in results for score in result.scores)
    return EXIT_FAILED if options.strict and failed else EXIT_WELL


def _forecasts(options: argparse.Namespace) -> int:
    """Hold predictions against what people did."""
    sources = _sources(options)
    names = _names(sources)
    _check_targets(options)
    crowds = [(names[source], *source.read()) for source in sources]
    rows, fits = forecast_report.measure(crowds, options.sample_s, fit=options.fit)
    if not rows:
        raise UsageError("nobody in it is followed for long enough to judge a prediction")
    forecast_report.show(Console(), rows, fits)
    if options.json is not None:
        _write(options.json, forecast_report.figures(rows, fits, options.sample_s))
    return EXIT_WELL


def _sources(options: argparse.Namespace) -> list[Source]:
    if options.walls is not None and len(options.crowds) > 1:
        raise UsageError("--walls belongs to one recording; name them NAME.walls.json beside each")
    return list(
        dict.fromkeys(
            Source(path, options.walls, options.fps, options.interp) for path in options.crowds
        )
    )


def _names(sources: Sequence[Source]) -> dict[Source, str]:
    """What recordings are called: their own names, or their paths where these are the same."""
    names = {source: source.read()[0].name for source in sources}
    shared = {name for name in names.values() if list(names.values()).count(name) > 1}
    return {s: str(s.path.with_suffix("")) if n in shared else n for s, n in names.items()}


def _parameters(changes: Sequence[str]) -> dict[str, Any]:
    """Checked changes of the actor's parameters from NAME=VALUE."""
    found = dict(change.partition("=")[::2] for change in changes)
    try:
        return ActorParameters(**found).model_dump(include=set(found))
    except ValidationError as error:
        fault = error.errors(include_url=False)[0]
        name = ".".join(map(str, fault["loc"]))
        raise UsageError(f"--set {name}: {fault['msg']}") from None


def _check_targets(options: argparse.Namespace) -> None:
    """Say now, not after an hour, that nothing could be written."""
    if options.json is not None and not options.json.parent.is_dir():
        raise UsageError(f"--json: there is no folder {options.json.parent}")
    if options.plots is not None:
        try:
            options.plots.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise UsageError(f"--plots: {error}") from None


def _numbers(text: str, count: int) -> frozenset[int] | None:
    """Numbers of episodes to draw; None for those that failed."""
    if text == "failed":
        return None
    try:
        numbers = frozenset(int(part) for part in text.split(","))
    except ValueError:
        raise UsageError(f"--plot-episodes: {text!r} is neither `failed` nor numbers") from None
    if not numbers <= set(range(count)):
        raise UsageError(f"--plot-episodes: {text}, but there are episodes 0 to {count - 1}")
    return numbers


def _draw(
    folder: Path,
    numbers: frozenset[int] | None,
    results: Sequence[Result],
    names: Mapping[Source, str],
) -> None:
    chosen = [
        (result.trial, score.number)
        for result in results
        for score in result.scores
        if (score.failed if numbers is None else score.number in numbers)
    ]
    with _progress() as progress:
        task = progress.add_task("drawing", total=len(chosen))
        for trial, number in chosen:
            name = names[trial.source]
            stem = f"{name.replace('/', '_')}-{trial.policy}-{number:03d}"
            (episode,) = (e for e in trial.episodes if e.number == number)
            plotting.draw_episode(
                folder / f"{stem}.png",
                f"{name}, {trial.policy}, episode {number}",
                trial.source.ground(trial.rules.tick_s),
                episode,
                ready_policy(trial),
                trial.rules,
            )
            progress.advance(task)


def _write(path: Path, figures: Mapping[str, Any]) -> None:
    try:
        path.write_text(json.dumps(figures, indent=1, allow_nan=False) + "\n")
    except OSError as error:
        raise UsageError(f"--json: {error}") from None


def _progress() -> Progress:
    return Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
        console=Console(stderr=True),
        transient=True,
    )

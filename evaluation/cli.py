"""`esplanade evaluate`: how actors, or predictions, do among recorded people."""

import argparse
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

from esplanade.evaluation import forecast_report, plotting, report
from esplanade.evaluation.console import (
    UsageError,
    check_targets,
    named_sources,
    output,
    progress,
    walk,
    write_json,
)
from esplanade.evaluation.ledger import LedgerError
from esplanade.evaluation.options import parser
from esplanade.evaluation.policies import PolicyError
from esplanade.evaluation.rules import Rules
from esplanade.evaluation.runner import Result, ready_policy
from esplanade.evaluation.settings import SettingError, read_changes
from esplanade.evaluation.studies import command
from esplanade.evaluation.trials import Source, plan_trials
from esplanade.recordings import RecordingError

EXIT_WELL: Final = 0
EXIT_FAILED: Final = 1
EXIT_USAGE: Final = 2


def run(argv: Sequence[str]) -> int:
    """Evaluate as the command line says; returns the exit code."""
    options = parser().parse_args(argv)
    try:
        _check_studies(options)
        if options.sensitivity:
            command.show_sensitivity(options)
        elif options.tune:
            command.show_tuning(options)
        elif options.prediction or options.fit:
            _forecasts(options)
        elif _trips(options) and options.strict:
            return EXIT_FAILED
    except (UsageError, SettingError, LedgerError, RecordingError, PolicyError) as error:
        print(f"esplanade evaluate: {error}", file=sys.stderr)
        return EXIT_USAGE
    return EXIT_WELL


def _check_studies(options: argparse.Namespace) -> None:
    """Nothing is asked for that would be left aside."""
    if options.vary and not (options.sensitivity or options.tune):
        raise UsageError("--vary is for --sensitivity and --tune")
    if options.candidates is not None and not options.tune:
        raise UsageError("--candidates is for --tune")


def _trips(options: argparse.Namespace) -> bool:
    """Walk all episodes, show and write what came of them; returns whether one failed."""
    settings = read_changes(options.set)
    names = named_sources(options)
    check_targets(options)
    if options.plots is not None:
        plotting.require_matplotlib()
    rules = Rules(max_acceleration_mps2=options.a_max)
    policies = list(dict.fromkeys(options.policy))
    trials = plan_trials(list(names), policies, rules, options.episodes, options.seed, settings)
    fewest = min(len(trial.episodes) for trial in trials)
    drawn = _numbers(options.plot_episodes, fewest)
    results = walk(trials, options)
    rows = report.summaries(results, names)
    report.show(output(), rows)
    if options.json is not None:
        told = {**rules.__dict__, "seed": options.seed, "interpolation": options.interp}
        write_json(options.json, report.figures(results, rows, names, {**told, **settings}))
    if options.plots is not None:
        _draw(options.plots, drawn, results, names)
    return any(score.failed for result in results for score in result.scores)


def _forecasts(options: argparse.Namespace) -> None:
    """Hold predictions against what people did."""
    names = named_sources(options)
    check_targets(options)
    crowds = [(name, *source.read()) for source, name in names.items()]
    rows, fits = forecast_report.measure(crowds, options.sample_s, fit=options.fit)
    if not rows:
        raise UsageError("nobody in it is followed for long enough to judge a prediction")
    forecast_report.show(output(), rows, fits)
    if options.json is not None:
        write_json(options.json, forecast_report.figures(rows, fits, options.sample_s))


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
    with progress() as shown:
        task = shown.add_task("drawing", total=len(chosen))
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
            shown.advance(task)

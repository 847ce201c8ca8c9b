"""`esplanade evaluate`: how actors, or predictions, do among recorded people."""

import shlex
from argparse import Namespace
from collections.abc import Mapping, Sequence

from esplanade.commandline import exit_codes
from esplanade.commandline.errors import UsageError
from esplanade.commandline.output import console, made_folder, write_json
from esplanade.commandline.progress import progress
from esplanade.evaluation import forecast_report, plotting, report, report_files, tables
from esplanade.evaluation.console import named_sources, rules_of, walk
from esplanade.evaluation.dask_cluster import ClusterError
from esplanade.evaluation.guidelines import MEASURES
from esplanade.evaluation.policies import PolicyError
from esplanade.evaluation.runner import TrialResult, ready_policy
from esplanade.evaluation.score_cache import ScoreCacheError
from esplanade.evaluation.settings import SettingError, read_changes
from esplanade.evaluation.studies import command
from esplanade.evaluation.summaries import differences, rows_of
from esplanade.evaluation.trajectory_files import EpisodeFiles
from esplanade.evaluation.trials import Source, plan_trials
from esplanade.recordings import RecordingError
from esplanade.recordings.writing import WritingError


def run(options: Namespace) -> int:
    """Evaluate as the options say; returns the exit code."""
    try:
        if options.sensitivity:
            command.show_sensitivity(options)
        elif options.tune:
            command.show_tuning(options)
        elif options.prediction or options.fit:
            _forecasts(options)
        elif _trips(options) and options.strict:
            return exit_codes.FAILED
    except (
        ClusterError,
        PolicyError,
        RecordingError,
        ScoreCacheError,
        SettingError,
        WritingError,
    ) as error:
        raise UsageError(str(error)) from None
    return exit_codes.OK


def _trips(options: Namespace) -> bool:
    """Walk all episodes, show and write the results; returns whether one failed."""
    settings = read_changes(options.set)
    names = named_sources(options)
    if options.plots is not None:
        made_folder("--plots", options.plots)
        plotting.require_matplotlib()
    rules = rules_of(options)
    policies = list(dict.fromkeys(options.policy))
    trials = plan_trials(
        list(names),
        policies,
        rules,
        options.episodes,
        options.seed,
        settings,
        options.policy_option,
    )
    _check_numbers(options.plot_episodes, min(len(trial.episodes) for trial in trials))
    results = walk(trials, options, _files(options, names))
    reacting = rules.people == "reacting"
    chosen = [MEASURES[name] for name in options.measures]
    rows = rows_of(results, names, options.seed, chosen)
    compared = differences(results, options.seed, reacting=reacting)
    shown = tables.of_recordings(rows, reacting=reacting)
    shown += tables.of_differences(results[0].trial.label, compared)
    report.show(console(), shown)
    report.show_faults(console(), results, names)
    if options.report is not None:
        report_files.write(
            options.report, shown, shlex.join([*options.prog.split(), *options.words])
        )
    if options.json is not None:
        told = {**rules.__dict__, "seed": options.seed, "interpolation": options.interp}
        figures = report.figures(results, rows, compared, names, {**told, **settings})
        write_json("--json", options.json, figures)
    if options.plots is not None:
        _draw(options, results, names)
    return any(score.failed for result in results for score in result.scores)


def _files(options: Namespace, names: Mapping[Source, str]) -> EpisodeFiles | None:
    """The files of episodes, where they are wanted."""
    if options.trajectories is None:
        return None
    command = shlex.join([*options.prog.split(), *options.words])
    by_path = {source.path: name for source, name in names.items()}
    return EpisodeFiles(options.trajectories, by_path, command)


def _forecasts(options: Namespace) -> None:
    """Compare predictions with what people did."""
    names = named_sources(options)
    crowds = [(name, *source.read()) for source, name in names.items()]
    rows, fits = forecast_report.measure(crowds, options.sample_s, fit=options.fit)
    if not rows:
        raise UsageError("nobody in it is followed for long enough to judge a prediction")
    forecast_report.show(console(), rows, fits)
    if options.json is not None:
        figures = forecast_report.figures(rows, fits, options.sample_s)
        write_json("--json", options.json, figures)


def _check_numbers(numbers: frozenset[int] | None, count: int) -> None:
    """Whether there are episodes of these numbers."""
    if numbers is not None and not numbers <= set(range(count)):
        told = ",".join(map(str, sorted(numbers)))
        raise UsageError(f"--plot-episodes: {told}, but there are episodes 0 to {count - 1}")


def _draw(options: Namespace, results: Sequence[TrialResult], names: Mapping[Source, str]) -> None:
    numbers: frozenset[int] | None = options.plot_episodes
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
            stem = f"{name.replace('/', '_')}-{trial.label}-{number:03d}"
            (episode,) = (e for e in trial.episodes if e.number == number)
            plotting.draw_episode(
                options.plots / f"{stem}.{options.picture or 'png'}",
                f"{name}, {trial.label}, episode {number}",
                trial.source.environment(trial.rules.tick_s),
                episode,
                ready_policy(trial),
                trial.rules,
            )
            shown.advance(task)

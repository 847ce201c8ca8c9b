"""The recordings that the command line names, and the run of trials with a progress bar."""

from argparse import Namespace
from collections.abc import Sequence

from esplanade.commandline.errors import UsageError
from esplanade.commandline.progress import progress
from esplanade.commandline.recording_settings import tell_recording
from esplanade.evaluation.runner import TrialResult, run_trials
from esplanade.evaluation.score_cache import ScoreCache
from esplanade.evaluation.trials import Source, Trial
from esplanade.recordings import Given


def named_sources(options: Namespace) -> dict[Source, str]:
    """The recordings of the command line and their names; equal names are replaced by paths."""
    sources = dict.fromkeys(
        Source(
            path,
            options.walls,
            Given(
                options.fps,
                options.unit,
                options.scale,
                options.strict,
                tuple(options.columns.split(",")) if options.columns else (),
            ),
            options.interp,
        )
        for path in options.crowds
    )
    for source in sources:
        tell_recording("esplanade evaluate", str(source.path), source.read()[0].report)
    names = {source: source.read()[0].name for source in sources}
    shared = {name for name in names.values() if list(names.values()).count(name) > 1}
    return {s: str(s.path.with_suffix("")) if n in shared else n for s, n in names.items()}


def walk(trials: Sequence[Trial], options: Namespace) -> list[TrialResult]:
    """Run all trials with a progress bar.

    Raises
    ------
    UsageError
        A recording has no episodes.
    """
    for trial in trials:
        if not trial.episodes:
            raise UsageError(f"{trial.source.path}: it has no trip that can be an episode")
    with ScoreCache(options.score_cache) as score_cache, progress(time_left=True) as shown:
        task = shown.add_task(
            "running episodes", total=sum(len(trial.episodes) for trial in trials)
        )
        try:
            return run_trials(
                trials, options.processes, lambda n: shown.advance(task, n), score_cache
            )
        except KeyboardInterrupt:
            if options.score_cache is not None:
                shown.console.print(
                    f"interrupted; the same command continues from {options.score_cache}"
                )
            raise

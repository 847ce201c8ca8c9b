"""The recordings that the command line names, and the run of trials with a progress bar."""

from argparse import Namespace
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import replace

from esplanade.commandline.errors import UsageError
from esplanade.commandline.progress import progress
from esplanade.commandline.recording_settings import tell_recording
from esplanade.evaluation.dask_cluster import DaskCluster
from esplanade.evaluation.rules import Rules
from esplanade.evaluation.runner import TrialResult, run_trials
from esplanade.evaluation.score_cache import ScoreCache
from esplanade.evaluation.trajectory_files import EpisodeFiles
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


def places_of(options: Namespace, names: Mapping[Source, str]) -> dict[Source, str]:
    """The place of each recording: its own, or that which --place names.

    Raises
    ------
    UsageError
        A recording is not among those of the command line, or is named for two places.
    """
    at: dict[str, str] = {}
    for place, recordings in options.place:
        for name in recordings:
            if name not in names.values():
                told = ", ".join(names.values())
                raise UsageError(f"--place: there is no recording {name}, but {told}")
            if at.setdefault(name, place) != place:
                raise UsageError(f"--place: {name} was recorded at {at[name]} or at {place}")
    return {source: at.get(name, name) for source, name in names.items()}


def rules_of(options: Namespace) -> Rules:
    """The rules of the command line."""
    rules = Rules(max_acceleration_mps2=options.a_max)
    if options.people == "recorded":
        return rules
    reaction = rules.reaction if options.reaction is None else options.reaction
    return replace(rules, people="reacting", reaction=reaction, people_seed=options.seed)


def walk(
    trials: Sequence[Trial], options: Namespace, files: EpisodeFiles | None = None
) -> list[TrialResult]:
    """Run all trials with a progress bar, on this machine or on a cluster.

    Raises
    ------
    UsageError
        A recording has no episodes.
    ClusterError
        The cluster cannot be used.
    """
    for trial in trials:
        if not trial.episodes:
            raise UsageError(f"{trial.source.path}: it has no trip that can be an episode")
    with (
        ScoreCache(options.score_cache) as score_cache,
        _cluster(options) as cluster,
        progress(time_left=True) as shown,
    ):
        task = shown.add_task(
            "running episodes", total=sum(len(trial.episodes) for trial in trials)
        )
        try:
            return run_trials(
                trials,
                options.processes,
                lambda n: shown.advance(task, n),
                score_cache,
                files,
                cluster,
            )
        except KeyboardInterrupt:
            if options.score_cache is not None:
                shown.console.print(
                    f"interrupted; the same command continues from {options.score_cache}"
                )
            raise


@contextmanager
def _cluster(options: Namespace) -> Iterator[DaskCluster | None]:
    """The cluster that --on names, if any."""
    if options.on is None:
        yield None
        return
    cluster = DaskCluster(options.on)
    try:
        yield cluster
    finally:
        cluster.close()

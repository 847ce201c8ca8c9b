"""What all kinds of evaluation share: recordings that were named, and walking with a bar."""

from argparse import Namespace
from collections.abc import Sequence

from esplanade.commandline.errors import UsageError
from esplanade.commandline.progress import progress
from esplanade.evaluation.ledger import Ledger
from esplanade.evaluation.runner import Result, run_trials
from esplanade.evaluation.trials import Source, Trial


def named_sources(options: Namespace) -> dict[Source, str]:
    """Recordings, with their own names, or their paths where these are the same."""
    sources = dict.fromkeys(
        Source(path, options.walls, options.fps, options.interp) for path in options.crowds
    )
    names = {source: source.read()[0].name for source in sources}
    shared = {name for name in names.values() if list(names.values()).count(name) > 1}
    return {s: str(s.path.with_suffix("")) if n in shared else n for s, n in names.items()}


def walk(trials: Sequence[Trial], options: Namespace) -> list[Result]:
    """Run all trials before the eyes of who waits for them."""
    for trial in trials:
        if not trial.episodes:
            raise UsageError(f"{trial.source.path}: nobody in it makes a trip that can be judged")
    with Ledger(options.ledger) as ledger, progress(time_left=True) as shown:
        task = shown.add_task("walking", total=sum(len(trial.episodes) for trial in trials))
        try:
            return run_trials(trials, options.processes, lambda n: shown.advance(task, n), ledger)
        except KeyboardInterrupt:
            if options.ledger is not None:
                shown.console.print(
                    f"interrupted; {options.ledger} has what was walked: the same command goes on"
                )
            raise

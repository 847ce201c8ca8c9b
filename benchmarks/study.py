"""Compares our actor with its peers among recorded and reacting people, on every recording there.

    python -m benchmarks.study                                      all recordings, all peers
    python -m benchmarks.study --episodes 20 --policy straight orca --people reacting
    python -m benchmarks.study zara1.csv hotel.csv --score-cache done.jsonl --report study.html

It prints contacts, times, what is imposed on people, and the milliseconds of a decision, each with
its 95 % interval, and how each peer differs from our actor in the same episodes. For reacting
people it then asks whether our actor imposes least: whether the difference of each peer is beyond
chance, all of them together (Bonferroni), also if any one place is left out. Recordings whose names
differ only by digits at the end were made at one place.

Without named recordings it takes the `.csv` files in `crowds/` of the folder that
`ESPLANADE_RECORDINGS` names; docs/evaluation.md says where such files come from.
"""

import argparse
import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path
from typing import Final

from benchmarks._detour_policy import detour
from benchmarks._node_process import recast_missing
from rich.console import Console

from esplanade.commandline.progress import progress
from esplanade.evaluation import report, report_files, tables
from esplanade.evaluation.measures import IMPOSED
from esplanade.evaluation.policies import PolicyError
from esplanade.evaluation.rules import Rules
from esplanade.evaluation.runner import TrialResult, run_trials
from esplanade.evaluation.score_cache import ScoreCache, ScoreCacheError
from esplanade.evaluation.summaries import POOLED, differences, rows_of
from esplanade.evaluation.tables import Table
from esplanade.evaluation.trials import Source, plan_trials
from esplanade.recordings import RecordingError

OURS: Final = "esplanade"
PACKAGES: Final = {
    "straight": None,
    "discs": None,
    "orca": "pyrvo",
    "jupedsim-speed": "jupedsim",
    "jupedsim-anticipation": "jupedsim",
    "jupedsim-forces": "jupedsim",
}
"""The peers, and the package that each needs."""

PAGE_WIDTH: Final = 260
"""Columns of a table in a file or a pipe."""
BESIDE: Final = Path(__file__).parents[2] / "shared" / "data"


def main(argv: Sequence[str] | None = None) -> int:
    options = parser().parse_args(argv)
    console = Console(width=None if sys.stdout.isatty() else PAGE_WIDTH)
    sources = [Source(path) for path in options.recordings or recordings()]
    if not sources:
        sys.exit("there is no recording: set ESPLANADE_RECORDINGS to the folder of crowds/*.csv")
    shown: list[Table] = []
    claim: list[str] = []
    try:
        with policies(options.policy) as chosen:
            for people in options.people:
                results = walked(sources, chosen, options, people)
                shown += compared(results, options.seed, people)
                if people == "reacting":
                    claim = claimed(results, options.seed)
    except (PolicyError, RecordingError, ScoreCacheError) as error:
        sys.exit(f"{error}")
    report.show(console, shown)
    for line in claim:
        console.print(line, highlight=False)
    if options.report is not None:
        report_files.write(options.report, shown, "python -m benchmarks.study")
    return 0


def parser() -> argparse.ArgumentParser:
    made = argparse.ArgumentParser(
        prog="python -m benchmarks.study",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    made.add_argument("recordings", metavar="CROWD", nargs="*", type=Path)
    made.add_argument(
        "--policy", nargs="+", help="peers [default: all that are installed, detour among them]"
    )
    made.add_argument(
        "--people", nargs="+", default=["recorded", "reacting"], choices=["recorded", "reacting"]
    )
    made.add_argument("--episodes", type=int, default=40, help="of each recording [default: 40]")
    made.add_argument("--seed", type=int, default=0)
    made.add_argument("--processes", type=int, default=2)
    made.add_argument("--score-cache", type=Path, help="keep scores; the study goes on from there")
    made.add_argument("--report", type=Path, help="write the tables: .html, .tex or .csv")
    return made


@contextmanager
def policies(named: Sequence[str] | None) -> Iterator[list[str]]:
    """Our actor and the peers that are named, or else all that are installed, with DetourCrowd."""
    if named is not None:
        yield list(dict.fromkeys([OURS, *named]))
        return
    found = [name for name, package in PACKAGES.items() if package is None or find_spec(package)]
    for name in PACKAGES.keys() - found:
        print(f"left out: {name} needs the package {PACKAGES[name]}", file=sys.stderr)
    with ExitStack() as stack:
        if (missing := recast_missing()) is None:
            found.append(stack.enter_context(detour()))
        else:
            print(f"left out: detour. {missing}", file=sys.stderr)
        yield [OURS, *found]


def recordings() -> list[Path]:
    """All recorded crowds that are there."""
    data = Path(os.environ.get("ESPLANADE_RECORDINGS", BESIDE))
    return sorted((data / "crowds").glob("*.csv"))


def place_of(source: Source) -> str:
    """The place of a recording: its name without digits at the end."""
    return source.path.stem.rstrip("0123456789")


def walked(
    sources: Sequence[Source], chosen: Sequence[str], options: argparse.Namespace, people: str
) -> list[TrialResult]:
    """All episodes of our actor and its peers among such people."""
    rules = Rules()
    if people == "reacting":
        rules = replace(rules, people="reacting", people_seed=options.seed)
    trials = plan_trials(sources, chosen, rules, options.episodes, options.seed, {})
    with ScoreCache(options.score_cache) as score_cache, progress(time_left=True) as bar:
        total = sum(len(trial.episodes) for trial in trials)
        task = bar.add_task(f"among {people} people", total=total)
        return run_trials(trials, options.processes, lambda n: bar.advance(task, n), score_cache)


def compared(results: Sequence[TrialResult], seed: int, people: str) -> list[Table]:
    """The figures of all recordings together, and the differences from our actor."""
    names = {result.trial.source: result.trial.source.path.stem for result in results}
    reacting = people == "reacting"
    found = tables.of_recordings(rows_of(results, names, seed), reacting=reacting)
    found = [table for table in found if table.title == POOLED] or found
    found += tables.of_differences(OURS, differences(results, seed, reacting=reacting))
    return [table._replace(title=f"{table.title}, {people} people") for table in found]


def claimed(results: Sequence[TrialResult], seed: int) -> list[str]:
    """Whether our actor imposes less on people than each peer, whichever place is left out."""
    places = sorted({place_of(result.trial.source) for result in results})
    told, holds = [], True
    for left_out in [None, *places] if len(places) > 1 else [None]:
        kept = [result for result in results if place_of(result.trial.source) != left_out]
        excesses = {
            policy: of[IMPOSED] for policy, of in differences(kept, seed, reacting=True).items()
        }
        short = [policy for policy, excess in excesses.items() if not excess.interval.low > 0.0]
        holds &= not short
        where = "with all places" if left_out is None else f"without {left_out}"
        verdict = f"not beyond chance: {', '.join(short)}" if short else "least of all"
        told.append(f"displacement imposed by {OURS}, {where}: {verdict}")
    told.append(f"so that {OURS} imposes least {'holds' if holds else 'does not hold'}")
    return told


if __name__ == "__main__":
    raise SystemExit(main())

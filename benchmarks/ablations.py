"""The effect of each rule of planning: actors walk the same ways with the rule and without it.

    python -m benchmarks.ablations eth.csv hotel.csv zara1.csv students3.csv
    python -m benchmarks.ablations eth.csv --only perturbation lanes --episodes 20 --seeds 0

One actor at a time walks among the recorded people of each file, as in `esplanade evaluate`; and
two crowds of actors change sides through doorways, as in `python -m benchmarks.social`. Every row
is the difference to what the defaults do in the same episodes and at the same doorways, with the
95 % interval of a paired bootstrap, over pieces of time of each recording and over doorways. Bold
intervals leave out 0. Throughput is that of the actors who have come through, by second and metre
of width; those who have not by the end make it less. Without recordings only doorways are
compared.
"""

import argparse
import json
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final, NamedTuple

import numpy as np
from benchmarks import social
from benchmarks._swaps import SWAPS
from benchmarks._walks import Walks, judge
from rich import box
from rich.console import Console
from rich.progress import Progress
from rich.table import Table

from esplanade.evaluation.measures import MEASURES, sample
from esplanade.evaluation.rules import Rules
from esplanade.evaluation.runner import run_trials
from esplanade.evaluation.score_cache import ScoreCache
from esplanade.evaluation.settings import check
from esplanade.evaluation.trials import Source, plan_trials
from esplanade.stats import Sample, interval_of, means_of, resampled_means

OFF: Final = 1_000_000
"""A number of actors that never come together."""


class Ablation(NamedTuple):
    """One rule, and the settings that switch it off."""

    name: str
    settings: Mapping[str, Any]
    alone: bool
    """Whether one actor among people has the rule."""
    together: bool
    """Whether actors have it among each other."""


ABLATIONS: Final = (
    Ablation("perturbation", {"rules.perturbs": False}, True, False),
    Ablation("cost so far in the key", {"rules.greedy": True}, True, True),
    Ablation("new paths only if cheaper", {"rules.weighs_paths": False}, True, True),
    Ablation("hysteresis", {"hysteresis_s": 0.0}, True, True),
    Ablation("risk fades with time", {"foresight_s": 60.0}, True, False),
    Ablation("deviation stops growing", {"risk.reaction_s": 3.6}, True, False),
    Ablation("bodies sway", {"risk.sway_m": 0.0}, True, False),
    Ablation("risk beyond contact", {"risk.comfort": 0.0}, True, False),
    Ablation("closing speed", {"closing_weight": 0.0}, True, False),
    Ablation("turning", {"turn_weight": 0.0}, True, True),
    Ablation("walls", {"wall_weight": 0.0}, True, True),
    Ablation("lost time is made up", {"catch_up": 0.0}, True, True),
    Ablation("expected cost ahead", {"rules.likely_part": 0.0}, True, True),
    Ablation("going on from illegal paths", {"rules.goes_on": False}, True, True),
    Ablation("fewer moves far ahead", {"rules.fine_steps": 1000}, True, True),
    Ablation("last check", {"rules.checks_steps": False}, True, False),
    Ablation("turned or newest velocity", {"rules.minds_turns": False}, True, False),
    Ablation("slower toward whom it touches", {"contact_closing_s": 0.0}, True, False),
    Ablation("reservations", {"rules.reserves": False}, False, True),
    Ablation("a price of others' yielding", {"rules.yielding_weight": 0.0}, False, True),
    Ablation("evading", {"rules.evading_slices": 0}, False, True),
    Ablation("room to those who come", {"rules.meeting_weight": 0.0}, False, True),
    Ablation("room in a queue", {"rules.queue_weight": 0.0}, False, True),
    Ablation("order in jams", {"rules.jam_actors": OFF}, False, True),
    Ablation("keeping right", {"keep_right_weight": 0.0}, False, True),
    Ablation("order at passages", {"rules.orders_passages": False}, False, True),
    Ablation("waiting counts", {"rules.waiting_mps": 0.0}, False, True),
    Ablation("all at contested passages", {"rules.contested_actors": OFF}, False, True),
    Ablation("sidesteps", {"rules.sidesteps": False}, False, True),
)

COLUMNS: Final = (
    ("contacts, %", 2),
    ("within 0.2 m, s", 3),
    ("time", 4),
    ("persons/(s·m)", 3),
    ("time at doors", 3),
    ("stuck, %", 1),
)
"""Three figures of one actor among people, then three of actors at doorways; decimals of each."""
ALONE: Final = 3


@dataclass(frozen=True)
class Figures:
    """Figures measured with some settings."""

    alone: list[Sample]
    """Three figures of the episodes of each recording."""
    together: list[Sample]
    """Three figures of the doorways, each by itself; empty where none was measured."""


def main(argv: Sequence[str] | None = None) -> int:
    options = parser().parse_args(argv)
    chosen = [a for a in ABLATIONS if not options.only or a.name in options.only]
    sources = [Source(path) for path in options.crowds]
    if not sources:
        chosen = [a for a in chosen if a.together]
    with (
        ScoreCache(options.score_cache) as cache,
        Progress(
            console=Console(stderr=True), disable=not sys.stderr.isatty(), transient=True
        ) as shown,
    ):
        task = shown.add_task("ablations", total=1 + len(chosen))

        def measured(settings: Mapping[str, Any], alone: bool, together: bool) -> Figures:
            found = measure(sources if alone else [], settings, together, options, cache)
            shown.advance(task)
            return found

        default = measured({}, True, True)
        rows = {a.name: measured(a.settings, a.alone, a.together) for a in chosen}
    lines = {name: compared(found, default, options.seed) for name, found in rows.items()}
    show(lines, summed(default), options.markdown)
    if options.json is not None:
        told = {"default": summed(default), "differences": lines}
        options.json.write_text(json.dumps(told, indent=1, ensure_ascii=False) + "\n")
    return 0


def parser() -> argparse.ArgumentParser:
    """The options."""
    made = argparse.ArgumentParser(prog="python -m benchmarks.ablations", description=__doc__)
    made.formatter_class = argparse.RawDescriptionHelpFormatter
    made.add_argument("crowds", metavar="CROWD", nargs="*", type=Path)
    made.add_argument("--only", metavar="RULE", nargs="+", choices=[a.name for a in ABLATIONS])
    made.add_argument("--episodes", type=int, default=100, help="of each recording")
    made.add_argument("--processes", type=int, default=2)
    made.add_argument("--score-cache", type=Path, metavar="F", help="as of `esplanade evaluate`")
    made.add_argument("--actors", type=int, default=30, help="at each doorway")
    made.add_argument("--doors", type=float, nargs="+", default=[0.9, 1.2, 2.0], metavar="M")
    made.add_argument("--seeds", type=int, nargs="+", default=[0, 1], help="of each doorway")
    made.add_argument("--until", type=float, default=60.0, metavar="S", help="simulated seconds")
    made.add_argument("--seed", type=int, default=0, help="of episodes and resamples")
    made.add_argument("--markdown", action="store_true", help="print the table as Markdown")
    made.add_argument("--json", type=Path, metavar="F")
    return made


def measure(
    sources: Sequence[Source],
    settings: Mapping[str, Any],
    together: bool,
    options: argparse.Namespace,
    cache: ScoreCache,
) -> Figures:
    """Walk all episodes, and come through all doorways."""
    checked = check(settings)
    results = run_trials(
        plan_trials(sources, ["esplanade"], Rules(), options.episodes, options.seed, checked),
        options.processes,
        lambda _: None,
        cache,
    )
    doors = [(door_m, seed) for door_m in options.doors for seed in options.seeds if together]
    through = [doorway(door_m, seed, checked, options) for door_m, seed in doors]
    return Figures(
        [sample(result.scores, MEASURES[:ALONE]) for result in results],
        [Sample.of(through, doors)] if through else [],
    )


def doorway(
    door_m: float, seed: int, settings: Mapping[str, Any], options: argparse.Namespace
) -> tuple[float, float, float]:
    """Persons a second and metre, time against that of each alone, and how many were stuck, %."""
    swap = SWAPS["doorway"](options.actors, door_m, np.random.default_rng(seed))
    walks, tick_ms = social.walk(swap, seed, options.until, settings=settings)
    verdict = judge(walks, tick_ms)
    if verdict.contacts:
        raise RuntimeError(f"actors touched each other with {dict(settings)}")
    return (
        throughput(walks, swap.scene.bounds[2] / 2.0, door_m),
        float(np.minimum(walks.time_ratios, options.until).mean()),
        100.0 * verdict.stuck / verdict.actors,
    )


def throughput(walks: Walks, middle_m: float, door_m: float) -> float:
    """Persons a second and metre of width from the first one's passing to the last one's, or to the
    end if some have not passed."""
    beyond = walks.positions[..., 0] > middle_m
    passed = beyond != beyond[0]
    ever = passed.any(axis=0)
    ticks = np.where(ever, passed.argmax(axis=0), len(passed))
    return float(ever.sum() / ((ticks.max() - ticks.min() + 1) * walks.tick_s) / door_m)


def summed(found: Figures) -> list[float | None]:
    """The mean figures, in the order of `COLUMNS`."""
    alone = means_of(found.alone, even=True).tolist() if found.alone else [None] * ALONE
    return [*alone, *means_of(found.together, even=True).tolist()]


def compared(
    found: Figures, default: Figures, seed: int
) -> list[tuple[float, float, float] | None]:
    """By column the difference to the defaults and its interval; None where none was measured."""
    made: list[tuple[float, float, float] | None] = [None] * len(COLUMNS)
    if found.alone:
        made[:ALONE] = _differences(found.alone, default.alone, seed)
    if found.together:
        made[ALONE:] = _differences(found.together, default.together, seed)
    return made


def _differences(
    found: Sequence[Sample], default: Sequence[Sample], seed: int
) -> list[tuple[float, float, float] | None]:
    """The paired differences of the figures and the interval of each by itself."""
    paired = [
        Sample(ours.values - theirs.values, ours.clusters)
        for ours, theirs in zip(found, default, strict=True)
    ]
    intervals = interval_of(resampled_means(paired, seed, even=True), paired)
    means = means_of(paired, even=True).tolist()
    return [(mean, *interval) for mean, interval in zip(means, intervals, strict=True)]


def show(
    lines: Mapping[str, Sequence[tuple[float, float, float] | None]],
    default: Sequence[float | None],
    markdown: bool,
) -> None:
    """Print the table, a row for each rule that is switched off."""
    heads = ["without", *(name for name, _ in COLUMNS)]
    rows = [["(defaults)", *map(_plain, default, COLUMNS)]]
    rows += [[name, *map(_cell, line, COLUMNS)] for name, line in lines.items()]
    if markdown:
        for row in (heads, ["---"] * len(heads), *rows):
            print("|", " | ".join(row), "|")
        return
    shown = Table(*heads, box=box.SIMPLE)
    for row in rows:
        shown.add_row(*(part.replace("**", "") for part in row))
    Console().print(shown)


def _plain(value: float | None, column: tuple[str, int]) -> str:
    return "–" if value is None else f"{value:.{column[1]}f}"


def _cell(found: tuple[float, float, float] | None, column: tuple[str, int]) -> str:
    if found is None:
        return "–"
    mean, low, high = (f"{value:+.{column[1]}f}" for value in found)
    told = f"{mean} [{low}, {high}]"
    return f"**{told}**" if found[1] > 0.0 or found[2] < 0.0 else told


if __name__ == "__main__":
    sys.exit(main())

"""`esplanade bots`: the command line, made from the fields of the settings."""

import argparse
import json
import signal
import sys
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final, get_args

from pydantic import ValidationError
from pydantic.fields import FieldInfo
from rich.console import Console

from esplanade.bots.address import refusal
from esplanade.bots.crew import Crew
from esplanade.bots.load import LoadJob
from esplanade.bots.progress import Progress
from esplanade.bots.replay import ReplayJob
from esplanade.bots.report import figures, show
from esplanade.bots.settings import ENV_PREFIX, BotsSettings
from esplanade.bots.tally import Tally
from esplanade.bots.worker import Job
from esplanade.recordings import Crowd, RecordingError, read_crowd

EXIT_WELL: Final = 0
EXIT_FAILED: Final = 1
EXIT_USAGE: Final = 2

WELL_FOLLOWED: Final = 0.99
"""A smaller share of samples near the recorded way than this wants an explanation."""

EXAMPLES: Final = """\
examples:
  esplanade bots                                   20 visitors walk about for a minute
  esplanade bots --count 200 --duration 60 --json load.json
  esplanade bots --url wss://plaza.example --count 5 --duration 0
  esplanade bots --replay zara1.csv                148 recorded people, in real time; the server
                                                   runs with `esplanade serve --crowd zara1.csv`
  esplanade bots --replay zara1.csv --speedup 4 --limit 20

exit code: 0 all went well, 1 some bots failed or were complained of, 2 wrong usage
Ctrl-C sends everyone home and reports what was measured until then.
"""


def run(argv: Sequence[str]) -> int:
    """Send the bots in as the command line says; returns the exit code."""
    given = vars(parser().parse_args(argv))
    try:
        settings = BotsSettings(**given)
    except ValidationError as error:
        return _refuse(_faults(error, given))
    crowd: Crowd | None = None
    if settings.replay is not None:
        try:
            crowd = read_crowd(settings.replay)
        except RecordingError as error:
            return _refuse(str(error))
    jobs, skipped = _load_jobs(settings), 0
    if crowd is not None:
        jobs, skipped = _replay_jobs(settings, crowd)
        if not jobs:
            return _refuse(f"{settings.replay}: nobody in it has a way, only single samples")
    if settings.json_file is not None and not settings.json_file.parent.is_dir():
        return _refuse(f"--json: there is no folder {settings.json_file.parent}")
    if (why := refusal(settings.url)) is not None:
        print(
            f"esplanade bots: nobody answers at {settings.url}: {why}; `esplanade serve` runs a "
            "server, and says when it is open",
            file=sys.stderr,
        )
        return EXIT_FAILED
    tally, faults = _carry_out(jobs)
    tally.skipped = skipped
    return _conclude(settings, crowd, tally, faults)


def _load_jobs(settings: BotsSettings) -> list[Job]:
    step = settings.process_count
    return [
        LoadJob(
            url=settings.url,
            count=settings.count,
            first=first,
            step=step,
            seed=settings.seed,
            join_rate=settings.join_rate,
            duration_s=settings.duration,
        )
        for first in range(step)
    ]


def _replay_jobs(settings: BotsSettings, crowd: Crowd) -> tuple[list[Job], int]:
    """The job, if anybody has a way, and how many have none."""
    tracks = sorted(crowd.tracks, key=lambda track: track.start_s)[: settings.limit]
    walking = tuple(track for track in tracks if len(track.times) > 1)
    job = ReplayJob(settings.url, walking, settings.speedup, settings.linger)
    return [job] if walking else [], len(tracks) - len(walking)


def _carry_out(jobs: Sequence[Job]) -> tuple[Tally, list[str]]:
    """Run the jobs to their end, or to the first Ctrl-C."""
    with _terminate_as_interrupt():
        crew = Crew(jobs)
        try:
            with Progress(Console(stderr=True)) as progress:
                crew.watch(progress.show)
        except KeyboardInterrupt:
            crew.stop()
        finally:
            crew.close()
    return crew.tally, crew.faults


def _conclude(
    settings: BotsSettings, crowd: Crowd | None, tally: Tally, faults: Sequence[str]
) -> int:
    """Show the result, write it where it is wanted, tell how it went."""
    show(Console(), tally)
    for fault in faults:
        print(f"esplanade bots: {fault}", file=sys.stderr)
    for hint in _hints(settings, crowd, tally):
        print(f"esplanade bots: {hint}", file=sys.stderr)
    if settings.json_file is not None:
        result = {"settings": settings.model_dump(mode="json"), **figures(tally)}
        try:
            settings.json_file.write_text(json.dumps(result, indent=2) + "\n")
        except OSError as error:
            print(f"esplanade bots: --json: {error}", file=sys.stderr)
            return EXIT_FAILED
    return EXIT_WELL if tally.well and not faults else EXIT_FAILED


def _hints(settings: BotsSettings, crowd: Crowd | None, tally: Tally) -> Iterator[str]:
    """What kept a replay from its way, if anything did."""
    if crowd is None:
        return
    if tally.capped:
        needed_mps = crowd.max_speed_mps * settings.speedup
        yield (
            f"the server's speed limit held {tally.capped} commands back; run it with "
            f"--person-max-speed-mps {needed_mps:.1f} or lower --speedup"
        )
    elif tally.near < WELL_FOLLOWED * tally.deviation_m.count:
        yield (
            "something kept people from their recorded ways; does the server run with "
            f"`esplanade serve --crowd {settings.replay}`?"
        )


@contextmanager
def _terminate_as_interrupt() -> Iterator[None]:
    """SIGTERM means the same as Ctrl-C: go home and report."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return

    before = signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        yield
    finally:
        signal.signal(signal.SIGTERM, before)


def parser() -> argparse.ArgumentParser:
    """One option for every setting, in the groups that the settings name."""
    made = argparse.ArgumentParser(
        prog="esplanade bots",
        usage="esplanade bots [options]",
        description="Send people made of code into a world: visitors that walk about and measure "
        "how the server bears them, or everyone of a recorded crowd, each a client of its own.",
        epilog=f"{EXAMPLES}\nEvery option can also be given as an environment variable: "
        f"--join-rate is\n{ENV_PREFIX}JOIN_RATE. The command line wins.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
        argument_default=argparse.SUPPRESS,
        allow_abbrev=False,
    )
    groups: dict[str, Any] = {}
    for name, field in BotsSettings.model_fields.items():
        extra = field.json_schema_extra if isinstance(field.json_schema_extra, dict) else {}
        group_name, unit = str(extra["group"]), str(extra["unit"])
        if group_name not in groups:
            groups[group_name] = made.add_argument_group(group_name)
        groups[group_name].add_argument(
            _option(name), dest=name, metavar=_metavar(field), help=_help(field, unit)
        )
    return made


def _option(name: str) -> str:
    return "--" + name.removesuffix("_file").replace("_", "-")


def _metavar(field: FieldInfo) -> str:
    kinds = get_args(field.annotation) or (field.annotation,)
    if Path in kinds:
        return "FILE"
    return {int: "N", float: "X"}.get(kinds[0], "URL")


def _help(field: FieldInfo, unit: str) -> str:
    facts = [unit] if unit else []
    if field.default is not None:
        facts.append(f"default {field.default}")
    text = f"{field.description} [{', '.join(facts)}]" if facts else f"{field.description}"
    return text.replace("%", "%%")


def _faults(error: ValidationError, given: dict[str, Any]) -> str:
    lines = []
    for fault in error.errors(include_url=False, include_input=False):
        name = str(fault["loc"][0]) if fault["loc"] else ""
        text = fault["msg"].removeprefix("Value error, ")
        where = _option(name) if name in given else f"{ENV_PREFIX}{name.upper()}"
        lines.append(f"{where}: {text}" if name else text)
    return "\n".join(lines)


def _refuse(text: str) -> int:
    for line in text.splitlines():
        print(f"esplanade bots: {line}", file=sys.stderr)
    return EXIT_USAGE

"""`esplanade bots`: sends the bots in, and reports how it went."""

import signal
import sys
import threading
from argparse import Namespace
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Final

from rich.console import Console

from esplanade.bots.address import refusal
from esplanade.bots.crew import Crew
from esplanade.bots.csv_report import write_csv
from esplanade.bots.figures import figures
from esplanade.bots.html_report import report_page
from esplanade.bots.load import LoadJob
from esplanade.bots.options import SETTINGS
from esplanade.bots.progress import Progress
from esplanade.bots.replay import ReplayJob
from esplanade.bots.report import show
from esplanade.bots.scenario_file import load_scenario
from esplanade.bots.settings import BotsSettings
from esplanade.bots.tally import Tally
from esplanade.bots.trust import tls_context
from esplanade.bots.verdict import exit_code, warnings
from esplanade.bots.worker import Job
from esplanade.commandline import fields
from esplanade.commandline.errors import CommandError, UsageError
from esplanade.commandline.output import console, write_json
from esplanade.commandline.recording_settings import tell_recording
from esplanade.commandline.settings import given_settings
from esplanade.recordings import Crowd, RecordingError, read_crowd

WELL_FOLLOWED: Final = 0.99
"""A smaller share of samples near the recorded way than this wants an explanation."""


def run(options: Namespace) -> int:
    """Send the bots in as the options say; returns the exit code."""
    settings = fields.made(BotsSettings, given_settings(options, SETTINGS))
    crowd: Crowd | None = None
    if settings.replay is not None:
        try:
            crowd = read_crowd(
                settings.replay,
                settings.fps,
                unit=settings.unit,
                scale=settings.scale,
                strict=settings.strict,
                columns=settings.columns or (),
            )
        except RecordingError as error:
            raise UsageError(str(error)) from None
        tell_recording("esplanade bots", str(settings.replay), crowd.report)
    if settings.trust is not None:
        try:
            tls_context(settings.trust)
        except ValueError as error:
            raise UsageError(f"--{error}") from None
    if settings.scenario is not None:
        try:
            load_scenario(settings.scenario)
        except ValueError as error:
            raise UsageError(f"--scenario: {error}") from None
    jobs, skipped = _load_jobs(settings), 0
    if crowd is not None:
        jobs, skipped = _replay_jobs(settings, crowd)
        if not jobs:
            raise UsageError(f"{settings.replay}: nobody in it has a way, only single samples")
    if (why := refusal(settings.url)) is not None:
        raise CommandError(
            f"nobody answers at {settings.url}: {why}; `esplanade serve` runs a server, and says "
            "when it is open"
        )
    tally, faults = _carry_out(jobs)
    tally.skipped = skipped
    return _conclude(settings, crowd, tally, faults)


def _load_jobs(settings: BotsSettings) -> list[Job]:
    step = settings.process_count
    return [
        LoadJob(
            url=settings.url,
            count=settings.most,
            first=first,
            step=step,
            seed=settings.seed,
            join_rate=settings.join_rate,
            duration_s=settings.duration,
            stages=settings.plan,
            scenario=settings.scenario,
            trust=settings.trust,
            token=settings.token.get_secret_value(),
        )
        for first in range(step)
    ]


def _replay_jobs(settings: BotsSettings, crowd: Crowd) -> tuple[list[Job], int]:
    """The job, if anybody has a way, and how many have none."""
    tracks = sorted(crowd.tracks, key=lambda track: track.start_s)[: settings.limit]
    walking = tuple(track for track in tracks if len(track.times) > 1)
    job = ReplayJob(
        settings.url,
        walking,
        settings.speedup,
        settings.linger,
        settings.trust,
        settings.token.get_secret_value(),
    )
    return [job] if walking else [], len(tracks) - len(walking)


def _carry_out(jobs: Sequence[Job]) -> tuple[Tally, list[str]]:
    """Run the jobs to their end, or to the first Ctrl-C."""
    with _terminate_as_interrupt():
        crew = Crew(jobs)
        try:
            with Progress(Console(stderr=True)) as progress:
                crew.watch(progress.show_tally)
        except KeyboardInterrupt:
            crew.stop()
        finally:
            crew.close()
    return crew.tally, crew.faults


def _conclude(
    settings: BotsSettings, crowd: Crowd | None, tally: Tally, faults: Sequence[str]
) -> int:
    """Show the result, write it where it is wanted, tell how it went."""
    verdicts = tuple(threshold.verdict(tally) for threshold in settings.thresholds)
    show(console(), tally, verdicts)
    said = [*warnings(tally, verdicts), *_hints(settings, crowd, tally)]
    for line in (*faults, *said):
        print(f"esplanade bots: {line}", file=sys.stderr)
    code = exit_code(tally, verdicts, faults)
    found = figures(
        tally,
        verdicts,
        settings=settings.model_dump(mode="json"),
        warnings=said,
        exit_code=code,
    )
    if settings.json_file is not None:
        write_json("--json", settings.json_file, found.plain())
    try:
        if settings.csv_file is not None:
            write_csv(settings.csv_file, found.series)
        if settings.html_file is not None:
            settings.html_file.write_text(report_page(tally, verdicts, found), encoding="utf-8")
    except OSError as error:
        raise UsageError(f"the report cannot be written: {error}") from None
    return code


def _hints(settings: BotsSettings, crowd: Crowd | None, tally: Tally) -> Iterator[str]:
    """The reason why a replay could not go its way, if there was one."""
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

"""`esplanade run`: a world without a server, with a bar, and a file of where everybody was."""

import math
import shlex
import signal
import sys
import time
from argparse import Namespace
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType
from typing import Any

from rich.table import Table

from esplanade.commandline import exit_codes
from esplanade.commandline.errors import CommandError, UsageError
from esplanade.commandline.output import console
from esplanade.commandline.progress import progress
from esplanade.commandline.recording_settings import READING, tell_recording
from esplanade.recordings.writing import WritingError
from esplanade.server import logs
from esplanade.server.loading import LoadingError
from esplanade.server.offline.options import SECONDS
from esplanade.server.offline.settings import OfflineSettings
from esplanade.server.offline.world import OfflineWorld

_SETTINGS = ("roster", "walls", "tick_rate", "planning_interval", *READING)


def run(options: Namespace) -> int:
    """Run a world as the options say, and write it; returns the exit code."""
    with logs.written(OfflineSettings(log_level="warning")):
        try:
            world = _world(options)
        except LoadingError as error:
            raise UsageError(str(error)) from None
        with world:
            tell_recording(options.prog, str(options.people), world.report)
            try:
                world.write(options.out, options.hz)
            except WritingError as error:
                raise UsageError(f"--out: {error}") from None
            return _run(world, options)


def _run(world: OfflineWorld, options: Namespace) -> int:
    began_s = time.perf_counter()
    try:
        interrupted = _steps(world, _ticks(world, options))
        world.close()
    except WritingError as error:
        raise CommandError(f"{error}; it ends at {world.time_s:.2f} s of the world") from None
    console().print(_summary(world, time.perf_counter() - began_s))
    print(options.out)
    if interrupted:
        print(
            f"{options.prog}: interrupted; {options.out.name} has the first "
            f"{world.time_s:.2f} s of the world",
            file=sys.stderr,
        )
    return exit_codes.INTERRUPTED if interrupted else exit_codes.OK


def _world(options: Namespace) -> OfflineWorld:
    given: dict[str, Any] = {
        name: value
        for name in _SETTINGS
        if (value := getattr(options, name)) is not None and value is not False
    }
    return OfflineWorld(
        options.scene,
        people=options.people,
        actors=10 if options.actors is None else options.actors,
        seed=options.seed,
        command=shlex.join([*options.prog.split(), *options.words]),
        **given,
    )


def _ticks(world: OfflineWorld, options: Namespace) -> int:
    seconds: float | None = options.seconds
    if seconds is None:
        seconds = SECONDS if world.people is None else world.people.duration_s
    return max(1, math.ceil(seconds / world.zone.tick_s - 1e-9))


def _steps(world: OfflineWorld, ticks: int) -> bool:
    """Let the world go on; returns whether Ctrl-C has ended it, after a whole tick."""
    with progress(share=True, time_left=True) as shown, _asked_to_stop() as stopping:
        task = shown.add_task("running", total=ticks)
        for _ in range(ticks):
            world.step()
            shown.advance(task)
            if stopping:
                return True
    return False


@contextmanager
def _asked_to_stop() -> Iterator[list[int]]:
    """Holds the first signal to end; a second Ctrl-C does not wait for the tick."""
    asked: list[int] = []

    def stop(number: int, frame: FrameType | None) -> None:  # noqa: ARG001 (a handler's signature)
        asked.append(number)
        if len(asked) > 1:
            raise KeyboardInterrupt

    before = {each: signal.getsignal(each) for each in (signal.SIGINT, signal.SIGTERM)}
    for each, handler in before.items():
        if handler is not signal.SIG_IGN:
            signal.signal(each, stop)
    try:
        yield asked
    finally:
        for each, handler in before.items():
            signal.signal(each, handler)


def _summary(world: OfflineWorld, took_s: float) -> Table:
    zone, contacts = world.zone, world.zone.contacts
    people, actors = zone.count()
    pace = f"{world.time_s / took_s:.3g} times as fast as the clock"
    rows = {
        "world": zone.scene.name,
        "time": f"{world.time_s:.6g} s in {zone.tick} ticks, {pace}",
        "at the end": f"{actors} actors, {people} people",
        "trips": f"{zone.trips} completed by actors",
        "contacts": f"{contacts.actor_person} of actors with people, "
        f"{contacts.actor_actor} among actors",
    }
    if world.people is not None:
        off = f"at most {world.people.furthest_m:.2g} m from their tracks"
        rows["recorded"] = f"{zone.people_seen} people came in, {off}"
    made = Table(show_header=False)
    for name, value in rows.items():
        made.add_row(name, value)
    return made

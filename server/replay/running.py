"""Runs a recording again: with a bar, digests that are compared, and a file of trajectories."""

import sys
import time
from argparse import Namespace
from contextlib import ExitStack
from dataclasses import dataclass

from rich.table import Table

from esplanade.commandline import exit_codes
from esplanade.commandline.errors import UsageError
from esplanade.commandline.output import console
from esplanade.commandline.progress import progress
from esplanade.server.recording.head import MACHINE, PROGRAM, differing
from esplanade.server.recording.reader import Recording
from esplanade.server.replay.bounds import bounds, too_late
from esplanade.server.replay.replayed_zone import ReplayedZone
from esplanade.server.replay.verifying import Verifier
from esplanade.server.replay.written_trajectories import WrittenTrajectories


@dataclass
class _Run:
    """A replay as far as it has come."""

    first_tick: int = 0
    last_tick: int = 0
    took_s: float = 0.0


def check_program(recording: Recording, options: Namespace) -> None:
    """Refuse what another program has recorded, and say where the machine is another.

    Raises
    ------
    UsageError
        Another program has recorded it, and that was not asked for.
    """
    other = differing(recording.head.about, PROGRAM)
    if other and not options.other_program:
        raise UsageError(
            "\n".join(
                [
                    f"{options.file}: another program has recorded it, which may go another way:",
                    *other,
                    "run that program, or give --other-program",
                ]
            )
        )
    for line in [*other, *differing(recording.head.about, MACHINE)]:
        sys.stderr.write(f"{options.prog}: not as when it was recorded: {line}\n")


def replay(recording: Recording, options: Namespace) -> int:
    """Run a recording again as the options say; returns the exit code.

    Raises
    ------
    ZoneRecordingError
        The recording is damaged.
    WritingError
        The file of trajectories cannot be written.
    UsageError
        It is to begin after its end.
    """
    done = _Run()
    with ExitStack() as stack:
        replayed = stack.enter_context(ReplayedZone(recording.head))
        verifier = Verifier(replayed.zone) if options.verify else None
        shown = stack.enter_context(progress(share=True, time_left=True))
        task = shown.add_task("verifying" if verifier else "replaying", total=1.0)
        first, last = bounds(recording, options)
        written = None
        if options.trajectories is not None:
            written = stack.enter_context(WrittenTrajectories(recording, replayed, options))
        began_s = time.perf_counter()
        for second in recording.seconds(first):
            if second.state is not None and not done.first_tick:
                replayed.go_to(second.state)
                done.first_tick = done.last_tick = second.last_tick
                began_s = time.perf_counter()
            for tick in second.ticks:
                if tick.tick > last:
                    break
                frame = replayed.step(tick)
                done.last_tick = tick.tick
                if verifier is not None:
                    verifier.tick(tick, frame)
                if written is not None and tick.tick > first:
                    written.take(frame)
            if second.last_tick > last:
                break
            if verifier is not None:
                verifier.second(second)
                if verifier.is_done:
                    break
            shown.update(task, completed=recording.share_read)
        done.took_s = time.perf_counter() - began_s
        if options.from_s is not None and done.last_tick <= first:
            raise too_late(recording, options, done.last_tick)
    return _tell(recording, options, done, verifier)


def _tell(recording: Recording, options: Namespace, done: _Run, verifier: Verifier | None) -> int:
    world_s = (done.last_tick - done.first_tick) * recording.head.built.tick_s
    pace = f"{world_s / max(done.took_s, 1e-9):.3g} times as fast as the clock"
    made = Table(show_header=False)
    made.add_row("zone", recording.head.built.zone or recording.head.scene.name)
    made.add_row("ticks", f"{done.first_tick} to {done.last_tick}, {world_s:.6g} s, {pace}")
    if recording.is_cut:
        made.add_row("end", "the file is cut off: the server did not end in good order")
    if verifier is not None and verifier.difference is None:
        made.add_row("verified", f"{verifier.seconds} digests, all equal")
    console().print(made)
    if options.trajectories is not None:
        sys.stdout.write(f"{options.trajectories}\n")
    if verifier is not None and verifier.difference is not None:
        sys.stderr.write(f"{options.prog}: {options.file}: {verifier.difference.text}\n")
        return exit_codes.FAILED
    return exit_codes.OK


def info(recording: Recording) -> Table:
    """All that the recording says of itself."""
    head, ticks, inputs, states = recording.head, 0, 0, 0
    first = last = 0
    for second in recording.seconds():
        first, last = first or second.last_tick, second.last_tick
        ticks += len(second.ticks)
        inputs += sum(len(tick.inputs) for tick in second.ticks)
        states += second.state is not None
    made = Table(show_header=False)
    made.add_row("zone", head.built.zone or head.scene.name)
    made.add_row("ticks", f"{first} to {last}, {ticks * head.built.tick_s:.6g} s")
    made.add_row("inputs", str(inputs))
    made.add_row("states", str(states))
    made.add_row("names of people", "in it" if head.built.names else "left out")
    made.add_row("chat", "in it" if head.built.chat else "left out")
    if recording.is_cut:
        made.add_row("end", "the file is cut off: the server did not end in good order")
    for name, value in head.about.items():
        made.add_row(name, value if len(value) <= 64 else f"{value[:61]}...")
    return made

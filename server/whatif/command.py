"""The work of `esplanade replay` when something is to be changed."""

import os
import shlex
import sys
from argparse import Namespace
from itertools import chain

from rich.table import Table

from esplanade.commandline import exit_codes
from esplanade.commandline.errors import UsageError
from esplanade.commandline.output import console, write_json
from esplanade.commandline.progress import progress
from esplanade.server.recording.reader import Recording
from esplanade.server.replay.bounds import bounds
from esplanade.server.replay.replayed_zone import ReplayedZone
from esplanade.server.replay.written_trajectories import WrittenTrajectories
from esplanade.server.whatif import report
from esplanade.server.whatif.changes import Changes
from esplanade.server.whatif.comparison import compared, strip
from esplanade.server.whatif.errors import WhatIfError
from esplanade.server.whatif.fork import Fork, check
from esplanade.server.whatif.fork_inputs import first_inputs
from esplanade.server.whatif.runner import run_all
from esplanade.server.whatif.runs import Plan, Run, run, zone_of
from esplanade.server.whatif.stretch import Stretch, read_stretch
from esplanade.server.whatif.told import HEADS, WhatIf
from esplanade.server.whatif.walkers import RecordedWalkers
from esplanade.server.world.zone import Zone


def what_if(recording: Recording, options: Namespace) -> int:
    """Run a stretch with something changed, and tell what came of it; returns the exit code.

    Raises
    ------
    ZoneRecordingError
        The recording is damaged.
    WritingError
        The file of trajectories cannot be written.
    """
    try:
        changes = Changes.read(
            options.set, options.roster, options.door, options.scene, recording.head.scene
        )
        stretch, unchanged, changed = _runs(recording, options, changes)
    except WhatIfError as error:
        raise UsageError(str(error)) from None
    tick_s = recording.head.built.tick_s
    found = WhatIf(
        options.file.name,
        shlex.join([*options.prog.split(), *options.words]),
        (stretch.first_tick - recording.first_tick) * tick_s,
        stretch.duration_s,
        changes,
        options.people,
        options.seeds,
        unchanged,
        changed,
        compared(unchanged, changed, reacting=options.people == "reacting"),
        strip(unchanged, changed, stretch.duration_s),
    )
    _tell(found, options)
    return exit_codes.OK


def _runs(
    recording: Recording, options: Namespace, changes: Changes
) -> tuple[Stretch, list[Run], list[Run]]:
    """The stretch, and its runs as recorded and changed."""
    first, last = bounds(recording, options)
    # A world that begins anew in another scene is compared with one that does in the recorded one.
    nothing = Changes(scene=None if changes.scene is None else recording.head.scene)
    seeds = [None] if options.seeds is None else list(range(1, options.seeds + 1))
    plans = [Plan(each, options.people, seed) for seed in seeds for each in (nothing, changes)]
    with ReplayedZone(recording.head) as replayed, progress(share=True, time_left=True) as shown:
        task = shown.add_task("running it as recorded", total=1.0)
        stretch = read_stretch(
            recording,
            replayed,
            first,
            last,
            lambda share: shown.update(task, completed=share),
            lambda zone: _check(zone, changes),
        )
        if changes.scene is not None:
            with zone_of(plans[1], stretch, replayed) as zone:
                Fork(zone, stretch, changes, RecordedWalkers(stretch))
        if options.seeds is None:
            shown.update(task, description="running it changed", completed=0.0)
            return stretch, *_once(recording, replayed, stretch, plans, options)
    with progress(time_left=True) as shown:
        task = shown.add_task("running seeds", total=len(plans))
        processes = options.processes or len(os.sched_getaffinity(0))
        done = run_all(stretch, plans, processes, lambda: shown.advance(task))
    return stretch, done[0::2], done[1::2]


def _once(
    recording: Recording,
    replayed: ReplayedZone,
    stretch: Stretch,
    plans: list[Plan],
    options: Namespace,
) -> tuple[list[Run], list[Run]]:
    """One run of each kind; the changed one may be written."""
    with zone_of(plans[0], stretch, replayed) as zone:
        recorded = run(zone, stretch, plans[0])
    with zone_of(plans[1], stretch, replayed) as zone:
        if options.trajectories is None:
            return [recorded], [run(zone, stretch, plans[1])]
        with WrittenTrajectories(recording, zone, options) as written:
            return [recorded], [run(zone, stretch, plans[1], written.take)]


def _check(zone: Zone, changes: Changes) -> None:
    """Refuse early what the recorded zone would refuse; another scene has a zone of its own."""
    if changes.scene is None:
        check(zone, first_inputs(zone, changes))


def _tell(found: WhatIf, options: Namespace) -> None:
    made = Table(*HEADS)
    for column in made.columns[1:]:
        column.justify = "right"
    for row in found.rows:
        made.add_row(*found.cells(row))
    for sentence in found.sentences:
        console().print(sentence, highlight=False, markup=False)
    console().print(made)
    if options.json is not None:
        write_json("--json", options.json, found.plain())
    if options.report is not None:
        report.write(options.report, found)
    written = (options.trajectories, options.json, options.report)
    sys.stdout.writelines(f"{path}\n" for path in chain(written) if path is not None)

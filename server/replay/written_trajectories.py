"""The file of trajectories that a replay writes."""

from argparse import Namespace
from types import TracebackType
from typing import Self

from esplanade.commandline.provenance import digest_if_there, software
from esplanade.recordings.samples import Head, Note
from esplanade.recordings.streams import Stream, open_stream
from esplanade.server.recording.reader import Recording
from esplanade.server.replay.replayed_zone import ReplayedZone
from esplanade.server.trajectories.blocks import write_block
from esplanade.server.trajectories.rates import ticks_between
from esplanade.server.trajectories.recorder import Recorder
from esplanade.server.trajectories.walkable import walkable_wkt
from esplanade.server.world.frame import Frame
from esplanade.server.world.zone import Zone


class WrittenTrajectories:
    """Writes where everybody is, from the first tick that it takes; nothing before."""

    def __init__(self, recording: Recording, replayed: ReplayedZone, options: Namespace) -> None:
        """Make the file.

        Raises
        ------
        WritingError
            It cannot be written.
        """
        self._replayed = replayed
        self._recorder = Recorder(replayed.zone, options.hz)
        head = _head(recording, replayed.zone, options)
        self._stream: Stream = open_stream(options.trajectories, head)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        try:
            if error is None:
                last = self._recorder.last_frame, self._replayed.zone.tick
                self._stream.note(Note(*last, "end", "{}"))
        finally:
            self._stream.close()

    def take(self, frame: Frame) -> None:
        """Take in a tick that was run again.

        Raises
        ------
        WritingError
            The file cannot be written.
        """
        block = self._recorder.take(frame, self._replayed.inputs)
        if block is not None:
            write_block(self._stream, block)


def _head(recording: Recording, zone: Zone, options: Namespace) -> Head:
    """The head of a file of trajectories."""
    fps = 1.0 / (zone.tick_s * ticks_between(round(1.0 / zone.tick_s, 6), options.hz))
    told = {
        **software(),
        "command": f"esplanade replay {options.file.name}",
        "world": zone.scene.name,
        "recording": options.file.name,
        "recording sha256": digest_if_there(options.file),
        "seed": str(recording.head.built.seed),
        "ticks a second": f"{1.0 / zone.tick_s:.10g}",
        **_changed(options),
        "time": f"seconds of the world; frame k is at k / {fps:.10g} s",
    }
    return Head(told, fps, zone.scene.bounds, walkable_wkt(zone.scene))


def _changed(options: Namespace) -> dict[str, str]:
    """The changes, if there are any, in the words of the command line."""
    given = [*options.set, *options.door]
    if options.roster is not None:
        given.append(f"the roster {options.roster.name}")
    if options.scene is not None:
        given.append(f"the scene {options.scene.name}")
    return {"changed": ", ".join(given)} if given else {}

"""A zone that is recorded: its ticks go to a thread that writes, and none of them waits."""

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np
import numpy.typing as npt
import structlog

from esplanade.server.file_thread import Ended, FileThread
from esplanade.server.recording.file import RecordingFile
from esplanade.server.recording.folder import RecordingFolder
from esplanade.server.recording.head import Head
from esplanade.server.recording.seconds import Second, Tick
from esplanade.server.trajectories.writer import free_path
from esplanade.server.world.frame import Frame
from esplanade.server.world.inputs import ActorsStood, Input
from esplanade.server.world.zone import Zone

MOST_SECONDS: Final = 10
"""Seconds of a zone that may wait for the disk."""
CLEAR_EVERY_S: Final = 60
"""Seconds of the world from one look at the folder to the next."""
_NO_BOUND: Final = 2**62

TakenTick = tuple[Frame, Sequence[Input], npt.NDArray[np.int64]]
TakenSecond = tuple[list[TakenTick], int, int, Mapping[str, Any]]
"""The parts of a `Tick` and of a `Second`, which the thread that writes puts together."""

log = structlog.get_logger(__name__)


class ZoneRecording:
    """Takes each tick of a zone, and leaves a second of them at a time to the thread that writes.

    The file begins with the exact state after the first tick that it takes, and so does each
    further one where no file is to have more than `longest_s` seconds.
    """

    def __init__(
        self,
        zone: Zone,
        head: Head,
        path: Path,
        ended: Callable[[Ended], None],
        *,
        longest_s: int | None = None,
        folder: RecordingFolder | None = None,
    ) -> None:
        """Make the file; the folder is cleared of old ones now and then.

        Raises
        ------
        WritingError
            It cannot be written.
        """
        self._zone = zone
        self._head = head
        self._path = path
        self._longest_s = longest_s
        self._folder = folder
        self._file = RecordingFile(path, head)
        self._ticks_a_second = max(1, round(1.0 / zone.tick_s))
        self._ticks: list[TakenTick] = []
        self._began = False
        self.written = 0
        """Seconds that were written."""
        self._thread = FileThread[TakenSecond](
            path, self._write, ended, most=MOST_SECONDS, most_bytes=_NO_BOUND
        )

    @property
    def path(self) -> Path:
        """The file that is being written."""
        return self._file.path

    @property
    def size(self) -> int:
        """The bytes of that file."""
        return self._file.size

    @property
    def waiting(self) -> int:
        """Seconds that wait to be written."""
        return self._thread.waiting

    @property
    def fault(self) -> Ended | None:
        """Why the recording has ended; None while it goes on."""
        return self._thread.fault

    def take(self, frame: Frame, inputs: Sequence[Input]) -> None:
        """Take in a tick that has ended; whatever fails here, the world goes on.

        The inputs must not be changed afterwards.
        """
        if self._thread.fault is not None:
            return
        try:
            if self._began:
                self._ticks.append((frame, inputs, self._zone.contacts.touching))
            if not self._began or frame.tick % self._ticks_a_second == 0:
                self._began = True
                self._hand_over()
        except Exception as error:
            log.exception("a zone cannot be recorded", tick=frame.tick)
            self._thread.fail(error)

    def close(self) -> None:
        """Write what waits and complete the file, within a bounded time.

        In the middle of a tick there is no state that a replay could compare: the part of a second
        that has not ended then is left out.
        """
        ended = bool(self._ticks) and self._ticks[-1][0].tick == self._zone.tick
        if ended and self._thread.fault is None:
            self._hand_over()
        self._thread.close()

    def _hand_over(self) -> None:
        ticks, self._ticks = self._ticks, []
        zone = self._zone
        taken = ticks, zone.tick, time.time_ns(), zone.save_exactly()
        self._thread.put(taken, 0, ticks[0][0].tick if ticks else zone.tick)

    def _write(self, seconds: Iterator[TakenSecond]) -> None:
        try:
            for ticks, last_tick, at_ns, state in seconds:
                second = Second([_tick(*each) for each in ticks], last_tick, at_ns, state)
                self._file.write(second)
                if self._longest_s is not None and self._file.seconds > self._longest_s:
                    self._file = self._next(second)
                if self._folder is not None and self.written % CLEAR_EVERY_S == 0:
                    self._folder.clear()
                self.written += 1
        except Exception:
            self._file.drop()
            raise
        self._file.close()

    def _next(self, second: Second) -> RecordingFile:
        """Complete the file, and begin another one with the state in which this one ends."""
        self._file.close()
        made = RecordingFile(free_path(self._path), self._head, self._file)
        made.write(second._replace(ticks=[]))
        return made


def _tick(frame: Frame, inputs: Sequence[Input], touching: npt.NDArray[np.int64]) -> Tick:
    return Tick(frame, [*inputs, ActorsStood()] if frame.actors_stood else inputs, touching)

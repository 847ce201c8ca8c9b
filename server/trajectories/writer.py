"""Writes trajectories in a thread of its own, so that no tick ever waits for a disk.

Blocks wait in a bounded queue. Where the disk is full, or takes less than the world gives, the
writing ends, for good: a file with gaps would be worse than one that ends early and says so.
"""

import json
import threading
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from time import monotonic
from typing import Final, Literal

import structlog

from esplanade.recordings.samples import Head, Note
from esplanade.recordings.streams import Stream, open_stream
from esplanade.recordings.writing import WritingError
from esplanade.server.trajectories.blocks import Block, write_block

MOST_BLOCKS: Final = 1200
MOST_BYTES: Final = 64 * 2**20
"""The most ticks that may wait, and the most bytes of them."""
FLUSH_S: Final = 1.0
CLOSE_S: Final = 20.0
"""At the end, what waits is given up after this time."""

log = structlog.get_logger(__name__)


@dataclass(frozen=True)
class Ended:
    """Why the writing ended before the world did; `text` says it to people."""

    code: Literal["unwritable", "too_slow", "failed"]
    text: str


class TrajectoryWriter:
    """A file that blocks go to. `ended` is called once, in any thread, when it ends by a fault."""

    def __init__(self, path: Path, head: Head, ended: Callable[[Ended], None]) -> None:
        """Open the file.

        Raises
        ------
        WritingError
            It cannot be written.
        """
        self._path = path
        self._head = head
        self._ended = ended
        self._changed = threading.Condition()
        self._blocks: deque[Block] = deque()
        self._bytes = 0
        self._closing = False
        self.fault: Ended | None = None
        self.written = 0
        """Blocks that were written."""
        # An open file belongs to the thread that writes; here it is only tried.
        open_stream(path, head).close()
        # A daemon, so that a disk that hangs does not keep the process from ending.
        self._thread = threading.Thread(target=self._run, name="trajectories", daemon=True)
        self._thread.start()

    @property
    def waiting(self) -> int:
        """Blocks that wait to be written."""
        return len(self._blocks)

    def put(self, block: Block) -> None:
        """Write a block soon; it never waits."""
        fault = None
        with self._changed:
            if self.fault is not None or self._closing:
                return
            if len(self._blocks) >= MOST_BLOCKS or self._bytes + block.size > MOST_BYTES:
                first = self._blocks[0] if self._blocks else block
                text = f"{self._path.name} takes less than the world gives; it ends before tick "
                fault = self._end(Ended("too_slow", f"{text}{first.tick}"))
            else:
                self._blocks.append(block)
                self._bytes += block.size
                self._changed.notify()
        if fault is not None:
            self._ended(fault)

    def fail(self, error: Exception) -> None:
        """End the writing, since blocks cannot be made any more."""
        with self._changed:
            fault = self._end(Ended("failed", f"{self._path.name} ends here: {error}"))
        if fault is not None:
            self._ended(fault)

    def close(self) -> None:
        """Write what waits and complete the file, within a bounded time."""
        with self._changed:
            self._closing = True
            self._changed.notify()
        self._thread.join(CLOSE_S)
        if self._thread.is_alive():
            log.error("the file of trajectories is not complete", file=str(self._path))

    def _end(self, fault: Ended) -> Ended | None:
        """End the writing; None if it has ended already. Call it with the lock."""
        if self.fault is not None:
            return None
        self.fault = fault
        self._blocks.clear()
        self._bytes = 0
        self._changed.notify()
        return fault

    def _run(self) -> None:
        fault = None
        try:
            self._write(open_stream(self._path, self._head))
        except WritingError as error:
            fault = Ended("unwritable", str(error))
        except Exception as error:
            log.exception("trajectories cannot be written", file=str(self._path))
            fault = Ended("failed", f"{self._path.name} ends here: {error}")
        if fault is not None:
            with self._changed:
                fault = self._end(fault)
            if fault is not None:
                self._ended(fault)

    def _write(self, stream: Stream) -> None:
        flushed_s, last = monotonic(), None
        try:
            while (block := self._next()) is not None:
                write_block(stream, block)
                last = block
                self.written += 1
                if monotonic() - flushed_s >= FLUSH_S:
                    stream.flush()
                    flushed_s = monotonic()
            if last is not None:
                why = {} if self.fault is None else {"fault": self.fault.code}
                stream.note(Note(last.frame, last.tick, "end", json.dumps(why)))
        finally:
            stream.close()

    def _next(self) -> Block | None:
        """The next block; None at the end."""
        with self._changed:
            self._changed.wait_for(lambda: self._blocks or self._closing or self.fault)
            if not self._blocks:
                return None
            block = self._blocks.popleft()
            self._bytes -= block.size
            return block


def free_path(path: Path) -> Path:
    """The path itself, or one with a number where there is a file already: none is overwritten."""
    number = 1
    free = path
    while free.exists():
        number += 1
        free = path.with_stem(f"{path.stem}-{number}")
    return free

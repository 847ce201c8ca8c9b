"""Writes trajectories in a thread of its own: blocks of ticks, with a bound on those that wait."""

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from time import monotonic
from typing import Final

from esplanade.recordings.samples import Head, Note
from esplanade.recordings.streams import Stream, open_stream
from esplanade.server.file_thread import Ended, FileThread
from esplanade.server.trajectories.blocks import Block, write_block

MOST_BLOCKS: Final = 1200
MOST_BYTES: Final = 64 * 2**20
"""The most ticks that may wait, and the most bytes of them."""
FLUSH_S: Final = 1.0


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
        self.written = 0
        """Blocks that were written."""
        # An open file belongs to the thread that writes; here it is only tried.
        open_stream(path, head).close()
        self._thread = FileThread[Block](
            path, self._write, ended, most=MOST_BLOCKS, most_bytes=MOST_BYTES
        )

    @property
    def waiting(self) -> int:
        """Blocks that wait to be written."""
        return self._thread.waiting

    @property
    def fault(self) -> Ended | None:
        """Why the writing has ended; None while it goes on."""
        return self._thread.fault

    def put(self, block: Block) -> None:
        """Write a block soon; it never waits."""
        self._thread.put(block, block.size, block.tick)

    def fail(self, error: Exception) -> None:
        """End the writing, since blocks cannot be made any more."""
        self._thread.fail(error)

    def close(self) -> None:
        """Write what waits and complete the file, within a bounded time."""
        self._thread.close()

    def _write(self, blocks: Iterator[Block]) -> None:
        stream: Stream = open_stream(self._path, self._head)
        flushed_s, last = monotonic(), None
        try:
            for block in blocks:
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


def free_path(path: Path) -> Path:
    """The path itself, or one with a number where there is a file already: none is overwritten."""
    number = 1
    free = path
    while free.exists():
        number += 1
        free = path.with_stem(f"{path.stem}-{number}")
    return free

"""Writes the lines of the log in a thread of its own, so that nobody waits for who reads them.

Standard error may be a pipe that nobody reads, a terminal that was stopped, or a disk that hangs:
a write to it then lasts for ever. Lines wait in a bounded queue. While it is full, new lines are
dropped and counted, and a line in their place tells how many they were.
"""

import os
import threading
from collections import deque
from collections.abc import Callable
from time import monotonic, sleep
from typing import Final

MAX_LINES: Final = 10_000
MAX_BYTES: Final = 4 * 1024 * 1024
"""The most lines that may wait, and the most bytes of them."""

CHUNK_BYTES: Final = 4096
"""A write to a pipe that is no longer than this is never torn apart (PIPE_BUF of Linux)."""

STUCK_S: Final = 2.0
"""At the end, lines are given up when nobody has taken any of them for this long."""

RETRY_S: Final = 0.02
"""A descriptor that does not block is tried again after this time."""

CLOSE_S: Final = 10.0
"""At the end, lines are given up after this time, however they are read."""


class LogWriter:
    """Writes lines to a file descriptor. `notice` makes the line that tells how many were dropped.

    `put` may be called from any thread; it never waits for the descriptor.
    """

    def __init__(self, descriptor: int, notice: Callable[[int], str]) -> None:
        self._descriptor = descriptor
        self._notice = notice
        self._changed = threading.Condition()
        self._lines: deque[bytes] = deque()
        self._bytes = 0
        self._full = False
        self._untold = 0
        self._closing = False
        self._progress_at = monotonic()
        self.dropped = 0
        """Lines that were dropped, because the queue was full or the descriptor broken."""
        # A daemon, so that a write that never returns does not keep the process from ending.
        self._thread = threading.Thread(target=self._run, name="log", daemon=True)
        self._thread.start()

    def put(self, line: str) -> None:
        """Write a line soon, or drop it if too many wait."""
        encoded = line.encode("utf-8", "backslashreplace") + b"\n"
        with self._changed:
            if self._full or self._has_no_room(encoded):
                self._full = True
                self.dropped += 1
                self._untold += 1
            else:
                self._append(encoded)
                self._changed.notify()

    def close(self) -> None:
        """Write what waits and end; lines that nobody takes are given up after a bounded time."""
        with self._changed:
            self._closing = True
            self._progress_at = monotonic()
            self._changed.notify()
        end = monotonic() + CLOSE_S
        while self._thread.is_alive() and monotonic() < min(end, self._progress_at + STUCK_S):
            self._thread.join(0.05)

    def _has_no_room(self, line: bytes) -> bool:
        return len(self._lines) >= MAX_LINES or self._bytes + len(line) > MAX_BYTES

    def _append(self, line: bytes) -> None:
        self._lines.append(line)
        self._bytes += len(line)

    def _run(self) -> None:
        while chunk := self._next_chunk():
            try:
                self._write(chunk)
            except OSError:  # the reader is gone: there is nobody to tell of it
                with self._changed:
                    self.dropped += chunk.count(b"\n")

    def _next_chunk(self) -> bytes:
        """The next lines, once there are some; nothing at the end."""
        with self._changed:
            self._changed.wait_for(lambda: self._lines or self._closing)
            chunk = bytearray()
            while self._lines and (not chunk or len(chunk) + len(self._lines[0]) <= CHUNK_BYTES):
                chunk += self._lines.popleft()
            self._bytes -= len(chunk)
            # While the queue is full nothing is appended: the place of what was dropped is its end.
            if 2 * len(self._lines) <= MAX_LINES and 2 * self._bytes <= MAX_BYTES:
                self._full = False
                self._tell_what_was_dropped()
            return bytes(chunk)

    def _tell_what_was_dropped(self) -> None:
        if self._untold:
            notice = self._notice(self._untold)
            self._untold = 0
            self._append(notice.encode() + b"\n")

    def _write(self, chunk: bytes) -> None:
        rest = memoryview(chunk)
        while rest:
            try:
                rest = rest[os.write(self._descriptor, rest[:CHUNK_BYTES]) :]
                self._progress_at = monotonic()
            except BlockingIOError:  # another process that has the same pipe made it so
                sleep(RETRY_S)

"""Writes to a file in a thread of its own, so that no tick ever waits for a disk.

What is to be written waits in a bounded queue. Where the disk is full, or takes less than the world
gives, the writing ends, for good: a file with gaps would be worse than one that ends early and says
so.
"""

import threading
from collections import deque
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Generic, Literal, TypeVar

import structlog

from esplanade.recordings.writing import WritingError

CLOSE_S: Final = 20.0
"""At the end, what waits is given up after this time."""

Item = TypeVar("Item")

log = structlog.get_logger(__name__)


@dataclass(frozen=True)
class Ended:
    """Why the writing ended before the world did; `text` says it to people."""

    code: Literal["unwritable", "too_slow", "failed"]
    text: str


class FileThread(Generic[Item]):
    """A file that items go to. `ended` is called once, in any thread, when it ends by a fault."""

    def __init__(
        self,
        path: Path,
        write: Callable[[Iterator[Item]], None],
        ended: Callable[[Ended], None],
        *,
        most: int,
        most_bytes: int,
    ) -> None:
        """`write` is run in the thread with the items as they come; its end is that of the file."""
        self._path = path
        self._write = write
        self._ended = ended
        self._most = most
        self._most_bytes = most_bytes
        self._changed = threading.Condition()
        self._items: deque[tuple[Item, int, int]] = deque()
        self._bytes = 0
        self._closing = False
        self.fault: Ended | None = None
        # A daemon, so that a disk that hangs does not keep the process from ending.
        self._thread = threading.Thread(target=self._run, name=path.name, daemon=True)
        self._thread.start()

    @property
    def waiting(self) -> int:
        """Items that wait to be written."""
        return len(self._items)

    def put(self, item: Item, size: int, tick: int) -> None:
        """Write an item of about that many bytes soon, one of this tick; it never waits."""
        fault = None
        with self._changed:
            if self.fault is not None or self._closing:
                return
            if len(self._items) >= self._most or self._bytes + size > self._most_bytes:
                first = self._items[0][2] if self._items else tick
                text = f"{self._path.name} takes less than the world gives; it ends before tick "
                fault = self._end(Ended("too_slow", f"{text}{first}"))
            else:
                self._items.append((item, size, tick))
                self._bytes += size
                self._changed.notify()
        if fault is not None:
            self._ended(fault)

    def fail(self, error: Exception) -> None:
        """End the writing, since items cannot be made any more."""
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
            log.error("a file is not complete", file=str(self._path))

    def _end(self, fault: Ended) -> Ended | None:
        """End the writing; None if it has ended already. Call it with the lock."""
        if self.fault is not None:
            return None
        self.fault = fault
        self._items.clear()
        self._bytes = 0
        self._changed.notify()
        return fault

    def _run(self) -> None:
        fault = None
        try:
            self._write(self._all())
        except WritingError as error:
            fault = Ended("unwritable", str(error))
        except Exception as error:
            log.exception("a file cannot be written", file=str(self._path))
            fault = Ended("failed", f"{self._path.name} ends here: {error}")
        if fault is not None:
            with self._changed:
                fault = self._end(fault)
            if fault is not None:
                self._ended(fault)

    def _all(self) -> Iterator[Item]:
        """The items as they come, up to the end."""
        while True:
            with self._changed:
                self._changed.wait_for(lambda: self._items or self._closing or self.fault)
                if not self._items:
                    return
                item, size, _ = self._items.popleft()
                self._bytes -= size
            yield item

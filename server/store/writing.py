"""The thread that writes: what waits together is committed together."""

import queue
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from typing import Any, Final, NamedTuple

from sqlalchemy import Connection, Engine
from sqlalchemy.exc import SQLAlchemyError

from esplanade.server.store.location import Location
from esplanade.server.store.store import StoreBusyError, StoreError

WAITING: Final = 256
"""No more changes may wait for the thread."""
TOGETHER: Final = 64
"""No more changes share a commit."""


class _Change(NamedTuple):
    make: Callable[[Connection], Any]
    done: "Future[Any]"


class WritingThread:
    """Makes changes in the order in which they are put, several in one transaction.

    Each of them has a savepoint of its own, so that one that fails takes nothing else with it.
    """

    def __init__(self, engine: Engine, location: Location) -> None:
        self._engine = engine
        self._location = location
        self._queue: queue.Queue[_Change | None] = queue.Queue(WAITING)
        self._closed = False
        self._closing = threading.Lock()
        self.refused = 0
        """Changes that were refused because too many waited."""
        self.commits = 0
        """Transactions that were committed."""
        self._thread = threading.Thread(target=self._run, name="store-writes", daemon=True)
        self._thread.start()

    @property
    def waiting(self) -> int:
        """Changes that wait."""
        return self._queue.qsize()

    def put(self, make: Callable[[Connection], Any]) -> "Future[Any]":
        """Have a change made; its result comes once it is committed.

        Raises
        ------
        StoreBusyError
            Too many wait.
        StoreError
            The store is closed.
        """
        done: Future[Any] = Future()
        with self._closing:  # nothing is put behind the end
            if self._closed:
                raise StoreError(f"{self._location} is closed")
            try:
                self._queue.put_nowait(_Change(make, done))
            except queue.Full:
                self.refused += 1
                raise StoreBusyError(
                    f"{self._location}: {WAITING} changes wait to be written; try again later"
                ) from None
        return done

    def close(self) -> None:
        """Make the changes that wait, and end the thread. It may take a while."""
        with self._closing:
            ended, self._closed = self._closed, True
        if not ended:
            self._queue.put(None)
        self._thread.join()

    def _run(self) -> None:
        goes_on = True
        while goes_on:
            batch = [self._queue.get()]
            while len(batch) < TOGETHER:
                try:
                    batch.append(self._queue.get_nowait())
                except queue.Empty:
                    break
            goes_on = None not in batch
            changes = [
                change
                for change in batch
                if change is not None and change.done.set_running_or_notify_cancel()
            ]
            if changes:
                self._make(changes)

    def _make(self, changes: Sequence[_Change]) -> None:
        outcomes: list[tuple[bool, Any]] = []
        try:
            with self._engine.begin() as connection:
                outcomes.extend(_outcome(connection, change) for change in changes)
        except BaseException as error:  # noqa: BLE001 (it is raised to everyone who waits)
            failure = in_words(error, self._location)
            for change in changes:
                change.done.set_exception(failure)
            return
        self.commits += 1
        for change, (made, outcome) in zip(changes, outcomes, strict=True):
            if made:
                change.done.set_result(outcome)
            else:
                change.done.set_exception(in_words(outcome, self._location))


def _outcome(connection: Connection, change: _Change) -> tuple[bool, Any]:
    """Whether a change was made, and its result, or what it raised."""
    savepoint = connection.begin_nested()
    try:
        result = change.make(connection)
    except Exception as error:  # noqa: BLE001 (it is raised to the one who waits)
        savepoint.rollback()
        return False, error
    savepoint.commit()
    return True, result


def in_words(error: BaseException, location: Location) -> BaseException:
    """A fault of the database as a `StoreError`; anything else as it is."""
    if not isinstance(error, SQLAlchemyError):
        return error
    cause = getattr(error, "orig", None) or error
    told = StoreError(f"{location}: {' '.join(str(cause).split())}")
    told.__cause__ = error
    return told

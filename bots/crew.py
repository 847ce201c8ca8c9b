"""The processes of a run: started, listened to, stopped, added up."""

import multiprocessing
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from multiprocessing.connection import Connection as Pipe
from multiprocessing.connection import wait
from multiprocessing.context import SpawnProcess
from typing import Final

from esplanade.bots.tally import Tally, merged
from esplanade.bots.worker import BEGIN, Job, Report, work

STOP_WITHIN_S: Final = 15.0
"""A worker that was told to stop and is not done by then is ended."""

POLL_S: Final = 0.5


class Crew:
    """One process a job. `tallies` holds the newest of each."""

    def __init__(self, jobs: Sequence[Job]) -> None:
        context = multiprocessing.get_context("spawn")
        self.faults: list[str] = []
        self._tallies: dict[Pipe, Tally] = {}
        self._processes: list[SpawnProcess] = []
        for job in jobs:
            ours, theirs = context.Pipe()
            process = context.Process(target=work, args=(job, theirs), daemon=True)
            process.start()
            theirs.close()
            self._tallies[ours] = Tally()
            self._processes.append(process)
        self._running = set(self._tallies)
        self._waiting = set(self._tallies)
        """Workers that are not ready to begin yet."""

    @property
    def tally(self) -> Tally:
        """Everything so far."""
        return merged(self._tallies.values())

    def watch(self, on_progress: Callable[[Tally], None]) -> None:
        """Listen until every worker is done, telling the sum now and then."""
        while self._running:
            self._listen(POLL_S)
            on_progress(self.tally)

    def stop(self) -> None:
        """Tell every worker to stop and wait for the last word of each, for a while."""
        for pipe in self._running:
            with suppress(OSError):
                pipe.send("stop")
        deadline_s = time.monotonic() + STOP_WITHIN_S
        while self._running and time.monotonic() < deadline_s:
            self._listen(POLL_S)

    def close(self) -> None:
        """End whatever still runs."""
        for process in self._processes:
            if process.is_alive() and self._running:
                process.terminate()
            process.join(STOP_WITHIN_S)
        for pipe in self._tallies:
            pipe.close()

    def _listen(self, timeout_s: float) -> None:
        for pipe in self._running & set(wait(list(self._running), timeout_s)):
            try:
                report: Report = pipe.recv()
            except (EOFError, OSError):
                self._running.discard(pipe)
                self._begin_without(pipe)
                self.faults.append("a worker process ended without a word")
                continue
            self._begin_without(pipe)
            self._tallies[pipe] = report.tally
            if report.final:
                self._running.discard(pipe)
            if report.fault is not None:
                self.faults.append(report.fault)

    def _begin_without(self, pipe: Pipe) -> None:
        """Wait for this worker no longer; once the last of them is ready, all begin."""
        if pipe not in self._waiting:
            return
        self._waiting.discard(pipe)
        if not self._waiting:
            for each in self._running:
                with suppress(OSError):
                    each.send(BEGIN)

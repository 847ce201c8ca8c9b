"""A process that runs one share of the clients and reports to the one that started it."""

import asyncio
import signal
import sys
import time
import traceback
from contextlib import suppress
from multiprocessing.connection import Connection as Pipe
from typing import Final, NamedTuple, Protocol

from esplanade.bots.tally import Tally

REPORT_EVERY_S: Final = 0.25

BEGIN: Final = "begin"
"""The word on the pipe that sets a worker going; any other, and its end, mean stop."""


class Job(Protocol):
    """Something to do with clients until it is done, or until told to stop."""

    async def run(self, tally: Tally, stop: asyncio.Event) -> None: ...


class Report(NamedTuple):
    """A worker sends this up the pipe again and again; `fault` is a traceback.

    The series is only in the final one.
    """

    tally: Tally
    final: bool
    fault: str | None = None


def work(job: Job, pipe: Pipe) -> None:
    """Run the job once every worker is ready, so that seconds of the run are the same for all.

    The first report says that this one is. The target of the process.
    """
    # Ctrl-C reaches every process of the terminal; only the first one decides what it means.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _report(pipe, Report(Tally(), final=False))
    try:
        begins = pipe.recv() == BEGIN
    except (EOFError, OSError):
        return
    if not begins:
        _report(pipe, Report(Tally(), final=True))
        return
    if sys.platform == "win32":
        asyncio.run(_run(job, pipe))
    else:
        import uvloop  # noqa: PLC0415 (not to be had elsewhere)

        uvloop.run(_run(job, pipe))


async def _run(job: Job, pipe: Pipe) -> None:
    tally = Tally()
    began_s = time.monotonic()
    idle_s = time.process_time()  # the start of the process is not the clients' time
    stop = asyncio.Event()
    task = asyncio.create_task(job.run(tally, stop))
    while not task.done():
        await asyncio.wait({task}, timeout=REPORT_EVERY_S)
        if pipe.poll():
            stop.set()
        tally.cpu_seconds = time.process_time() - idle_s
        tally.run_seconds = time.monotonic() - began_s
        if not task.done():
            _report(pipe, Report(tally.so_far(), final=False))
    error = task.exception()
    fault = None if error is None else "".join(traceback.format_exception(error))
    _report(pipe, Report(tally, final=True, fault=fault))


def _report(pipe: Pipe, report: Report) -> None:
    # Nobody listens any more once the parent process is gone; the pipe has said stop by then.
    with suppress(OSError):
        pipe.send(report)

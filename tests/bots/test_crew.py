"""Worker processes: results, faults, stopping, death."""

import asyncio
import multiprocessing
import os
import time
from dataclasses import dataclass

from esplanade.bots.crew import Crew
from esplanade.bots.tally import Tally
from tests.patience import PATIENCE_S


@dataclass(frozen=True)
class Counting:
    """A job without clients: counts to `goal`, or until stopped; may fail or die on the way."""

    goal: int = 3
    fails: bool = False
    dies: bool = False

    async def run(self, tally: Tally, stop: asyncio.Event) -> None:
        while tally.joined < self.goal and not stop.is_set():
            tally.joined += 1
            await asyncio.sleep(0.01)
        if self.dies:
            os._exit(3)
        if self.fails:
            raise RuntimeError("out of sorts")


def finish(crew: Crew) -> list[Tally]:
    seen: list[Tally] = []
    try:
        crew.watch(seen.append)
    finally:
        crew.close()
    return seen


def test_tallies_of_all_workers_add_up() -> None:
    crew = Crew([Counting(3), Counting(4)])
    seen = finish(crew)
    assert crew.tally.joined == 7
    assert crew.tally.cpu_seconds > 0.0
    assert seen[-1].joined == 7
    assert crew.faults == []


def test_a_fault_is_told_and_the_others_go_on() -> None:
    crew = Crew([Counting(3, fails=True), Counting(4)])
    finish(crew)
    assert crew.tally.joined == 7
    assert len(crew.faults) == 1
    assert "RuntimeError: out of sorts" in crew.faults[0]


def test_a_worker_that_dies_is_told() -> None:
    crew = Crew([Counting(1, dies=True), Counting(2)])
    finish(crew)
    assert crew.faults == ["a worker process ended without a word"]
    assert crew.tally.joined >= 2


def test_stop_brings_the_last_word_of_each() -> None:
    crew = Crew([Counting(10**9), Counting(10**9)])
    deadline_s = time.monotonic() + PATIENCE_S

    def until_both_count(tally: Tally) -> None:
        assert time.monotonic() < deadline_s
        if tally.joined > 20:
            raise KeyboardInterrupt

    try:
        crew.watch(until_both_count)
    except KeyboardInterrupt:
        before = crew.tally.joined
        crew.stop()
    crew.close()
    assert crew.tally.joined >= before
    assert crew.faults == []
    assert not any(process.is_alive() for process in multiprocessing.active_children())

"""Measures recordings: what they cost a tick's thread, their bytes, and how fast they run again.

    python -m benchmarks.recording
    python -m benchmarks.recording --seconds 600 --actors 50 --people 60
    python -m benchmarks.recording --seconds 600 --seeds 20

The same world is run twice, with and without a recording, in turns of a second, so that both find
the machine alike. The time is that of the processor in the thread that runs the ticks; what is
written is written in another. Reading that clock takes microseconds itself: what is measured in the
same way where nothing is recorded is taken off. The share of the cores that a what-if uses is the
time of the processor of all its processes, by the time that passed on all cores, from when the
first one is started until the last one has ended. People steer: each turns now and then, and says
so five times a second.
"""

import argparse
import os
import resource
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import zstandard
from mcap.reader import make_reader

from esplanade.actors import Population
from esplanade.server.building import build_world
from esplanade.server.loading import load_scene
from esplanade.server.recording.container import CHECKPOINTS, INPUTS
from esplanade.server.recording.head import Built, Head
from esplanade.server.recording.reader import Recording
from esplanade.server.recording.zone_recording import ZoneRecording
from esplanade.server.replay.replayed_zone import ReplayedZone
from esplanade.server.settings import ServerSettings
from esplanade.server.whatif.changes import Changes
from esplanade.server.whatif.runner import run_all
from esplanade.server.whatif.runs import Plan
from esplanade.server.whatif.stretch import read_stretch
from esplanade.server.world.inputs import Input, Join, SteerMany
from esplanade.server.world.zone import Zone

TICKS_A_SECOND = 20
TOLD_EVERY = 4
"""Ticks from one movement of a person to the next."""
SEEKS = 40
"""Moments that are gone to."""
TURNS = 0.05
"""The share of movements that go another way than the one before."""


class Steering:
    """People who come in, and steer as people do: straight on, and now and then another way."""

    def __init__(self, people: int, zone: Zone) -> None:
        self._zone = zone
        self._coming = people
        self._random = np.random.default_rng(7)
        self._directions = self._random.uniform(0.0, 2.0 * np.pi, people)
        self._ids: list[int] = []
        self._seq = 0

    def inputs(self, tick: int) -> list[Input]:
        found: list[Input] = []
        if self._coming:
            found.append(Join(tick, f"p{self._coming}", None))
            self._coming -= 1
        rows = [row for row in range(len(self._ids)) if (row + tick) % TOLD_EVERY == 0]
        if rows:
            self._seq += 1
            turned = self._random.random(len(rows)) < TURNS
            self._directions[rows] += turned * self._random.normal(0.0, 1.0, len(rows))
            ids = tuple(self._ids[row] for row in rows)
            speeds = np.full(len(rows), 1.4)
            found.append(SteerMany(ids, (self._seq,) * len(rows), self._directions[rows], speeds))
        return found

    def joined(self, avatars: Sequence[int]) -> None:
        self._ids += avatars


class World:
    """A world that is run tick by tick, and perhaps recorded."""

    def __init__(self, actors: int, people: int, path: Path | None) -> None:
        settings = ServerSettings(actors=actors, max_clients=people)
        self._population: Population
        self._population, self.zone, _ = build_world(load_scene(settings), settings)
        self._people = Steering(people, self.zone)
        self.recording: ZoneRecording | None = None
        if path is not None:
            built = Built.of(self.zone, "", settings.seed, settings.person_radius_m)
            head = Head.of(self.zone, built)
            self.recording = ZoneRecording(self.zone, head, path, lambda fault: print(fault.text))

    def second(self) -> tuple[list[float], list[float]]:
        """Run a second; milliseconds of each tick, and microseconds of those for the recording."""
        ticks, takes = [], []
        for _ in range(TICKS_A_SECOND):
            given = self._people.inputs(self.zone.tick + 1)
            start = time.thread_time()
            self.zone.begin(given)
            frame = self.zone.finish(self.zone.think())
            ended = time.thread_time()
            if self.recording is not None:
                self.recording.take(frame, given)
            takes.append(1e6 * (time.thread_time() - ended))
            ticks.append(1e3 * (time.thread_time() - start))
            self._people.joined([avatar for _, avatar in frame.joined])
        return ticks, takes

    def close(self) -> None:
        if self.recording is not None:
            self.recording.close()
        self._population.close()


def measured(actors: int, people: int, seconds: int, seeds: int, path: Path) -> None:
    """Print what recording a world of this size costs."""
    plain, kept = World(actors, people, None), World(actors, people, path)
    without: list[float] = []
    recorded: list[float] = []
    nothing: list[float] = []
    takes: list[float] = []
    for _ in range(seconds):
        ticks, taken = plain.second()
        without += ticks
        nothing += taken
        ticks, taken = kept.second()
        recorded += ticks
        takes += taken
    plain.close()
    kept.close()
    states = [take for k, take in enumerate(takes, start=1) if k % TICKS_A_SECOND == 0]
    print(f"{actors} actors, {people} people, {seconds} s of the world")
    print("                        without    recorded")
    for name, share in (("tick, median", 50), ("tick, 99 %", 99)):
        one, other = np.percentile(without, share), np.percentile(recorded, share)
        print(f"  {name:<20} {one:7.2f} ms  {other:7.2f} ms")
    cost = np.mean(takes) - np.mean(nothing)
    print(
        f"  for the recording    {cost:.1f} us a tick on average; where the state is taken, once a "
        f"second, {np.median(states):.0f} us, at most {max(states):.0f}"
    )
    _bytes(path, seconds)
    _again(path, seconds)
    _seek(path, seconds)
    _what_if(path, seeds)


def _bytes(path: Path, seconds: int) -> None:
    """Print how large the file is, and how much of it states are."""
    with path.open("rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None
    with path.open("rb") as file:
        found = make_reader(file).iter_messages([INPUTS])
        inputs = sum(len(zstandard.compress(message.data)) for _, _, message in found)
    states = {k for k, each in summary.channels.items() if each.topic == CHECKPOINTS}
    sizes = [
        (
            each.chunk_length + each.message_index_length,
            bool(states & each.message_index_offsets.keys()),
        )
        for each in summary.chunk_indexes
    ]
    without = [size for size, has_state in sizes if not has_state]
    with_state = [size for size, has_state in sizes if has_state]
    usual, hour = float(np.mean(without)), 3600.0 / seconds
    state = float(np.median(with_state)) - usual
    print(
        f"  file                 {path.stat().st_size * hour / 1e6:.2f} MB/h: inputs "
        f"{inputs * hour / 1e6:.2f}, with digests and chunks {3600.0 * usual / 1e6:.2f}; states "
        f"{360.0 * state / 1e6:.2f}, each {state:.0f} bytes"
    )


def _again(path: Path, seconds: int) -> None:
    with Recording(path) as recording, ReplayedZone(recording.head) as replayed:
        began = None
        for second in recording.seconds():
            if began is None and second.state is not None:
                start = time.perf_counter()
                replayed.go_to(second.state)
                began = time.perf_counter()
            for tick in second.ticks:
                replayed.step(tick)
        assert began is not None
        took = time.perf_counter() - began
    print(
        f"  run again            {seconds / took:.1f} times as fast as the clock; the first state "
        f"was loaded in {began - start:.2f} s"
    )


def _seek(path: Path, seconds: int) -> None:
    took: list[float] = []
    with Recording(path) as recording:
        head, first = recording.head, recording.first_tick
    with ReplayedZone(head) as replayed:
        for place in np.random.default_rng(3).uniform(0.0, seconds - 1.0, SEEKS):
            aim = first + round(place * TICKS_A_SECOND)
            start = time.perf_counter()
            with Recording(path) as recording:
                for number, second in enumerate(recording.seconds(aim)):
                    if number == 0:
                        assert second.state is not None
                        replayed.go_to(second.state)
                    for tick in second.ticks:
                        if tick.tick <= aim:
                            replayed.step(tick)
                    if second.last_tick >= aim:
                        break
            took.append(time.perf_counter() - start)
            assert replayed.zone.tick == aim
    print(
        f"  go to any moment     {np.median(took):.2f} s, at most {max(took):.2f} of {SEEKS}, with "
        f"the file opened each time"
    )


def _what_if(path: Path, seeds: int) -> None:
    """Print how well runs with other parameters use the cores."""
    changes = (Changes(), Changes(values={"risk_weight": 20.0}))
    plans = [Plan(each, "recorded", seed) for seed in range(1, seeds + 1) for each in changes]
    with Recording(path) as recording:
        start = time.perf_counter()
        with ReplayedZone(recording.head) as replayed:
            stretch = read_stretch(recording, replayed, recording.first_tick)
        read = time.perf_counter() - start
        cores = len(os.sched_getaffinity(0))
        before, start = _children_s(), time.perf_counter()
        run_all(stretch, plans, cores, lambda: None)
        took = time.perf_counter() - start
    share = 100.0 * (_children_s() - before) / (took * cores)
    print(
        f"  what if, {seeds} seeds     {len(plans)} runs of {stretch.duration_s:.0f} s in "
        f"{took:.1f} s, {len(plans) * stretch.duration_s / took:.1f} times as fast as the clock; "
        f"{share:.0f} % of {cores} cores; to run it as recorded before took {read:.1f} s"
    )


def _children_s() -> float:
    """The time of the processor that processes have taken which were started here and ended."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def main(arguments: Sequence[str] | None = None) -> None:
    """Print all figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--actors", type=int, default=10)
    parser.add_argument("--people", type=int, default=20)
    parser.add_argument("--seconds", type=int, default=120, help="of the world")
    parser.add_argument("--seeds", type=int, default=4, help="of the what-if")
    options = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "world.mcap"
        measured(options.actors, options.people, options.seconds, options.seeds, path)


if __name__ == "__main__":
    main()

"""The scenarios: a server is filled, left to settle, and watched for a while."""

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from benchmarks._live_seen import Seen
from benchmarks._live_servers import (
    Peer,
    Usage,
    colyseus_missing,
    colyseus_server,
    field_server,
    plain_server,
    serving,
)
from benchmarks._live_swarm import Share, Swarm, shares_of, swarming
from benchmarks._live_ticks import Ticks
from chaos.server import Server

VIEW: Final = (40.0, 100)
"""The radius of a view in metres, and the most avatars in it: the server's defaults."""
IDLE_JOIN_RATE: Final = 20.0
FILLED_S: Final = 600.0
BOTS_END_S: Final = 180.0


@dataclass(frozen=True)
class Plan:
    """The settings of every scenario."""

    folder: Path
    seconds: float
    warm_up_s: float
    side_m: float
    join_rate: float
    walking: float
    move_rate: float
    processes: int
    server_cores: set[int] | None


def crowd(plan: Plan, name: str, people: int, actors: int, bots: int = 0) -> Seen:
    """People who walk about in the open, `bots` of them wanderers of `esplanade bots`."""
    seen = Seen(name, people, actors)
    with field_server(plan.folder, plan.server_cores, people, actors, plan.side_m) as (
        server,
        peer,
    ):
        _visit(plan, peer, seen, server, bots)
    return seen


def gallery(plan: Plan, actors: int, visitors: int) -> Seen:
    """Actors and visitors in the scene that comes along; all visitors are wanderers."""
    seen = Seen("gallery", visitors, actors)
    with (
        serving(plan.folder, plan.server_cores, actors) as server,
        _wanderers(plan, server, visitors, visitors, seen),
    ):
        time.sleep(plan.warm_up_s)
        with _watched(seen, server.pid, server):
            time.sleep(plan.seconds)
    assert seen.ticks is not None
    seen.client_ticks = visitors * seen.ticks.count
    seen.share()
    seen.bytes_per_s = seen.ticks.bytes_out / seen.ticks.seconds / visitors
    return seen


def idle(plan: Plan, people: int) -> Seen:
    """Clients that send nothing; memory is that of the second half of them."""
    seen = Seen("idle", people)
    first = people // 2
    with field_server(plan.folder, plan.server_cores, people, 0, plan.side_m) as (server, peer):
        whole = _share_of(plan, peer, people, IDLE_JOIN_RATE, 0.0)
        halves = [
            Share(**{**vars(whole), "paths": whole.paths[:first]}),
            Share(**{**vars(whole), "paths": whole.paths[first:], "first": first}),
        ]
        with swarming(halves[:1]) as early:
            time.sleep(plan.warm_up_s)
            before = Usage.of(server.pid)
            with swarming(halves[1:]) as late:
                time.sleep(plan.warm_up_s)
                seen.memory_kb = _growth_kb(before, server.pid, people - first)
                with _watched(seen, server.pid, server):
                    count = late.count(plan.seconds)
                seen.take(count, late.join_s + early.join_s)
                seen.client_ticks = people * (seen.ticks.count if seen.ticks else 0)
    seen.share()
    return seen


def side_by_side(plan: Plan, people: int, rounds: int) -> dict[str, list[Seen]]:
    """The same walkers on our server and on each of the others, in turns, by name of the server.

    The servers without a world write as many bytes a client and tick as ours has in that round.
    """
    found: dict[str, list[Seen]] = {}
    for _ in range(rounds):
        ours = crowd(plan, "esplanade", people, 0)
        size = round(ours.bytes_a_client_tick)
        turn = [ours]
        for kind in ("websockets", "bare"):
            with plain_server(kind, plan.server_cores, people, size) as peer:
                turn.append(_visited(plan, peer, people))
        if colyseus_missing() is None:
            with colyseus_server(plan.server_cores, people, plan.side_m, VIEW) as peer:
                turn.append(_visited(plan, peer, people))
        for seen in turn:
            found.setdefault(seen.name, []).append(seen)
    return found


def _visited(plan: Plan, peer: Peer, people: int) -> Seen:
    seen = Seen(peer.name, people)
    _visit(plan, peer, seen)
    return seen


def _visit(plan: Plan, peer: Peer, seen: Seen, server: Server | None = None, bots: int = 0) -> None:
    """Fill a server with walkers, let it settle, and watch it for the seconds of the plan."""
    walkers = seen.people - bots
    empty = Usage.of(peer.process)
    share = _share_of(plan, peer, walkers, plan.join_rate, plan.move_rate)
    with swarming(shares_of(share, plan.processes)) as swarm:
        if server is None or not bots:
            _settle(plan, peer, seen, swarm, server, empty)
        else:
            with _wanderers(plan, server, bots, seen.people, seen):
                _settle(plan, peer, seen, swarm, server, empty)
    if seen.ticks is not None:
        seen.client_ticks += bots * seen.ticks.count
    seen.share()


def _settle(
    plan: Plan, peer: Peer, seen: Seen, swarm: Swarm, server: Server | None, empty: Usage
) -> None:
    time.sleep(plan.warm_up_s)
    seen.memory_kb = _growth_kb(empty, peer.process, seen.people)
    with _watched(seen, peer.process, server):
        count = swarm.count(plan.seconds)
    seen.take(count, swarm.join_s)


@contextmanager
def _watched(seen: Seen, process: int, server: Server | None) -> Iterator[None]:
    """Note the server's ticks and processor time of what happens within."""
    before = server.read() if server is not None else None
    load, usage = os.getloadavg()[0], Usage.of(process)
    yield
    after = Usage.of(process)
    seen.load = load, os.getloadavg()[0]
    seen.processor_us = 1e6 * (after.processor_s - usage.processor_s)
    seen.main_thread_us = 1e6 * (after.main_thread_s - usage.main_thread_s)
    if server is not None and before is not None:
        seen.ticks = Ticks.between(before, server.read())


def _growth_kb(before: Usage, process: int, clients: int) -> float:
    return (Usage.of(process).memory_kb - before.memory_kb) / clients


def _share_of(plan: Plan, peer: Peer, people: int, join_rate: float, move_rate: float) -> Share:
    paths = list(peer.paths[:people])
    return Share(peer.dialect, peer.port, paths, 0, plan.side_m, join_rate, plan.walking, move_rate)


@contextmanager
def _wanderers(plan: Plan, server: Server, bots: int, people: int, seen: Seen) -> Iterator[None]:
    """`esplanade bots` in a process of its own; everyone is in when what is within begins."""
    report = plan.folder / f"bots-{time.monotonic_ns()}.json"
    url = f"ws://127.0.0.1:{server.port}"
    process = subprocess.Popen(
        [
            *(sys.executable, "-m", "esplanade", "bots", "--url", url, "--count", str(bots)),
            *("--duration", "0", "--json", str(report)),
        ],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        end_s = time.monotonic() + FILLED_S
        while server.read().metrics["esplanade_people"] < people:
            if time.monotonic() > end_s or process.poll() is not None:
                raise RuntimeError(f"the bots have not come in within {FILLED_S:g} s")
            time.sleep(0.2)
        yield
        process.send_signal(signal.SIGTERM)
        process.wait(BOTS_END_S)
        seen.bots = json.loads(report.read_text())
    finally:
        process.kill()
        process.wait()

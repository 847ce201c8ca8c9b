"""The scale model beside a real cluster: bytes, processor time of each role, and pauses."""

import asyncio
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from benchmarks._cluster_people import viewers
from benchmarks._cluster_world import Seat, World, make_seats, taken, ticked, world
from benchmarks._scale_constants import Constants
from benchmarks._scale_costs import costs_of
from benchmarks._scale_world import Second
from chaos.cluster.herd import Herd, Member
from tests.server.zones import until

ZONES: Final = 3
PEOPLE: Final = 100
"""In each zone."""
GATEWAYS: Final = 2
"""People of all zones are at each of them."""
DEATHS: Final = 3
"""Hosts that are killed one after the other."""
TICK_HZ: Final = 20.0
SETTLE_S: Final = 15.0
CLEAR_S: Final = 3.0
SHOWN: Final = 5
"""A pause is over once this many snapshots have come after it."""
PAUSE_S: Final = 1.0
"""A longer time without a snapshot is a pause."""
WITHIN: Final = 0.2


@dataclass(frozen=True)
class Compared:
    """One figure as it was measured, and as the model has it."""

    name: str
    measured: float
    model: float

    @property
    def ratio(self) -> float:
        return self.model / self.measured


@dataclass(frozen=True)
class Measured:
    """A real run: bytes and seconds of processor in a second, and the pauses of deaths in
    seconds."""

    inside: float
    out: float
    hosts: float
    gateways: float
    broker: float
    pauses_s: Sequence[float]


def compared(seconds: float, constants: Constants | None = None) -> list[Compared]:
    """Run three zones of 100 people for a while, then kill hosts of them."""
    one = constants or Constants()
    with world(ZONES) as made:
        seats = [seat for zone in made.zones for seat in make_seats(made.cluster, zone, PEOPLE)]
        made.begin_hosts(ZONES, PEOPLE)
        for host in made.hosts:
            host.wait_for("open")
        made.begin_gateways(GATEWAYS, len(seats))
        measured = asyncio.run(_measured(made, seats, seconds))
    costs = costs_of(_second(), one)
    expected_s = one.lease_s - 0.5 * one.renew_s + one.take_over_s
    pause_s = float(np.mean(measured.pauses_s))
    return [
        Compared("bytes inside, MB/s", 1e-6 * measured.inside, 1e-6 * costs.inside_bytes),
        Compared("bytes to people, MB/s", 1e-6 * measured.out, 1e-6 * costs.out_bytes),
        Compared("hosts, cores", measured.hosts, costs.zone_cores),
        Compared("gateways, cores", measured.gateways, costs.gateway_cores),
        Compared("broker, cores", measured.broker, costs.broker_cores),
        Compared("pause after a host's death, s", pause_s, expected_s),
    ]


async def _measured(made: World, seats: Sequence[Seat], seconds: float) -> Measured:
    async with viewers(made, seats, seed=0) as herd:
        await asyncio.sleep(SETTLE_S)
        before = await asyncio.to_thread(made.read)
        received = herd.bytes_received
        await asyncio.sleep(seconds)
        after = await asyncio.to_thread(made.read)
        received = herd.bytes_received - received
        # On a busy machine there are fewer ticks than there are to be: seconds are the world's.
        taken_s = ticked(before, after) / ZONES / TICK_HZ
        hosts, gateways, broker = taken(before, after)
        return Measured(
            inside=(after.traffic["out_bytes"] - before.traffic["out_bytes"]) / taken_s,
            out=received / taken_s,
            hosts=sum(hosts) / taken_s,
            gateways=sum(gateways) / taken_s,
            broker=broker / taken_s,
            pauses_s=await _pauses(made, herd),
        )


def _second() -> Second:
    """A second of that world as the model has it."""
    people = ZONES * PEOPLE
    return Second(
        in_zone=np.full(ZONES, PEOPLE),
        frames=ZONES * GATEWAYS,
        frame_people=float(people * GATEWAYS),
        at_gateway=np.full(GATEWAYS, people // GATEWAYS),
        hops=0,
        moves=0,
    )


async def _pauses(made: World, herd: Herd) -> list[float]:
    """Kill the host of a zone some times; the longest time that its people were shown nothing."""
    found = []
    for death in range(DEATHS):
        await asyncio.to_thread(made.begin_standby, death, PEOPLE)
        zone = made.zones[death % ZONES]
        there = [each for each in herd.people if each.name.startswith(f"{zone} ")]
        members = [each.connection for each in there if each.connection is not None]
        for member in members:
            member.gap_s = 0.0
        await asyncio.to_thread(made.owning(zone).kill)
        shown = [member.snapshots for member in members]
        await until(lambda had=shown, have=members: _goes_on(have, had))
        found.append(float(np.median([member.gap_s for member in members])))
        await asyncio.sleep(CLEAR_S)
    return found


def _goes_on(members: Sequence[Member], before: Sequence[int]) -> bool:
    """Whether each has seen a pause, and is shown the place since."""
    now_s = asyncio.get_running_loop().time()
    return all(
        member.snapshots > had + SHOWN
        and member.gap_s > PAUSE_S
        and now_s - member.snapshot_s < PAUSE_S
        for member, had in zip(members, before, strict=True)
    )


def print_check(rows: Sequence[Compared]) -> int:
    """Print the comparison; returns the exit code, 1 if the model is off by more than a fifth."""
    print(f"{ZONES} zones of {PEOPLE} people at {GATEWAYS} gateways")
    print(f"{'':32}{'measured':>10}{'model':>10}{'ratio':>8}")
    for row in rows:
        print(f"{row.name:32}{row.measured:10.3f}{row.model:10.3f}{row.ratio:8.2f}")
    off = [row.name for row in rows if abs(row.ratio - 1.0) > WITHIN]
    print(f"off by more than {WITHIN:.0%}: {', '.join(off) or 'nothing'}")
    return 1 if off else 0

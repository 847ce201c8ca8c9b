"""The deaths within a hop: at each of its steps one of the processes that take part is killed."""

import asyncio
import time
from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum
from typing import Final

from sqlalchemy import Connection
from tests.patience import PATIENCE_S
from tests.server.clustering.clusters import Cluster, Process
from tests.server.zones import BEFORE_GATE, until

from chaos.cluster.bots import end
from chaos.cluster.held_hops import MOVED, Step, Way, held
from chaos.cluster.ledger import Ledger
from chaos.cluster.travellers import Traveller
from esplanade.server.cluster.seats import seat_of

REST_S: Final = 1.0
"""When everything has come to rest, nobody may be doubled or missing for so long."""
STEERED_M: Final = 0.3
"""Whoever has come so far east has been steered there."""
BEYOND_M: Final = 3.0
IN_YARD: Final = (6.0, 10.0, 0.0)
FROM: Final = "yard"
TO: Final = "hall"
SCENES: Final = {FROM: "The yard", TO: "The hall"}


class Victim(Enum):
    """The process that is killed."""

    ORIGIN = "origin"
    DESTINATION = "destination"
    GATEWAY = "gateway"


@dataclass(frozen=True)
class Death:
    """The outcome of the death of one process within a hop."""

    step: Step
    victim: Victim
    zone: str
    """The zone in which the person is in the end."""
    walks_s: float
    """From the death until the person walks again."""
    faults: list[str]
    """Things that cannot be; a sentence each."""


def cases() -> Iterator[tuple[Step, Victim]]:
    """Each step with each victim."""
    for step in Step:
        for victim in Victim:
            yield step, victim


async def die(cluster: Cluster, step: Step, victim: Victim) -> Death:
    """Kill a process at a step of a hop from the yard to the hall.

    The cluster has all of its processes before. Two people at another gateway look on, one in each
    zone.
    """
    ledger = Ledger()
    other, mine = cluster.gateways[:2]

    def ports() -> list[int]:
        return [mine.port] if mine.is_running else cluster.ports

    ann = Traveller("Ann", ports, ledger, 0, BEFORE_GATE)
    ben = Traveller("Ben", lambda: [other.port], ledger, 1, IN_YARD)
    cid = Traveller("Cid", lambda: [other.port], ledger, 2, BEFORE_GATE)
    witnesses = {SCENES[FROM]: ben, SCENES[TO]: cid}
    tasks = [asyncio.create_task(cid.live())]
    try:
        cid.walks = True
        await until(lambda: ledger.account("Cid").zone == SCENES[TO])
        cid.walks = False
        tasks += [asyncio.create_task(each.live()) for each in (ann, ben)]
        await until(lambda: all(ledger.account(name).welcomes for name in ("Ann", "Ben")))
        await _rest(cluster, ledger)
        person = ledger.account("Ann").person or 0
        await _heard(ledger, await ann.say(), "Ben")
        way = Way(cluster.owning(FROM), cluster.owning(TO), mine, TO)

        def go() -> None:
            ann.walks = True

        async with held(cluster, way, person, step, go):
            ann.walks = False
            since_s = time.monotonic()
            _process(way, victim).kill()
        async with asyncio.timeout(PATIENCE_S):
            await ann.walked(STEERED_M)
            walks_s = time.monotonic() - since_s
            # Out of the gate, through which one goes again who comes back to an avatar there.
            await ann.walked(BEYOND_M)
        await asyncio.to_thread(cluster.refill)
        await _rest(cluster, ledger)
        zone = ledger.account("Ann").zone or ""
        witness = witnesses[zone]
        await _heard(ledger, await ann.say(), "Ben" if witness is ben else "Cid")
        welcomes = ledger.account("Ann").welcomes
        ann.lose_connection()
        await until(lambda: ledger.account("Ann").welcomes > welcomes)
        await _rest(cluster, ledger)
        await asyncio.sleep(REST_S)
        ledger.check_rest(cluster.seats)
        faults = [*ledger.faults, *_misplaced(cluster, person, zone, step)]
        return Death(step, victim, zone, walks_s, faults)
    finally:
        await end(tasks)


def _process(way: Way, victim: Victim) -> Process:
    match victim:
        case Victim.ORIGIN:
            return way.origin
        case Victim.DESTINATION:
            return way.destination
        case Victim.GATEWAY:
            return way.gateway


def _misplaced(cluster: Cluster, person: int, zone: str, step: Step) -> list[str]:
    """Faults in where the person is: `zone` is the scene that the person is shown."""

    def seat_zone(connection: Connection) -> str:
        seat = seat_of(connection, person)
        return "none" if seat is None else seat.zone

    kept = cluster.ask(seat_zone)
    faults = []
    if SCENES.get(kept) != zone:
        faults.append(f"the seat is in {kept}, and the person is shown {zone}")
    if step in MOVED and kept != TO:
        faults.append(f"the seat was in {TO} before the death, and is in {kept}")
    return faults


async def _heard(ledger: Ledger, line: str, who: str) -> None:
    """Wait until somebody has heard a line."""
    await until(lambda: line in ledger.account(who).heard)


async def _rest(cluster: Cluster, ledger: Ledger) -> None:
    """Wait until everybody is in and sees whom they must.

    Raises
    ------
    TimeoutError
        It never came to be; the note says what is wrong.
    """
    try:
        await until(lambda: not ledger.unrest(cluster.seats))
    except TimeoutError as error:
        error.add_note("; ".join([*ledger.faults, *ledger.unrest(cluster.seats)]))
        raise

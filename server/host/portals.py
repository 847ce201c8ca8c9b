"""The portals of a hosted zone: people go from here to zones of other hosts, and come from there.

The destination keeps a place, then the avatar goes out of sight, then the one statement moves the
seat (`seats.hop`), and then the person belongs there. Whoever dies meanwhile, the seat says where
the person is.
"""

import asyncio
from collections.abc import Mapping
from functools import partial
from typing import Any, Final

import msgpack
import structlog
from nats.aio.client import Client
from nats.aio.msg import Msg
from nats.errors import Error as NatsError

from esplanade.planning import Portal
from esplanade.protocol.codes import NoticeCode
from esplanade.protocol.messages import Notice
from esplanade.server.cluster import copy_rows, seats
from esplanade.server.cluster.hops import KEPT_S, Hop, KeptPlaces, Stage
from esplanade.server.cluster.ownership import NotOwnerError
from esplanade.server.cluster.person_record import encode_record
from esplanade.server.cluster.tenure import Tenure
from esplanade.server.copies import Copies
from esplanade.server.host.hosted_people import HostedPeople
from esplanade.server.link.subjects import Subjects
from esplanade.server.metrics import Metrics
from esplanade.server.net.departures import Departures
from esplanade.server.store.store import Store, StoreError
from esplanade.server.world.zone import Zone

ASK_S: Final = 0.3
"""A question without an answer is asked again after so long."""
PREPARE: Final = "prepare"
KEPT: Final = b"kept"
FULL: Final = b"full"

log = structlog.get_logger(__name__)

Exits = Mapping[str, tuple[str, Portal]]
"""The zone and the portal there that each portal leads to, by its name."""


class Portals:
    """Lets people go through the portals of a zone, and keeps places for those who come."""

    def __init__(
        self,
        world: Zone,
        people: HostedPeople,
        exits: Exits,
        copied: Mapping[str, Copies],
        broker: Client,
        subjects: Subjects,
        store: Store,
        tenure: Tenure,
        metrics: Metrics,
        most_people: int,
    ) -> None:
        """`copied` are the zones that have copies, by name."""
        self._world = world
        self._people = people
        self._exits = exits
        self._copied = copied
        self._broker = broker
        self._subjects = subjects
        self._store = store
        self._tenure = tenure
        self._ended = metrics.hops
        self._most_people = most_people
        self._steered: dict[int, int] = {}
        self._departures = Departures(world, self._steered)
        self._departures.open(world.scene.portals if exits else (), self._go)
        self._kept = KeptPlaces()
        self._under_way: set[asyncio.Task[None]] = set()

    def check(self, now_s: float) -> None:
        """Let those go who have come into a portal. Call it before each tick."""
        self._kept.lapse(now_s)
        if not self._exits:
            return
        here = self._people.steered()
        for person in self._steered.keys() - here:
            self._departures.forget(person)
            del self._steered[person]
        for person in here - self._steered.keys():
            self._steered[person] = person
            if self._people.record_of(person).portal:
                self._departures.arrived(person)
        for person in self._departures.check(self._people.is_walked_out):
            self._people.leave_by(person)

    async def answer(self, question: Msg) -> None:
        """Keep a place for somebody of another zone, or say that there is none."""
        try:
            kind, person, hops = msgpack.unpackb(question.data)
        except (ValueError, TypeError, msgpack.UnpackException):
            return
        if kind != PREPARE or not question.reply:
            return
        room = self._most_people - self._world.count()[0]
        now_s = asyncio.get_running_loop().time()
        kept = self._kept.keep(int(person), int(hops), room, now_s)
        try:
            await self._broker.publish(question.reply, KEPT if kept else FULL)
        except NatsError as error:
            log.debug("an answer was not sent", error=str(error))

    async def close(self) -> None:
        """Break off the hops that are under way; the seats say where everybody is."""
        for task in self._under_way:
            task.cancel()
        await asyncio.gather(*self._under_way, return_exceptions=True)

    def _go(self, person: int, portal: str) -> bool:
        seat = self._people.seat_of(person)
        if seat is None:
            return False
        hop = Hop(person, seat.hops, asyncio.get_running_loop().time())
        task = asyncio.create_task(self._hop(hop, *self._exits[portal]))
        self._under_way.add(task)
        task.add_done_callback(self._under_way.discard)
        return True

    async def _hop(self, hop: Hop, destination: str, portal: Portal) -> None:
        destination = await self._copy_of(destination)
        answer = await self._ask(hop, destination)
        if not hop.answered(hop.hops, kept=answer == KEPT):
            self._ended.labels("refused").inc()
            why = "it is full" if answer == FULL else "it does not answer"
            text = f"you cannot go to {destination} now: {why}"
            arguments = {"zone": destination, "why": why}
            self._departures.stay(hop.person)
            notice = Notice(text=text, notice=NoticeCode.NOT_LET_IN, arguments=arguments)
            self._people.stay(hop.person, notice)
            return
        if hop.person not in self._world.state:
            return  # the person has gone meanwhile, and the place lapses
        at = self._world.where(hop.person)
        self._people.hide(hop.person)
        while hop.person in self._world.state:  # noqa: ASYNC110 - the next tick ends it
            await asyncio.sleep(self._world.tick_s / 4)
        await self._move(hop, destination, portal)
        self._departures.stay(hop.person)
        self._people.moved(hop.person, is_here=hop.stage is Stage.STAYED, at=at)
        self._ended.labels("made" if hop.stage is Stage.GONE else "given_up").inc()
        log.info("person goes", person=hop.person, to=destination, stage=hop.stage.name)

    async def _copy_of(self, zone: str) -> str:
        """The copy of a zone that somebody enters; the zone itself where it has none.

        It is also that while the database does not answer, or all are full.
        """
        copies = self._copied.get(zone)
        if copies is None:
            return zone
        try:
            return await self._store.read(partial(_entered, copies)) or zone
        except StoreError as error:
            log.warning("copies cannot be told apart", zone=zone, why=str(error))
            return zone

    async def _ask(self, hop: Hop, destination: str) -> bytes | None:
        """Ask for a place until there is an answer; None if there is none in time."""
        packed = msgpack.packb([PREPARE, hop.person, hop.hops])
        subject = self._subjects.questions(destination)
        end_s = asyncio.get_running_loop().time() + KEPT_S / 2
        while asyncio.get_running_loop().time() < end_s:
            try:
                return (await self._broker.request(subject, packed, timeout=ASK_S)).data
            except (NatsError, TimeoutError):
                await asyncio.sleep(ASK_S / 3)
        return None

    async def _move(self, hop: Hop, destination: str, portal: Portal) -> None:
        """Move the seat; after an outcome that nobody knows, read it until it is known."""
        record = self._people.record_to_go(hop.person).model_copy(
            update={"place": portal.arrival_place, "anywhere": True, "portal": portal.name}
        )
        move: Any = partial(
            _moved, self._tenure, hop.person, hop.hops, destination, encode_record(record)
        )
        try:
            hop.moved(is_here=not await self._store.write(move))
        except NotOwnerError:
            self._tenure.renewed(False)
            hop.moved(is_here=False)
        except StoreError as error:
            log.warning("nobody knows whether a seat was moved", person=hop.person, why=str(error))
        while hop.stage is Stage.MOVING:
            await asyncio.sleep(ASK_S)
            try:
                seat = await self._store.read(partial(_seat, hop.person))
            except StoreError:
                continue
            zone = self._tenure.claim.zone
            hop.moved(is_here=seat is not None and (seat.zone, seat.hops) == (zone, hop.hops))


def _entered(copies: Copies, connection: Any) -> str | None:
    return copy_rows.entered(connection, copies)


def _moved(
    tenure: Tenure, person: int, hops: int, destination: str, state: bytes, connection: Any
) -> bool:
    return seats.hop(connection, tenure.claim, person, hops, destination, state)


def _seat(person: int, connection: Any) -> seats.ClusterSeat | None:
    return seats.seat_of(connection, person)

"""Batches of gateways as a host takes them: what their people want, if it is theirs to want.

An input counts if it names the newest occupation of a seat, and comes from a gateway that knows the
newest owner of the zone.
"""

from collections import Counter
from typing import Final

import structlog
from nats.aio.msg import Msg

from esplanade.protocol import ProtocolError
from esplanade.protocol.messages import SetDoor, WalkTo
from esplanade.server.host.answering import Answering
from esplanade.server.host.guests import HostedGuest
from esplanade.server.host.hosted_people import HostedPeople
from esplanade.server.link.batches import Batch, BatchError, decode_batch
from esplanade.server.net.door_commands import DoorCommands
from esplanade.server.net.fair_queue import Asker
from esplanade.server.net.pending_inputs import PendingInputs
from esplanade.server.net.reporting import Reporting
from esplanade.server.net.route_requests import RouteRequests
from esplanade.server.net.waiting_lines import WaitingLines
from esplanade.server.world.inputs import MakeGesture, Say, SetAway, Watch
from esplanade.server.world.zone import Zone

MOST_WALKS: Final = 4096
"""Persons whose latest walk to a point is known."""
MOST_GATEWAYS: Final = 1024
"""The most gateways of which the number of the newest batch is known."""

log = structlog.get_logger(__name__)


class GatewayBatches:
    """Takes batches, and refuses what is stale: older ones, and those of another ownership."""

    def __init__(
        self,
        world: Zone,
        people: HostedPeople,
        routes: RouteRequests,
        pending: PendingInputs,
        answering: Answering,
        epoch: int,
        lines: WaitingLines[HostedGuest],
        doors: DoorCommands,
        reporting: Reporting,
    ) -> None:
        """`lines` holds what is said to the rules of chat; `doors` moves doors for operators."""
        self._world = world
        self._people = people
        self._routes = routes
        self._pending = pending
        self._answering = answering
        self._epoch = epoch
        self._numbers: dict[str, int] = {}
        self._lines = lines
        self._doors = doors
        self._reporting = reporting
        self._walks: dict[int, tuple[int, int]] = {}
        self.refused: Counter[str] = Counter()
        """Batches and inputs that had no effect, by why: `bad`, `epoch`, `late`, `generation`."""

    def take_message(self, message: Msg, now_s: float) -> None:
        """Take in the bytes of a batch."""
        try:
            batch = decode_batch(message.data)
        except BatchError as error:
            self.refused["bad"] += 1
            log.warning("bad batch of inputs", error=str(error))
            return
        self.take(batch, now_s)

    def take(self, batch: Batch, now_s: float) -> None:
        """Take in a batch; one of another ownership, or an older one, has no effect."""
        if batch.epoch != self._epoch:
            self.refused["epoch"] += 1
            return
        if batch.number <= self._numbers.get(batch.gateway, -1):
            self.refused["late"] += 1
            return
        if len(self._numbers) >= MOST_GATEWAYS:
            self._numbers.pop(next(iter(self._numbers)))
        self._numbers[batch.gateway] = batch.number
        self._take_held(batch, now_s)
        self._take_ways(batch)
        self._take_words(batch)
        self._take_reports(batch, now_s)
        self._take_manners(batch)
        for person, generation, comes_back in batch.departed:
            self._walks.pop(person, None)
            self._people.depart(person, generation, comes_back=comes_back)

    def lines(self) -> list[Say]:
        """The lines of chat that have come since the last call."""
        return self._lines.drain()

    def _take_held(self, batch: Batch, now_s: float) -> None:
        """Take in whom a gateway serves."""
        present = {}
        for person, generation in batch.held:
            known = self._people.occupations.of(person)
            if known is None or not self._people.is_known(person):
                self._people.look()
            elif generation > known.generation:
                self._people.attach(person, generation, batch.gateway, now_s)
            elif generation < known.generation:
                self._answering.replaced(batch.gateway, person, generation)
            else:
                present[person] = generation
        self._people.present(batch.gateway, present, now_s)

    def _take_ways(self, batch: Batch) -> None:
        """Take in where people want to walk, and who is to stand."""
        wishes = {}
        fields = (batch.movements[name].tolist() for name in batch.movements.dtype.names or ())
        for person, generation, seq, direction_rad, speed_mps in zip(*fields, strict=True):
            if self._steers(person, generation) and not self._people.is_led(person):
                wishes[person] = (seq, direction_rad, speed_mps)
                self._people.guests.last_seqs[person] = seq
        if wishes:
            self._pending.steer(wishes)
            self._routes.forget_all(wishes.keys())
        for person, generation in batch.stood:
            if self._steers(person, generation):
                self._routes.forget(person)
                self._pending.stand(person)
        for person, generation, wish in batch.walks:
            if self._steers(person, generation):
                self._walk(person, generation, batch.gateway, wish)

    def _take_words(self, batch: Batch) -> None:
        """Take in what people say, whose plans they watch, and which doors they move."""
        for person, generation, text in batch.lines:
            guest = self._people.guests.get(person)
            if self._steers(person, generation) and guest is not None:
                self._lines.put(guest, text)
        for person, generation, muted in batch.muted:
            if self._steers(person, generation):
                self._people.mute(person, tuple(muted))
        for person, generation, actor in batch.watched:
            if self._steers(person, generation):
                self._pending.watch(Watch(person, actor))
        for person, generation, door, is_open in batch.doors:
            guest = self._people.guests.get(person)
            is_here = self._steers(person, generation) and door in self._world.doors.states()
            if is_here and guest is not None:
                self._doors.ask(guest, SetDoor(name=door, open=is_open))

    def _take_reports(self, batch: Batch, now_s: float) -> None:
        """Take in of whom people tell those who look after the world."""
        for person, generation, report in batch.reports:
            guest = self._people.guests.get(person)
            if self._steers(person, generation) and guest is not None:
                self._reporting.take(guest, report, now_s)

    def _take_manners(self, batch: Batch) -> None:
        """Take in who is away from the screen, which gestures people make, and how they look."""
        for person, generation, away in batch.presences:
            if self._steers(person, generation):
                self._pending.be_away(SetAway(person, away))
        for person, generation, gesture in batch.gestures:
            if self._steers(person, generation):
                self._pending.make_gesture(MakeGesture(person, gesture))
        for person, generation, look in batch.looks:
            if self._steers(person, generation):
                self._people.wear(person, look)

    def _steers(self, person: int, generation: int) -> bool:
        if self._people.occupations.may_steer(person, generation):
            return True
        self.refused["generation"] += 1
        return False

    def _walk(self, person: int, generation: int, gateway: str, wish: WalkTo) -> None:
        if self._people.is_led(person) or not self._people.is_known(person):
            return
        if self._walks.get(person) == (generation, wish.seq):
            return  # it has come before
        if len(self._walks) >= MOST_WALKS:
            known = self._people.is_known
            self._walks = {one: walk for one, walk in self._walks.items() if known(one)}
        self._walks[person] = (generation, wish.seq)
        self._people.guests.last_seqs[person] = wish.seq
        address = self._people.record_of(person).address or str(person)
        try:
            self._routes.ask(Asker(address, person), wish)
        except ProtocolError as refusal:
            self._answering.tell(gateway, person, generation, refusal)

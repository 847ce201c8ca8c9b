"""Batches of gateways as a host takes them: what their people want, if it is theirs to want.

An input counts if it names the newest occupation of a seat, and comes from a gateway that knows the
newest owner of the zone.
"""

from collections import Counter
from typing import Final

import structlog
from nats.aio.msg import Msg

from esplanade.protocol import ProtocolError
from esplanade.protocol.messages import WalkTo
from esplanade.server.host.answering import Answering
from esplanade.server.host.hosted_people import HostedPeople
from esplanade.server.link.batches import Batch, BatchError, decode_batch
from esplanade.server.net.fair_queue import Asker
from esplanade.server.net.pending_inputs import PendingInputs
from esplanade.server.net.route_requests import RouteRequests
from esplanade.server.world.inputs import MoveDoor, Say, Watch
from esplanade.server.world.zone import Zone

MOST_LINES: Final = 4096
"""Lines of chat that wait for a tick; further ones are not heard."""
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
    ) -> None:
        self._world = world
        self._people = people
        self._routes = routes
        self._pending = pending
        self._answering = answering
        self._epoch = epoch
        self._numbers: dict[str, int] = {}
        self._lines: list[Say] = []
        self._walks: dict[int, tuple[int, int]] = {}
        self.refused: Counter[str] = Counter()
        """Batches and inputs that had no effect, by why: `bad`, `epoch`, `late`, `generation`,
        `lines`."""

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
        for person, generation, comes_back in batch.departed:
            self._walks.pop(person, None)
            self._people.depart(person, generation, comes_back=comes_back)

    def lines(self) -> list[Say]:
        """The lines of chat that have come since the last call."""
        lines, self._lines = self._lines, []
        return lines

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
            if self._steers(person, generation) and person not in self._people.leaving:
                wishes[person] = (seq, direction_rad, speed_mps)
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
            if len(self._lines) >= MOST_LINES:
                self.refused["lines"] += 1
            elif self._steers(person, generation):
                self._lines.append(Say(person, text))
        for person, generation, actor in batch.watched:
            if self._steers(person, generation):
                self._pending.watch(Watch(person, actor))
        for person, generation, door, is_open in batch.doors:
            if self._steers(person, generation) and door in self._world.doors.states():
                self._pending.move_door(MoveDoor(door, is_open))

    def _steers(self, person: int, generation: int) -> bool:
        if self._people.occupations.may_steer(person, generation):
            return True
        self.refused["generation"] += 1
        return False

    def _walk(self, person: int, generation: int, gateway: str, wish: WalkTo) -> None:
        if person in self._people.leaving or not self._people.is_known(person):
            return
        if self._walks.get(person) == (generation, wish.seq):
            return  # it has come before
        if len(self._walks) >= MOST_LINES:
            known = self._people.is_known
            self._walks = {one: walk for one, walk in self._walks.items() if known(one)}
        self._walks[person] = (generation, wish.seq)
        address = self._people.record_of(person).address or str(person)
        try:
            self._routes.ask(Asker(address, person), wish)
        except ProtocolError as refusal:
            self._answering.tell(gateway, person, generation, refusal)

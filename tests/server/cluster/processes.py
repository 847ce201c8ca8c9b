"""Hosts and gateways as the rules make them: processes without sockets, for the model of a cluster.

Messages are put on `Post` and come in any order, more than once, or never.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Final

from esplanade.server.cluster.frame_gate import FrameGate, Verdict
from esplanade.server.cluster.hops import Hop, KeptPlaces, Stage
from esplanade.server.cluster.occupations import Occupations
from esplanade.server.cluster.ownership import NotOwnerError
from esplanade.server.cluster.tenure import Tenure
from tests.server.cluster.truth import Truth

ROOM: Final = 3
"""A zone has no room for more people who come through a portal."""

Act = Callable[[], None]


@dataclass(frozen=True)
class Message:
    """Something for everyone who listens to a subject: a zone, or a gateway."""

    to: str
    kind: str
    told: tuple[object, ...]


class Post:
    """The messages that are under way, and what the owners of zones have learnt by them."""

    def __init__(self) -> None:
        self.messages: list[Message] = []
        self.learnt: dict[int, int] = {}
        """The newest generation of each person that an owner of a zone has learnt of."""

    def send(self, to: str, kind: str, *told: object) -> None:
        self.messages.append(Message(to, kind, told))


@dataclass
class Simulated:
    """A zone in the process of a host."""

    tenure: Tenure
    occupations: Occupations = field(default_factory=Occupations)
    hops_of: dict[int, int] = field(default_factory=dict)
    """Everyone who has an avatar here, and how often each has hopped."""
    hops: dict[int, Hop] = field(default_factory=dict)
    kept: KeptPlaces = field(default_factory=KeptPlaces)
    tick: int = 0
    steered: dict[int, int] = field(default_factory=dict)
    """The generation by which each was steered last."""

    def shown(self) -> dict[int, None]:
        hidden = {person for person, hop in self.hops.items() if not hop.is_shown}
        return {person: None for person in self.hops_of if person not in hidden}


class Host:
    """A process that simulates zones."""

    def __init__(self, name: str, truth: Truth, post: Post) -> None:
        self.name = name
        self.truth = truth
        self.post = post
        self.frozen = False
        self.zones: dict[str, Simulated] = {}

    @property
    def now_s(self) -> float:
        return self.truth.now_us / 1e6

    def claim(self) -> None:
        claimed = self.truth.claim(self.name)
        if claimed is None:
            return
        zone = Simulated(Tenure(claimed))
        self.zones[claimed.zone] = zone
        self._look_after_seats(zone)

    def renew(self) -> None:
        for zone in list(self.zones.values()):
            zone.tenure.renewed(self.truth.renew(zone.tenure.claim))
            self._stand_down(zone)

    def hear(self, name: str, epoch: int) -> None:
        zone = self.zones.get(name)
        if zone is not None:
            zone.tenure.heard(epoch)
            self._stand_down(zone)

    def beat(self, gateways: list[str]) -> None:
        """One tick of each zone: a frame goes out to every gateway."""
        for zone in self.zones.values():
            zone.tick += 1
            for person, generation in zone.occupations.silent(self.now_s).items():
                self.truth.vacate(person, generation)
            shown = zone.shown()
            claim = zone.tenure.claim
            if self.truth.owns(claim):
                there = {
                    each.person for each in self.truth.seats.values() if each.zone == claim.zone
                }
                assert shown.keys() <= there, "a person is shown in a zone without a seat there"
            for gateway in gateways:
                self.post.send(gateway, "frame", claim.zone, claim.epoch, zone.tick)

    def take_in(self, message: Message, how: str) -> None:
        zone = self.zones.get(message.to)
        if zone is None:
            return
        match message.kind, message.told:
            case "attach", (int(person), int(generation), str(gateway)):
                if self._come(zone, person):
                    if zone.occupations.attach(person, generation, gateway, self.now_s):
                        self._learnt(zone, person, generation)
                else:
                    self.post.send(gateway, "elsewhere", person)
            case "steer", (int(person), int(generation)):
                if zone.occupations.may_steer(person, generation):
                    zone.steered[person] = generation
                    if self.truth.owns(zone.tenure.claim):
                        assert generation >= self.post.learnt[person], "an older client steers"
            case "present", (str(gateway), dict() as held):
                for person in zone.occupations.present(gateway, held, self.now_s):
                    self.truth.reoccupy(person, held[person], gateway)
            case "ask", (str(gateway),):
                claim = zone.tenure.claim
                self.post.send(gateway, "whole", claim.zone, claim.epoch, zone.tick)
            case _:
                self._take_in_of_hop(zone, message, how)

    def _take_in_of_hop(self, zone: Simulated, message: Message, how: str) -> None:
        match message.kind, message.told:
            case "prepare", (str(origin), int(person), int(hops)):
                kept = zone.kept.keep(person, hops, ROOM - len(zone.hops_of), self.now_s)
                self.post.send(origin, "answer", message.to, person, hops, kept)
            case "answer", (str(destination), int(person), int(hops), bool(kept)):
                hop = zone.hops.get(person)
                if hop is not None and hop.answered(hops, kept=kept):
                    self._move(zone, hop, destination, how)

    def begin_hop(self, name: str, person: int, destination: str) -> None:
        zone = self.zones[name]
        known = zone.hops.get(person)
        if known is not None and not known.given_up(self.now_s):
            return
        zone.hops[person] = Hop(person, zone.hops_of[person], self.now_s)
        self.post.send(destination, "prepare", name, person, zone.hops_of[person])

    def look_at_seats(self) -> None:
        """Read the seats: what became of hops without an answer, and who ought to be here.

        A gateway may have died between the seat that it wrote and the message that tells of it.
        """
        for zone in self.zones.values():
            self._look_after_seats(zone)
            for hop in list(zone.hops.values()):
                hop.given_up(self.now_s)
                if hop.stage is Stage.MOVING:
                    self._learn(zone, hop)

    def _move(self, zone: Simulated, hop: Hop, destination: str, how: str) -> None:
        claim = zone.tenure.claim
        if how != "never arrives":
            try:
                self.truth.hop(claim, hop.person, hop.hops, destination, b"")
            except NotOwnerError:
                zone.tenure.renewed(False)
                self._stand_down(zone)
                return
        if how == "is answered":
            self._learn(zone, hop)

    def _learn(self, zone: Simulated, hop: Hop) -> None:
        seat = self.truth.seats.get(hop.person)
        name = zone.tenure.claim.zone
        hop.moved(is_here=seat is not None and (seat.zone, seat.hops) == (name, hop.hops))
        if hop.stage is Stage.GONE:
            del zone.hops_of[hop.person], zone.hops[hop.person]
            zone.occupations.forget(hop.person)
            if seat is not None and seat.gateway is not None:
                self.post.send(seat.gateway, "elsewhere", hop.person)

    def _look_after_seats(self, zone: Simulated) -> None:
        for seat in self.truth.seats.values():
            if seat.zone == zone.tenure.claim.zone and self._come(zone, seat.person):
                zone.occupations.restore(seat.person, seat.generation, seat.gateway, self.now_s)
                self._learnt(zone, seat.person, seat.generation)

    def _come(self, zone: Simulated, person: int) -> bool:
        """Make the avatar of a person whose seat is here, if it is not there yet."""
        if person in zone.hops_of:
            return True
        seat = self.truth.seats.get(person)
        if seat is None or seat.zone != zone.tenure.claim.zone:
            return False
        zone.hops_of[person] = seat.hops
        zone.kept.taken(person)
        zone.occupations.restore(person, seat.generation, seat.gateway, self.now_s)
        self._learnt(zone, person, seat.generation)
        return True

    def _learnt(self, zone: Simulated, person: int, generation: int) -> None:
        if self.truth.owns(zone.tenure.claim):
            learnt = self.post.learnt
            learnt[person] = max(generation, learnt.get(person, 0))

    def _stand_down(self, zone: Simulated) -> None:
        if not zone.tenure.holds:
            del self.zones[zone.tenure.claim.zone]


@dataclass
class Client:
    """A person's connection at a gateway."""

    person: int
    generation: int
    zone: str


class Gateway:
    """A process that has sockets."""

    def __init__(self, name: str, truth: Truth, post: Post) -> None:
        self.name = name
        self.truth = truth
        self.post = post
        self.gates: dict[str, FrameGate] = {}
        self.clients: dict[int, Client] = {}
        self.applied: dict[str, tuple[int, int]] = {}
        """The newest frame of each zone that was applied: its epoch and tick."""

    def seat(self, person: int, generation: int, zone: str) -> None:
        self.clients[person] = Client(person, generation, zone)
        self.attach(person)

    def attach(self, person: int) -> None:
        client = self.clients[person]
        self.post.send(client.zone, "attach", person, client.generation, self.name)

    def steer(self, person: int) -> None:
        client = self.clients[person]
        self.post.send(client.zone, "steer", person, client.generation)

    def tell_presence(self) -> None:
        for zone in {client.zone for client in self.clients.values()}:
            held = {c.person: c.generation for c in self.clients.values() if c.zone == zone}
            self.post.send(zone, "present", self.name, held)

    def take_in(self, message: Message) -> None:
        match message.kind, message.told:
            case "frame", (str(zone), int(epoch), int(tick)):
                verdict = self._gate(zone).judge(epoch, tick)
                self._apply(verdict, zone, epoch, tick)
            case "whole", (str(zone), int(epoch), int(tick)):
                self._apply(self._gate(zone).whole(epoch, tick), zone, epoch, tick)
            case "elsewhere", (int(person),):
                seat, client = self.truth.seats.get(person), self.clients.get(person)
                if client is None:
                    return
                if seat is None or seat.generation != client.generation:
                    del self.clients[person]  # replaced
                elif seat.zone != client.zone:
                    client.zone = seat.zone
                    self.attach(person)

    def _gate(self, zone: str) -> FrameGate:
        return self.gates.setdefault(zone, FrameGate())

    def _apply(self, verdict: Verdict, zone: str, epoch: int, tick: int) -> None:
        if verdict is Verdict.RESYNC:
            self.post.send(zone, "ask", self.name)
        elif verdict is Verdict.APPLY:
            assert (epoch, tick) >= self.applied.get(zone, (0, 0)), "a gateway went back in time"
            self.applied[zone] = (epoch, tick)

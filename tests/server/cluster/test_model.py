"""A cluster keeps its word: messages are lost, doubled and late, and processes freeze and die."""

from typing import Final

import hypothesis.strategies as st
from hypothesis import HealthCheck, settings
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, precondition, rule

from esplanade.server.cluster.occupations import SILENCE_S
from esplanade.server.cluster.ownership import LEASE_US
from esplanade.server.cluster.seats import ClusterSeat
from tests.server.cluster.processes import Gateway, Host, Post
from tests.server.cluster.truth import Truth

ZONES: Final = ("hall", "plaza")
HOSTS: Final = ("ash", "birch", "cedar")
GATEWAYS: Final = ("east", "west")
KEEP_US: Final = 600_000_000
MOST_PEOPLE: Final = 5
OUTCOMES: Final = ("is answered", "loses its answer", "never arrives")
"""The ends that the statement may have that moves a seat."""

hosts = st.sampled_from(HOSTS)
gateways = st.sampled_from(GATEWAYS)
indices = st.integers(0, 40)


class Cluster(RuleBasedStateMachine):
    """Two zones, three hosts, two gateways, and people who come, come back and hop."""

    def __init__(self) -> None:
        super().__init__()
        self.truth, self.post = Truth(4_000_000_000_000_000), Post()
        for zone in ZONES:
            self.truth.add_zone(zone)
        self.hosts = {name: Host(name, self.truth, self.post) for name in HOSTS}
        self.gateways = {name: Gateway(name, self.truth, self.post) for name in GATEWAYS}
        self.epochs: dict[str, dict[int, str]] = {zone: {} for zone in ZONES}
        self.tokens: list[tuple[int, str]] = []
        self.serial = 0

    @initialize()
    def a_world_is_open(self) -> None:
        """Each zone has an owner, the gateways have seen both, and two people are there."""
        for name, zone in zip(HOSTS, ZONES, strict=False):
            self.hosts[name].claim()
            self.somebody_comes(GATEWAYS[0], zone)
            self.hosts[name].beat(list(GATEWAYS))
        self._deliver_all()

    @rule(seconds=st.sampled_from((0.05, 0.5, 1.0, 2.5, 4.0)))
    def time_goes_on(self, seconds: float) -> None:
        self.truth.now_us += round(seconds * 1e6)

    @rule(name=hosts)
    def a_host_claims(self, name: str) -> None:
        if not self.hosts[name].frozen:
            self.hosts[name].claim()

    @rule(name=hosts)
    def a_host_renews(self, name: str) -> None:
        if not self.hosts[name].frozen:
            self.hosts[name].renew()

    @rule(name=hosts, zone=st.sampled_from(ZONES))
    def a_host_hears_of_the_owner(self, name: str, zone: str) -> None:
        if not self.hosts[name].frozen:
            self.hosts[name].hear(zone, self.truth.zones[zone].epoch)

    @rule(name=hosts)
    def a_host_ticks(self, name: str) -> None:
        if not self.hosts[name].frozen:
            self.hosts[name].beat(list(GATEWAYS))

    @rule(name=hosts, frozen=st.booleans())
    def a_host_freezes_or_wakes(self, name: str, frozen: bool) -> None:
        self.hosts[name].frozen = frozen

    @rule(name=hosts)
    def a_host_dies_and_another_begins(self, name: str) -> None:
        self.hosts[name] = Host(name, self.truth, self.post)

    @rule(name=hosts)
    def a_host_looks_at_seats(self, name: str) -> None:
        if not self.hosts[name].frozen:
            self.hosts[name].look_at_seats()

    @rule(zone=st.sampled_from(ZONES))
    def an_operator_fences(self, zone: str) -> None:
        self.truth.fence(zone)

    @rule(name=gateways)
    def a_gateway_dies_and_another_begins(self, name: str) -> None:
        self.gateways[name] = Gateway(name, self.truth, self.post)

    @rule(name=gateways)
    def a_gateway_tells_whom_it_serves(self, name: str) -> None:
        self.gateways[name].tell_presence()

    @precondition(lambda self: len(self.truth.seats) < MOST_PEOPLE)
    @rule(name=gateways, zone=st.sampled_from(ZONES))
    def somebody_comes(self, name: str, zone: str) -> None:
        self.serial += 1
        person, token = self.serial, f"token {self.serial}"
        seat = ClusterSeat(person, zone, f"Visitor {person}", 1, 0, name, None, b"")
        self.truth.take(person, token, seat)
        self.tokens.append((person, token))
        self.gateways[name].seat(person, 1, zone)

    @precondition(lambda self: self.tokens)
    @rule(name=gateways, index=indices)
    def somebody_comes_back(self, name: str, index: int) -> None:
        person, token = self.tokens[index % len(self.tokens)]
        seat = self.truth.resume(token, name, KEEP_US)
        if seat is None:
            return
        self.serial += 1
        renewed = f"token {self.serial}"
        self.truth.renewed(person, token, renewed)
        self.tokens.append((person, renewed))
        self.gateways[name].seat(person, seat.generation, seat.zone)

    @rule(name=gateways, index=indices)
    def somebody_steers(self, name: str, index: int) -> None:
        clients = sorted(self.gateways[name].clients)
        if clients:
            self.gateways[name].steer(clients[index % len(clients)])

    @rule(name=hosts, index=indices)
    def somebody_enters_a_portal(self, name: str, index: int) -> None:
        host = self.hosts[name]
        there = [(zone, each) for zone, held in host.zones.items() for each in held.shown()]
        if there and not host.frozen:
            zone, person = there[index % len(there)]
            host.begin_hop(zone, person, ZONES[1 - ZONES.index(zone)])

    @precondition(lambda self: self.post.messages)
    @rule(index=indices, again=st.booleans(), how=st.sampled_from(OUTCOMES))
    def a_message_comes(self, index: int, again: bool, how: str) -> None:
        index %= len(self.post.messages)
        message = self.post.messages[index] if again else self.post.messages.pop(index)
        if message.to in self.gateways:
            self.gateways[message.to].take_in(message)
        for host in self.hosts.values():
            if not host.frozen:
                host.take_in(message, how)

    @rule(how=st.sampled_from(OUTCOMES))
    def all_messages_come_in_order(self, how: str) -> None:
        if not any(host.frozen for host in self.hosts.values()):
            self._deliver_all(how)

    @precondition(lambda self: self.post.messages)
    @rule(index=indices)
    def a_message_is_lost(self, index: int) -> None:
        self.post.messages.pop(index % len(self.post.messages))

    @invariant()
    def an_epoch_has_one_owner(self) -> None:
        for host in self.hosts.values():
            for zone, simulated in host.zones.items():
                epoch = simulated.tenure.claim.epoch
                assert self.epochs[zone].setdefault(epoch, host.name) == host.name
                assert epoch <= self.truth.zones[zone].epoch

    def teardown(self) -> None:
        """All faults end: everyone is in one zone, and the newest client of each steers."""
        self.post.messages.clear()
        self.truth.now_us += LEASE_US + 1
        for host in self.hosts.values():
            host.frozen = False
            host.renew()
        owner = self.hosts[HOSTS[0]]
        for _ in ZONES:
            owner.claim()
        for host in self.hosts.values():
            host.look_at_seats()
        for gateway in self.gateways.values():
            for person in list(gateway.clients):
                gateway.attach(person)
        self._deliver_all()
        for gateway in self.gateways.values():
            for person in list(gateway.clients):
                gateway.steer(person)
        for host in self.hosts.values():
            host.beat(list(GATEWAYS))
        self._deliver_all()
        self._check_everyone()
        self._check_silence()

    def _deliver_all(self, how: str = OUTCOMES[0]) -> None:
        for _ in range(10_000):
            if not self.post.messages:
                return
            message = self.post.messages.pop(0)
            if message.to in self.gateways:
                self.gateways[message.to].take_in(message)
            for host in self.hosts.values():
                host.take_in(message, how)
        raise AssertionError("messages go round for ever")

    def _check_everyone(self) -> None:
        homes = [(zone, held) for host in self.hosts.values() for zone, held in host.zones.items()]
        assert sorted(zone for zone, _ in homes) == list(ZONES)
        for person, seat in self.truth.seats.items():
            assert [zone for zone, held in homes if person in held.shown()] == [seat.zone]
            served = seat.gateway and self.gateways[seat.gateway].clients.get(person)
            if served and served.generation == seat.generation:
                steered = dict(homes)[seat.zone].steered
                assert steered[person] == seat.generation

    def _check_silence(self) -> None:
        """Persons without a client lose their seats soon, and nobody else does."""
        self.truth.now_us += round(1.5 * SILENCE_S * 1e6)
        for gateway in self.gateways.values():
            gateway.tell_presence()
        self._deliver_all()
        for host in self.hosts.values():
            host.beat([])
        for person, seat in self.truth.seats.items():
            served = {
                client.generation
                for gateway in self.gateways.values()
                if (client := gateway.clients.get(person)) is not None
            }
            assert (seat.vacated_us is None) == (seat.generation in served)


Cluster.TestCase.settings = settings(
    max_examples=100,
    stateful_step_count=50,
    deadline=None,
    suppress_health_check=list(HealthCheck),
)
TestCluster = Cluster.TestCase

"""The statements in SQL mean what their plain twin means, on SQLite and PostgreSQL."""

import itertools
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Final, TypeVar

import hypothesis.strategies as st
import pytest
from hypothesis import HealthCheck, settings
from hypothesis.stateful import RuleBasedStateMachine, invariant, rule, run_state_machine_as_test
from sqlalchemy import Connection, Engine, delete, select

from esplanade.server.cluster import ownership, seats
from esplanade.server.cluster.database_time import NOW_US, STARTED_US
from esplanade.server.cluster.ownership import LEASE_US, NotOwnerError
from esplanade.server.cluster.tenure import Claim
from esplanade.server.store.engines import writing_engine
from esplanade.server.store.location import Location
from esplanade.server.store.tables import CLUSTER_SEATS, OWNERSHIPS
from esplanade.server.store.upgrading import upgrade
from tests.server.cluster.truth import Truth

BEGIN_US: Final = 4_000_000_000_000_000
"""Later than any database server has started."""
KEEP_US: Final = 60_000_000
ZONES: Final = ("hall", "plaza", "roof")
HOSTS: Final = ("ash", "birch", "cedar")

Result = TypeVar("Result")

zones = st.sampled_from((*ZONES, "nowhere"))
hosts = st.sampled_from(HOSTS)
gateways = st.sampled_from(("east", "west"))
indices = st.integers(0, 30)


@pytest.fixture
def engine(location: Location) -> Iterator[Engine]:
    made = writing_engine(location, durable=False, zone="main")
    upgrade(made, location)
    yield made
    made.dispose()


class Statements(RuleBasedStateMachine):
    """Does the same to a database and to its twin, and compares all that they tell."""

    def __init__(self, engine: Engine) -> None:
        super().__init__()
        self.engine = engine
        self.twin = Truth(BEGIN_US)
        self.claims: list[Claim] = [Claim("hall", "ash", 1)]
        self.tokens: list[tuple[int, str]] = [(0, "no such token")]
        self.seen = itertools.count(1)
        with engine.begin() as connection:
            connection.execute(delete(OWNERSHIPS))
            connection.execute(delete(CLUSTER_SEATS))
            for zone in ZONES:
                assert ownership.add_zone(connection, zone)
                assert self.twin.add_zone(zone)

    def ask(self, statement: Callable[[Connection], Result]) -> Result:
        with self.engine.begin() as connection:
            return statement(connection)

    @rule(microseconds=st.sampled_from((1, 1_000_000, LEASE_US, LEASE_US + 1, KEEP_US)))
    def time_goes_on(self, microseconds: int) -> None:
        self.twin.now_us += microseconds

    @rule(zone=zones)
    def add_zone_again(self, zone: str) -> None:
        if zone in ZONES:
            assert not self.ask(lambda to: ownership.add_zone(to, zone))

    @rule(host=hosts, only=st.none() | st.lists(zones, max_size=2))
    def claim(self, host: str, only: list[str] | None) -> None:
        now = self.twin.now_us
        got = self.ask(lambda to: ownership.claim(to, host, only, now=now))
        assert got == self.twin.claim(host, only)
        if got is not None:
            self.claims.append(got)

    @rule(index=indices)
    def renew(self, index: int) -> None:
        claim, now = self._claim(index), self.twin.now_us
        renewed = self.ask(lambda to: ownership.renew(to, claim, now=now))
        assert renewed == self.twin.renew(claim)

    @rule(index=indices)
    def release(self, index: int) -> None:
        claim = self._claim(index)
        assert self.ask(lambda to: ownership.release(to, claim)) == self.twin.release(claim)

    @rule(zone=zones)
    def fence(self, zone: str) -> None:
        assert self.ask(lambda to: ownership.fence(to, zone)) == self.twin.fence(zone)

    @rule(zone=zones, host=st.none() | hosts)
    def want(self, zone: str, host: str | None) -> None:
        assert self.ask(lambda to: ownership.want(to, zone, host)) == self.twin.want(zone, host)

    @rule(zone=st.sampled_from(ZONES), gateway=gateways)
    def take(self, zone: str, gateway: str) -> None:
        name = f"Visitor {next(self.seen)}"
        seat, token = self.ask(lambda to: seats.take(to, zone, name, gateway, b"new"))
        assert seat.person not in self.twin.seats
        self.twin.take(seat.person, token, seat)
        self.tokens.append((seat.person, token))

    @rule(index=indices, gateway=gateways)
    def resume(self, index: int, gateway: str) -> None:
        (person, token), now = self._token(index), self.twin.now_us
        got = self.ask(lambda to: seats.resume(to, token, gateway, KEEP_US, now=now))
        expected = self.twin.resume(token, gateway, KEEP_US)
        assert (None if got is None else got[0]) == expected
        if got is not None:
            self.twin.renewed(person, token, got[1])
            self.tokens.append((person, got[1]))

    @rule(index=indices, back=st.integers(0, 1))
    def confirm_vacate_or_leave(self, index: int, back: int) -> None:
        (person, _), now = self._token(index), self.twin.now_us
        known = self.twin.seats.get(person)
        generation = 1 if known is None else known.generation - back
        confirmed = self.ask(lambda to: seats.confirm(to, [(person, generation)]))
        assert confirmed == self.twin.confirm(person, generation)
        if index % 2:
            left = self.ask(lambda to: seats.vacate(to, [(person, generation)], now=now))
            assert left == self.twin.vacate(person, generation)
            if index % 5 == 0:
                back_in = self.ask(lambda to: seats.reoccupy(to, [(person, generation)], "east"))
                assert back_in == self.twin.reoccupy(person, generation, "east")
        elif index % 3 == 0:
            gone = self.ask(lambda to: seats.leave(to, [(person, generation)]))
            assert gone == self.twin.leave(person, generation)

    @rule(index=indices)
    def remove_vacant(self, index: int) -> None:
        claim, now = self._claim(index), self.twin.now_us
        removed = _or_refused(
            lambda: self.ask(lambda to: seats.remove_vacant(to, claim, KEEP_US, now=now))
        )
        assert removed == _or_refused(lambda: self.twin.remove_vacant(claim, KEEP_US))

    @rule(index=indices, whose=indices, back=st.integers(0, 1), to=st.sampled_from(ZONES))
    def hop(self, index: int, whose: int, back: int, to: str) -> None:
        claim, (person, _) = self._claim(index), self._token(whose)
        known = self.twin.seats.get(person)
        hops = 0 if known is None else known.hops - back
        moved = _or_refused(
            lambda: self.ask(lambda on: seats.hop(on, claim, person, hops, to, b"moved"))
        )
        assert moved == _or_refused(lambda: self.twin.hop(claim, person, hops, to, b"moved"))

    @invariant()
    def both_tell_the_same(self) -> None:
        with self.engine.begin() as connection:
            told = ownership.ownerships(connection)
            assert told == sorted(self.twin.zones.values(), key=lambda row: row.zone)
            held = [seat for zone in ZONES for seat in seats.seats_in(connection, zone)]
        assert {seat.person: seat for seat in held} == self.twin.seats

    def _claim(self, index: int) -> Claim:
        return self.claims[-1 - index % len(self.claims)]

    def _token(self, index: int) -> tuple[int, str]:
        return self.tokens[-1 - index % len(self.tokens)]


def _or_refused(act: Callable[[], Result]) -> Result | str:
    try:
        return act()
    except NotOwnerError:
        return "refused"


def test_sql_does_what_its_twin_does(engine: Engine) -> None:
    class OnEngine(Statements):
        def __init__(self) -> None:
            super().__init__(engine)

    run_state_machine_as_test(
        OnEngine,
        settings=settings(
            max_examples=30,
            stateful_step_count=30,
            deadline=None,
            suppress_health_check=list(HealthCheck),
        ),
    )


def test_claimers_at_once_share_the_zones(engine: Engine, location: Location) -> None:
    names = [f"zone-{index:02}" for index in range(20)]
    with engine.begin() as connection:
        for name in names:
            ownership.add_zone(connection, name)

    def claim_all(host: str) -> list[Claim]:
        # Each host has a store of its own zone: only the rows' own locks stand between them.
        own = writing_engine(location, durable=False, zone=host)
        claimed: list[Claim] = []
        while True:
            with own.begin() as connection:
                got = ownership.claim(connection, host, now=BEGIN_US)
            if got is None:
                own.dispose()
                return claimed
            claimed.append(got)

    with ThreadPoolExecutor(10) as threads:
        claims = list(threads.map(claim_all, [f"host-{index}" for index in range(10)]))
    assert sorted(claim.zone for some in claims for claim in some) == names


def test_the_database_tells_the_time(engine: Engine) -> None:
    with engine.begin() as connection:
        ownership.add_zone(connection, "hall")
        at = connection.scalar(select(NOW_US))
        started = connection.scalar(select(STARTED_US))
        assert at is not None
        assert started is not None
        assert 1_700_000_000_000_000 < at < BEGIN_US
        assert started < at
    with engine.begin() as connection:
        claimed = ownership.claim(connection, "ash")
    if engine.dialect.name == "postgresql" and at - started < ownership.STARTING_US:
        assert claimed is None  # those who owned a zone before may renew first
        return
    assert claimed is not None
    assert claimed.epoch >= at // 1000
    with engine.begin() as connection:
        assert ownership.claim(connection, "birch") is None
        assert ownership.renew(connection, claimed)
        [row] = ownership.ownerships(connection)
    assert at + LEASE_US <= row.until_us


def test_nothing_is_claimed_just_after_the_database_has_started(engine: Engine) -> None:
    with engine.begin() as connection:
        started = connection.scalar(select(STARTED_US)) or 0
        ownership.add_zone(connection, "hall")
        soon = started + ownership.STARTING_US
        assert ownership.claim(connection, "ash", now=soon) is None
        assert ownership.claim(connection, "ash", now=soon + 1) is not None


def test_a_claim_waits_for_what_the_owner_is_writing(engine: Engine, location: Location) -> None:
    if location.is_sqlite:
        pytest.skip("a file has one writer at a time anyway")
    other = writing_engine(location, durable=False, zone="other")
    with engine.begin() as connection:
        ownership.add_zone(connection, "hall")
        owned = ownership.claim(connection, "ash", now=BEGIN_US)
    assert owned is not None
    late = BEGIN_US + LEASE_US + 1
    with engine.begin() as writing:
        ownership.assert_owned(writing, owned)
        with other.begin() as connection:
            assert ownership.claim(connection, "birch", now=late) is None
    with other.begin() as connection:
        assert ownership.claim(connection, "birch", now=late) is not None
    with engine.begin() as connection, pytest.raises(NotOwnerError, match="ash does not own hall"):
        ownership.assert_owned(connection, owned)
    other.dispose()

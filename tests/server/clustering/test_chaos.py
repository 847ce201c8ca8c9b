"""The short leg of `make chaos-cluster`, and a ledger that notices what it is for."""

import pytest
from chaos.cluster.ledger import Ledger
from chaos.cluster.trial import run_trial

from esplanade.protocol.messages import Entity, Welcome
from tests.server.brokers import NatsServer
from tests.server.clustering.clusters import Cluster
from tests.server.databases import PostgresqlServer

BOTS = 8
REST_S = 4.0


async def test_nobody_is_lost_doubled_or_a_ghost(
    at_town: Cluster, broker: NatsServer, database: PostgresqlServer
) -> None:
    kinds = ("broker killed", "zone moved", "host frozen", "database killed")
    trial = run_trial(at_town, broker, database, 7, BOTS, kinds, tell=lambda _: None, rest_s=REST_S)
    outcome = await trial
    assert outcome.faults == []
    assert outcome.gaps_s.keys() == set(kinds)
    assert outcome.counts["hops"] > 0
    assert outcome.counts["lines heard"] > 0


def welcome(person: int, name: str, *, resumed: bool = False) -> Welcome:
    """A welcome to the yard."""
    facts = dict.fromkeys(("radius", "clearance", "body_height", "step_height", "max_speed"), 1.0)
    return Welcome(
        version=4,
        id=person,
        name=name,
        resume=f"token {person}",
        resumed=resumed,
        scene={"name": "The yard"},
        tick=1,
        tick_rate=20,
        server_time=0.0,
        resume_seconds=30.0,
        walk_speed=1.0,
        origin=(0.0, 0.0),
        doors={},
        operator=False,
        **facts,
    )


def entity(person: int, name: str) -> Entity:
    """Somebody who comes into view."""
    return Entity(
        id=person,
        kind="person",
        name=name,
        layer=0,
        x=0.0,
        y=0.0,
        z=0.0,
        heading=0.0,
        radius=0.25,
        leg_m=0.8,
        stature_m=1.7,
        points_at=None,
    )


@pytest.fixture
def ledger() -> Ledger:
    """A ledger of two bots that are in and see each other."""
    made = Ledger()
    for person, name in ((1, "Ann"), (2, "Ben")):
        account = made.account(name)
        made.welcomed(account, welcome(person, name))
        made.entered(account, [entity(1, "Ann"), entity(2, "Ben")])
    return made


def test_a_ledger_finds_nothing_where_nothing_is_wrong(ledger: Ledger) -> None:
    ledger.said["Ann"].add("hello")
    ledger.heard(ledger.account("Ben"), "Ann", "hello")
    ledger.welcomed(ledger.account("Ann"), welcome(1, "Ann", resumed=True))
    ledger.entered(ledger.account("Ann"), [entity(1, "Ann"), entity(2, "Ben")])
    ledger.check_rest(["Ann", "Ben"])
    assert ledger.faults == []


def test_a_ledger_notices_doubles_ghosts_and_losses(ledger: Ledger) -> None:
    ann, ben = ledger.account("Ann"), ledger.account("Ben")
    ledger.heard(ben, "Ann", "nobody said that")
    ledger.said["Ann"].add("hello")
    ledger.heard(ben, "Ann", "hello")
    ledger.heard(ben, "Ann", "hello")
    ledger.entered(ben, [entity(3, "Ann")])
    del ann.seen[2]
    ledger.check_rest(["Ann", "Ben", "Eve"])
    ledger.welcomed(ann, welcome(7, "Ann", resumed=True))
    ledger.welcomed(ben, welcome(8, "Ben"))
    ben.zone = None
    ledger.check_rest(["Ann", "Ben"])
    told = "\n".join(ledger.faults)
    for part in (
        "who never said it",
        "'hello' 2 times",
        "Ben sees 2 people called 'Ann'",
        "there are seats of",
        "Ann does not see Ben",
        "Ann was 1 'Ann' and has come back as 7 'Ann'",
        "Ben has lost the seat of person 2",
        "Ben is not in",
    ):
        assert part in told


def test_a_ghost_is_somebody_who_is_in_another_zone(ledger: Ledger) -> None:
    ledger.account("Ben").zone = "The hall"
    ledger.check_rest(["Ann", "Ben"])
    assert "Ann sees Ben, who is not in The yard" in ledger.faults

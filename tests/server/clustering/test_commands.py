"""`esplanade cluster`, `zone` and `gateway` as they are called: what they say, and what they do."""

import asyncio
import json
from collections.abc import Iterator
from pathlib import Path

import pytest

from esplanade.commandline import interrupts
from esplanade.protocol.codes import CloseCode
from tests.server.brokers import NatsServer
from tests.server.client import joined
from tests.server.clustering.clusters import Cluster, cluster, said
from tests.server.clustering.people import back, go_on, sees, walk
from tests.server.databases import PostgresqlServer, new_database
from tests.server.http import get

PLACE = (6.0, 10.0, 0)
OTHER = (6.0, 12.0, 0)


@pytest.fixture
def without_processes(
    database: PostgresqlServer, broker: NatsServer, town: Path
) -> Iterator[Cluster]:
    """A cluster of its own, in which nothing runs."""
    with cluster(new_database(database.address), broker) as made:
        made.init(town)
        yield made


@pytest.fixture(autouse=True)
def interrupts_stay(monkeypatch: pytest.MonkeyPatch) -> None:
    """Ctrl-C goes on to end the tests, whatever commands run in this process."""
    monkeypatch.setattr(interrupts, "end_quietly", lambda: None)


async def done(at_town: Cluster, *words: str) -> str:
    """Run `esplanade cluster` while clients go on; what it prints."""
    found = await asyncio.to_thread(at_town.command, *words)
    assert found.code == 0, found
    return found.output


def test_a_world_is_put_in_once_and_changed_later(empty: Cluster, town: Path) -> None:
    again = empty.command("init", str(town))
    assert again.output == "Town: 2 zones, newcomers enter yard; no zone is new\n"
    wrong = town.with_name("wrong.json")
    wrong.write_text(json.dumps({"zones": [{"name": "moon", "scene": "moon.json"}]}))
    refused = empty.command("init", str(wrong))
    assert refused.code == 2
    assert "zones.0.scene" in refused.errors


def test_a_cluster_without_processes_says_what_is_missing(without_processes: Cluster) -> None:
    empty = without_processes
    found = empty.command("status")
    assert found.code == 1
    assert "disagreement: zone yard: nobody owns it" in found.output
    assert "disagreement: there is no gateway" in found.output
    assert empty.command("drain", "nobody").errors == (
        "esplanade cluster drain: there is no process 'nobody'\n"
    )
    assert "no host 'oak' is there" in empty.command("move", "yard", "oak").errors
    assert "there is no zone 'moon'" in empty.command("fence", "moon").errors


def test_processes_say_why_they_cannot_begin(
    empty: Cluster, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("ESPLANADE_STORE", raising=False)
    store, nats = ("--store", empty.database), ("--nats", empty.broker.address)
    nobody = "nats://127.0.0.1:1"
    for command in ("zone", "gateway"):
        away = said([command, *store, "--nats", nobody])
        assert away.code == 1
        assert f"esplanade {command}: no NATS server answers at {nobody}" in away.errors
        no_store = said([command, *nats, "--store", "postgresql://nobody@127.0.0.1:1/world"])
        assert no_store.code == 1
        assert "postgresql://nobody@127.0.0.1:1/world" in no_store.errors
        unnamed = said([command, *nats])
        assert unnamed.code == 2
        assert "store: say where the database of the cluster is" in unnamed.errors
        wrong = said([command, *store, "--nats", "broker"])
        assert "nats: 'broker' is no address such as nats://127.0.0.1:4222" in wrong.errors
        odd = said([command, *store, *nats, "--name", "My host"])
        assert "name: 'My host' is not made of" in odd.errors
    missing = said(["zone", "moon", *store, *nats])
    assert missing.code == 2
    assert "the world has no zone 'moon'; it has: hall, yard" in missing.errors


async def test_zones_move_and_hosts_end_while_people_stay(at_town: Cluster) -> None:
    east, west = at_town.ports
    async with joined(east, "Ann", PLACE) as ann, joined(west, "Ben", OTHER) as ben:
        await walk(ben, 1.0)
        for process in (each for each in at_town.processes if each.is_running):
            health = process.health_port
            assert (await get(health, "/readyz")).status == 200
            assert b"esplanade_broker_connected 1.0" in (await get(health, "/metrics")).body
        found = json.loads(await done(at_town, "status", "--json"))
        assert found["disagreements"] == []
        assert {zone["zone"]: zone["seats"] for zone in found["zones"]} == {"hall": 0, "yard": 2}
        first, second = at_town.owning("yard"), at_town.standing_by()
        place, epoch = ben.position, at_town.owner("yard")[1]

        await done(at_town, "move", "yard", second.name)
        assert (await at_town.taken_over("yard", epoch)) is second
        await go_on(ann, ben)
        assert abs(ben.position[0] - place[0]) <= 0.02  # nothing was lost
        await walk(ben, 0.5)
        await sees(ann, ben)

        epoch = at_town.owner("yard")[1]
        assert await asyncio.to_thread(second.interrupt) == 0  # Ctrl-C
        assert (await at_town.taken_over("yard", epoch)) is first
        assert any(line["event"] == "given back" for line in second.lines)
        await walk(ben, 0.5)
        await sees(ann, ben)

        epoch = at_town.owner("yard")[1]
        await done(at_town, "fence", "yard")
        await at_town.taken_over("yard", epoch + 1)
        await walk(ben, 0.5)
        await sees(ann, ben)

        assert ben.welcome is not None
        person, token = ben.id, ben.welcome.resume
        drained = at_town.gateways[1]
        await done(at_town, "drain", drained.name)
        _, code = await ben.last_words()
        assert code == CloseCode.GOING_AWAY
        async with back(east, token) as again:
            assert again.id == person
            await sees(ann, again)
        assert await asyncio.to_thread(drained.end) == 0

"""`esplanade cluster`, `zone` and `gateway` as they are called: what they say, and what they do."""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

from tests.patience import PATIENCE_S
from tests.server.client import joined
from tests.server.clustering.clusters import Cluster
from tests.server.clustering.people import go_on, sees, walk

PLACE = (6.0, 10.0, 0)
OTHER = (6.0, 12.0, 0)


def status(at_town: Cluster) -> dict[str, Any]:
    """The state of a cluster."""
    found: dict[str, Any] = json.loads(at_town.command("status", "--json").stdout)
    return found


def call(at_town: Cluster, *words: str, **variables: str) -> subprocess.CompletedProcess[str]:
    """Run `esplanade`, with other variables than those of the cluster."""
    return subprocess.run(
        [sys.executable, "-m", "esplanade", *words],
        check=False,
        capture_output=True,
        text=True,
        env={**at_town.environment, **variables},
        timeout=PATIENCE_S,
    )


def test_a_world_is_put_in_once_and_changed_later(empty: Cluster, town: Path) -> None:
    again = empty.command("init", str(town))
    assert again.stdout == "Town: 2 zones, newcomers enter yard; no zone is new\n"
    wrong = town.with_name("wrong.json")
    wrong.write_text(json.dumps({"zones": [{"name": "moon", "scene": "moon.json"}]}))
    refused = empty.command("init", str(wrong))
    assert refused.returncode == 2
    assert "zones.0.scene" in refused.stderr


def test_a_cluster_without_processes_says_what_is_missing(empty: Cluster) -> None:
    done = empty.command("status")
    assert done.returncode == 1
    assert "disagreement: zone yard: nobody owns it" in done.stdout
    assert "disagreement: there is no gateway" in done.stdout
    assert empty.command("drain", "nobody").stderr == (
        "esplanade cluster drain: there is no process 'nobody'\n"
    )
    assert "no host 'oak' is there" in empty.command("move", "yard", "oak").stderr
    assert "there is no zone 'moon'" in empty.command("fence", "moon").stderr


def test_processes_say_why_they_cannot_begin(empty: Cluster) -> None:
    nobody = "nats://127.0.0.1:1"
    for command in ("zone", "gateway"):
        away = call(empty, command, ESPLANADE_NATS=nobody)
        assert away.returncode == 1
        assert f"esplanade {command}: no NATS server answers at {nobody}" in away.stderr
        no_store = call(empty, command, ESPLANADE_STORE="postgresql://nobody@127.0.0.1:1/world")
        assert no_store.returncode == 1
        assert "postgresql://nobody@127.0.0.1:1/world" in no_store.stderr
        unnamed = call(empty, command, ESPLANADE_STORE="")
        assert unnamed.returncode == 2
        assert "store: say where the database of the cluster is" in unnamed.stderr
        wrong = call(empty, command, "--nats", "broker")
        assert "nats: 'broker' is no address such as nats://127.0.0.1:4222" in wrong.stderr
    missing = call(empty, "zone", "moon")
    assert missing.returncode == 2
    assert "the world has no zone 'moon'; it has: hall, yard" in missing.stderr


async def test_zones_move_and_hosts_end_while_people_stay(at_town: Cluster) -> None:
    east, west = at_town.ports
    async with joined(east, "Ann", PLACE) as ann, joined(west, "Ben", OTHER) as ben:
        await walk(ben, 1.0)
        found = status(at_town)
        assert found["disagreements"] == []
        assert {zone["zone"]: zone["seats"] for zone in found["zones"]} == {"hall": 0, "yard": 2}
        first, second = at_town.owning("yard"), at_town.standing_by()
        place, epoch = ben.position, at_town.owner("yard")[1]

        assert at_town.command("move", "yard", second.name).returncode == 0
        assert (await at_town.taken_over("yard", epoch)) is second
        await go_on(ann, ben)
        assert abs(ben.position[0] - place[0]) <= 0.02  # nothing was lost
        await walk(ben, 0.5)
        await sees(ann, ben)

        epoch = at_town.owner("yard")[1]
        assert at_town.command("drain", second.name).returncode == 0
        assert second.end() == 0
        assert (await at_town.taken_over("yard", epoch)) is first
        await walk(ben, 0.5)
        await sees(ann, ben)

        epoch = at_town.owner("yard")[1]
        assert at_town.command("fence", "yard").returncode == 0
        await at_town.taken_over("yard", epoch + 1)
        await walk(ben, 0.5)
        await sees(ann, ben)

        names = {each.name for each in at_town.gateways}
        drained = at_town.command("drain", at_town.gateways[1].name)
        assert drained.returncode == 0
        words, code = await ben.last_words()
        assert code == 1001
        await ann.wait_for(lambda: ann.tick > 0)
        assert len(names) == 2


def test_ctrl_c_gives_a_zone_back(at_town: Cluster) -> None:
    owner = at_town.owning("hall")
    assert owner.interrupt() == 0
    assert any(line["event"] == "given back" for line in owner.lines)
    assert at_town.owner("hall")[0] != owner.name

"""A zone that a host runs is recorded there, and runs again bit for bit."""

import asyncio
from pathlib import Path
from typing import Any

from tests.patience import PATIENCE_S
from tests.server.brokers import NatsServer
from tests.server.client import joined
from tests.server.clustering.clusters import Cluster, cluster, said
from tests.server.clustering.people import walk
from tests.server.databases import PostgresqlServer, new_database
from tests.server.recording.recorded import inputs_of_file

PLACE = (6.0, 10.0, 0)


async def visit(port: int) -> None:
    async with joined(port, "Ann Narcissus", PLACE) as ann:
        await walk(ann, 2.0)
        await ann.ticks(30)


def test_a_host_records_its_zone(
    database: PostgresqlServer, broker: NatsServer, town: Path, tmp_path: Path
) -> None:
    with cluster(new_database(database.address), broker) as made:
        made.init(town)
        host = made.host("yard", "--record", str(tmp_path), name="recorder", actors=2)
        gateway = made.gateway(name="gateway")
        host.wait_for("open")
        asyncio.run(visit(gateway.port))
        assert host.stop() == 0
    (path,) = tmp_path.iterdir()
    assert path.name == "yard.mcap"
    given = inputs_of_file(path)
    assert {"join", "steer"} <= {each["kind"].replace("_many", "") for each in given}
    assert "Narcissus" not in str(given)
    done = said(["replay", str(path), "--verify"])
    assert done.code == 0, done.errors
    assert "all equal" in done.output


def test_an_operator_at_a_gateway_has_a_host_record(
    database: PostgresqlServer, broker: NatsServer, town: Path, tmp_path: Path
) -> None:
    async def record(made: Cluster) -> dict[str, Any]:
        olga = made.operator("director", zone="yard")
        assert (await olga.get("/world"))[1]["recording"]["state"] == "off"
        status, answer = await olga.send({"op": "record", "on": True})
        assert status == 200, answer
        async with asyncio.timeout(PATIENCE_S):
            while (found := await olga.get("/world"))[1]["recording"]["seconds"] < 2:  # noqa: ASYNC110
                await asyncio.sleep(0.1)
        assert (await olga.send({"op": "record", "on": False}))[0] == 200
        assert (await olga.get("/world"))[1]["recording"]["state"] == "off"
        return dict(found[1]["recording"])

    with cluster(new_database(database.address), broker) as made:
        made.init(town)
        options = ("--record", str(tmp_path), "--record-later")
        host = made.host("yard", *options, name="recorder", actors=2)
        made.gateway(name="gateway")
        host.wait_for("open")
        assert asyncio.run(record(made))["file"] == "yard.mcap"
        done = said(["replay", str(tmp_path / "yard.mcap"), "--verify"])
    assert done.code == 0, done.errors
    assert "all equal" in done.output

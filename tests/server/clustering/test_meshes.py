"""Scenes of meshes in a cluster: hosts walk on them, gateways hand them to browsers."""

import asyncio
import json
import math
from collections.abc import Iterator
from pathlib import Path

import pytest

from esplanade.server.loading import mesh_triangles
from tests.patience import COMPILING_PATIENCE_S
from tests.server.brokers import NatsServer
from tests.server.client import Client, joined
from tests.server.clustering.clusters import Cluster, cluster
from tests.server.clustering.people import RESOLUTION_M, go_on, walk
from tests.server.databases import PostgresqlServer, new_database
from tests.server.http import get
from tests.server.worlds import write_mesh_world

HOSTS = ("ash", "birch")
PLACE = (2.0, -5.0, 0)


def write_world(folder: Path) -> Path:
    """A world of one zone, a house that is a mesh."""
    scene = write_mesh_world(folder)
    path = folder / "village.json"
    path.write_text(json.dumps({"zones": [{"name": "house", "scene": scene.name}]}))
    return path


@pytest.fixture
def village(database: PostgresqlServer, broker: NatsServer, tmp_path: Path) -> Iterator[Cluster]:
    """A cluster with an owner of the house, a host that stands by, and a gateway."""
    with cluster(new_database(database.address), broker) as made:
        made.init(write_world(tmp_path))
        for host in [made.host(name=name, actors=0) for name in HOSTS]:
            host.wait_for("ready to claim", COMPILING_PATIENCE_S)
        made.gateway(name="east").wait_for("open")
        yield made


def remove(folder: Path) -> None:
    for file in folder.iterdir():
        file.unlink()


async def mesh_at(port: int, client: Client) -> bytes:
    """The triangles that the welcome of somebody tells of."""
    assert client.welcome is not None
    answer = await get(port, f"/{client.welcome.scene['mesh']}")
    assert answer.status == 200, answer
    assert "immutable" in answer.headers["cache-control"]
    return answer.body


async def test_a_building_that_is_a_mesh_goes_over_to_another_host(
    village: Cluster, tmp_path: Path
) -> None:
    gateway = village.gateways[0]
    triangles = mesh_triangles(tmp_path / "house.obj")
    remove(tmp_path)  # nobody needs the files once they are in the database
    await village.taken_over("house", 0)
    async with joined(gateway.port, at=PLACE) as ann:
        assert ann.welcome is not None
        assert ann.welcome.scene["storeys"] == [0.0, 3.0]
        assert await mesh_at(gateway.port, ann) == triangles
        await walk(ann, 1.0)
        before, epoch = ann.position, village.owner("house")[1]
        # The successor knows the scene again by its triangles, so that nobody goes to a spawn.
        assert await asyncio.to_thread(village.owning("house").stop) == 0
        successor = await village.taken_over("house", epoch)
        await go_on(ann)
        assert math.dist(ann.position, before) <= RESOLUTION_M
        anew = "the scene is another one than before, everybody goes to a spawn"
        assert anew not in {line["event"] for line in successor.lines}


async def test_a_mesh_that_is_put_in_later_is_read_when_people_come(
    village: Cluster, tmp_path: Path
) -> None:
    house = tmp_path / "house.obj"
    house.write_text(house.read_text() + "f 1 2 3\n")
    triangles = mesh_triangles(house)
    await asyncio.to_thread(village.init, tmp_path / "village.json")
    for host in [each for each in village.processes if each.is_host]:
        assert host.stop() == 0
    successor = village.host(name="cedar", actors=0)
    await successor.told("open", zone="house")
    gateway = village.gateways[0]
    async with joined(gateway.port) as ann:
        assert await mesh_at(gateway.port, ann) == triangles

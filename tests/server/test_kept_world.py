"""A world of several zones that is killed goes on: everybody is in one zone, where they were."""

import asyncio
import json
import math
import sqlite3
from pathlib import Path
from typing import Any

import pytest

from esplanade.protocol.commands import COMMAND
from esplanade.protocol.looks import Look
from esplanade.server.accounts.identity import Identity
from esplanade.server.accounts.rights import Right
from esplanade.server.app import Running
from esplanade.server.audit.log import Filter
from esplanade.server.audit.verifying import verify
from esplanade.server.operating.forgetting import forget
from esplanade.server.store.location import FILE
from esplanade.server.world.actor_travel import ActorTravel
from tests.patience import PATIENCE_S
from tests.server.client import Client, joined
from tests.server.conftest import Serving
from tests.server.zones import BEFORE_GATE, YARD, until, write_town

EAST = 0.0
BY = Identity(account="olga", role="admin", rights=frozenset(Right), via="token")
LOOK = Look(shirt=3, hair=4, skin=7, stature_cm=185)


def died(data: Path, to: Path) -> Path:
    """A folder with what is committed at this moment: all that a dead process leaves."""
    to.mkdir()
    with sqlite3.connect(data / FILE) as live, sqlite3.connect(to / FILE) as copy:
        live.backup(copy)
    return to


async def kept(server: Running) -> None:
    """Wait for checkpoints of all zones that were begun after this call."""

    def written(zone: str) -> float:
        server.metrics.sample()
        labels = {"zone": zone}
        name = "esplanade_checkpoints_total"
        return server.metrics.registry.get_sample_value(name, labels) or 0.0

    ends = {zone: written(zone) + 2 for zone in server.zones}
    async with asyncio.timeout(PATIENCE_S):
        while any(written(zone) < end for zone, end in ends.items()):  # noqa: ASYNC110
            await asyncio.sleep(0.05)


def zones_of(server: Running, avatar_id: int) -> list[str]:
    return [name for name, zone in server.zones.items() if avatar_id in zone.world.state]


async def through_the_gate(server: Running, client: Client) -> str:
    """Walk into the hall; returns the token that takes the seat."""
    await client.move(EAST, 2.0)
    async with asyncio.timeout(PATIENCE_S):
        while zones_of(server, client.id) != ["hall"]:
            await client.next()
    assert client.welcome is not None
    return client.welcome.resume


async def test_everyone_is_where_they_were(serving: Serving, tmp_path: Path) -> None:
    town, data = write_town(tmp_path), tmp_path / "world"
    async with (
        serving(scene=None, world=town, data=data, actors=2) as server,
        joined(server.port, "Ann", at=BEFORE_GATE, look=LOOK) as ann,
        joined(server.port, "Bob", at=(6.0, 6.0, 0)) as bob,
    ):
        token = await through_the_gate(server, ann)
        assert bob.welcome is not None
        tokens = {ann.id: token, bob.id: bob.welcome.resume}
        actors = {name: sorted(map(str, zone.world.actors)) for name, zone in server.zones.items()}
        await kept(server)
        where = server.zones["hall"].world.where(ann.id)
        left = died(data, tmp_path / "left")
    async with serving(scene=None, world=town, data=left, actors=2) as server:
        zones = {one: zones_of(server, one) for one in tokens}
        assert list(zones.values()) == [["hall"], ["yard"]]
        assert actors == {
            name: sorted(map(str, zone.world.actors)) for name, zone in server.zones.items()
        }
        async with joined(server.port, "Ann", resume=tokens[ann.id]) as again:
            assert again.welcome is not None
            assert (again.id, again.welcome.resumed) == (ann.id, True)
            assert again.welcome.scene["name"] == "The hall"
            assert math.dist(again.position, where[:2]) < 0.2
            assert again.entities[ann.id].look == LOOK
            assert round(again.entities[ann.id].stature_m, 3) == 1.85
        async with joined(server.port, "Eve") as eve:
            assert eve.id > max(ann.id, bob.id)
        assert [chain.fault for chain in await verify(server.kept.store)] == [None] * 3


async def test_nobody_is_lost_or_doubled_between_two_checkpoints(
    serving: Serving, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The process dies when the store knows of the hop, and no checkpoint does."""
    town, data = write_town(tmp_path), tmp_path / "world"
    async with (
        serving(scene=None, world=town, data=data) as server,
        joined(server.port, "Ann", at=BEFORE_GATE) as ann,
    ):
        await kept(server)
        for zone in server.zones.values():
            assert zone._ticker._persistence is not None
            zone._ticker._persistence.hold()
        token = await through_the_gate(server, ann)
        async with asyncio.timeout(PATIENCE_S):
            while server.zones["hall"].hub._seating._keeper.waiting:  # type: ignore[union-attr]
                await ann.next()
        await server.kept.store.write(lambda _: None)
        left, avatar = died(data, tmp_path / "left"), ann.id
    async with (
        serving(scene=None, world=town, data=left) as server,
        joined(server.port, "Ann", resume=token) as again,
    ):
        assert zones_of(server, avatar) == ["hall"]
        assert again.id == avatar
        assert math.dist(again.position, (4.0, 6.0)) < 0.5


async def test_what_operators_did_in_a_zone_is_done_again_there(
    serving: Serving, tmp_path: Path
) -> None:
    town, data = write_town(tmp_path, actors=1), tmp_path / "world"
    async with serving(scene=None, world=town, data=data, actors=1) as server:
        await kept(server)
        hall = server.zones["hall"]
        command = {"op": "set_parameters", "scope": "world", "values": {"risk_weight": 12}}
        await hall.console.carry_out(BY, [COMMAND.validate_python(command)])
        left = died(data, tmp_path / "left")
    async with serving(scene=None, world=town, data=left, actors=1) as server:
        weights = {
            name: zone.world.parameters(str(next(iter(zone.world.actors)))).risk_weight
            for name, zone in server.zones.items()
        }
        assert weights["hall"] == 12.0
        assert weights["yard"] != 12.0
        # The audit is that of the whole world; its rows say whose they are.
        page = await server.kept.audit.page(Filter(command="set_parameters"))
        assert {row.writer for row in page.rows} == {"zone hall"}


async def test_a_changed_scene_is_kept_once_everybody_is_in_it(
    serving: Serving, tmp_path: Path
) -> None:
    town, data = write_town(tmp_path), tmp_path / "world"
    async with (
        serving(scene=None, world=town, data=data, actors=2) as server,
        joined(server.port, "Ann", at=(6.0, 6.0, 0)) as ann,
    ):
        house = [[10, 11], [14, 11], [14, 14], [10, 14]]
        polygons = [{"kind": "building", "height_m": 6, "points": house}]
        (tmp_path / "yard.json").write_text(json.dumps({**YARD, "polygons": polygons}))
        reloading = asyncio.create_task(server.reload())
        while not reloading.done():
            await ann.next()
        assert await reloading == ["yard"]
        assert ann.welcome is not None
        token, actors = ann.welcome.resume, sorted(map(str, server.world.actors))
        await kept(server)
        left = died(data, tmp_path / "left")
    async with (
        serving(scene=None, world=town, data=left, actors=2) as server,
        joined(server.port, "Ann", resume=token) as again,
    ):
        assert again.id == ann.id
        assert sorted(map(str, server.world.actors)) == actors
        assert server.world.count() == (1, 2)


async def test_who_is_forgotten_is_forgotten_in_all_zones(serving: Serving, tmp_path: Path) -> None:
    town, data = write_town(tmp_path), tmp_path / "world"
    async with (
        serving(scene=None, world=town, data=data) as server,
        joined(server.port, "Ann", at=BEFORE_GATE) as ann,
    ):
        await through_the_gate(server, ann)
        await server.zones["hall"].hub._seating._keeper.stop()  # type: ignore[union-attr]
        counts = await forget(server.kept.store, server.kept.audit, BY, "Ann")
        assert counts["seats"] == 1


async def travelled(server: Running, origin: str, to: str) -> str:
    """Let an actor of one zone go to the other; returns its id."""
    actor = str(next(iter(server.zones[origin].world.actors)))
    travel = server.zones[origin].travel
    there = server.zones[to].travel
    assert isinstance(travel, ActorTravel)
    assert there is not None
    travel._send(actor, there, (4.0, 6.0, 0.0), "gate")
    await until(lambda: actor in server.zones[to].world.actors)
    await until(lambda: actor not in server.zones[origin].world.actors)
    return actor


@pytest.mark.parametrize("late", ["yard", "hall"])
async def test_an_actor_that_was_on_its_way_is_in_one_zone(
    serving: Serving, tmp_path: Path, late: str
) -> None:
    """One of the zones has no checkpoint of after the walk: both have the actor, or none has."""
    town, data = write_town(tmp_path, with_actors=True), tmp_path / "world"
    async with serving(scene=None, world=town, data=data, actors=1) as server:
        await kept(server)
        persistence: Any = server.zones[late]._ticker._persistence
        persistence.hold()
        actor = await travelled(server, "yard", "hall")
        other = next(zone for name, zone in server.zones.items() if name != late)
        writer: Any = other._ticker._persistence._writer  # type: ignore[union-attr]
        end = writer.written + 2
        await until(lambda: writer.written >= end)
        left = died(data, tmp_path / "left")
    async with serving(scene=None, world=town, data=left, actors=1) as server:
        await until(lambda: actor in server.zones["hall"].world.actors)
        assert actor not in server.zones["yard"].world.actors
        assert sum(len(zone.world.actors) for zone in server.zones.values()) == 2


async def test_trajectories_of_each_zone_are_in_a_file_of_its_own(
    serving: Serving, tmp_path: Path
) -> None:
    town = write_town(tmp_path)
    async with serving(
        scene=None, world=town, trajectories=tmp_path / "walks.csv", actors=1
    ) as server:
        await until(lambda: all(zone.world.tick > 5 for zone in server.zones.values()))
    for zone in ("yard", "hall"):
        head = (tmp_path / f"walks-{zone}.csv").read_text()[:2000]
        assert "--world town.json" in head
        assert "--scene" not in head

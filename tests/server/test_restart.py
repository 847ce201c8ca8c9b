"""A server that is killed goes on where it was: people, actors, doors, what operators have set."""

import asyncio
import math
import sqlite3
from collections.abc import Callable
from contextlib import AsyncExitStack
from pathlib import Path
from typing import Any

import pytest
import structlog

from esplanade.protocol import VERSION
from esplanade.protocol.commands import COMMAND, Answer
from esplanade.protocol.messages import Hello
from esplanade.server import keeping as keeping_module
from esplanade.server import resuming as resuming_module
from esplanade.server.accounts.identity import Identity
from esplanade.server.accounts.rights import Right
from esplanade.server.app import Running
from esplanade.server.audit.log import Filter
from esplanade.server.checkpoint import writer
from esplanade.server.checkpoint.errors import CheckpointError
from esplanade.server.console.refusals import RefusedError
from esplanade.server.store.location import FILE, Location
from esplanade.server.store.sql_store import open_store
from tests.patience import PATIENCE_S
from tests.server.client import Client, connected, joined
from tests.server.conftest import Serving
from tests.server.databases import new_database
from tests.server.test_process import served
from tests.server.worlds import ROOM

SPEED_MPS = 1.0
LOST_S = 2.0
BY = Identity(account="olga", role="admin", rights=frozenset(Right), via="token")


def died(data: Path, to: Path) -> Path:
    """A folder with what is committed at this moment: all that a dead process leaves."""
    to.mkdir()
    with sqlite3.connect(data / FILE) as live, sqlite3.connect(to / FILE) as copy:
        live.backup(copy)
    return to


async def ordered(server: Running, **command: Any) -> Answer:
    (answer,) = await server.console.carry_out(BY, [COMMAND.validate_python(command)])
    return answer


async def checkpointed(server: Running) -> None:
    """Wait for a checkpoint that was begun after this call."""
    end = figure(server, "checkpoints_total") + 2
    async with asyncio.timeout(PATIENCE_S):
        while figure(server, "checkpoints_total") < end:  # noqa: ASYNC110 (nobody tells of it)
            await asyncio.sleep(0.05)


def figure(server: Running, name: str) -> float:
    server.metrics.sample()
    return server.metrics.registry.get_sample_value(f"esplanade_{name}") or 0.0


async def outcomes(server: Running) -> list[tuple[str, str]]:
    page = await server.kept.audit.page(Filter())
    return [(row.command, row.outcome) for row in page.rows if row.body.get("faults") is not None]


# --- a process that is killed ---------------------------------------------------------------------


async def walk_and_be_killed(room_file: Path, bots: int, *store: str) -> None:
    with served(room_file, "--actors", "3", *store) as server:
        async with AsyncExitStack() as stack:
            people = [
                await stack.enter_async_context(joined(server.port, f"Bot {k}"))
                for k in range(bots)
            ]
            for k, person in enumerate(people):
                await person.move(2.0 * math.pi * k / bots, SPEED_MPS)
            end = people[0].tick + 60
            await asyncio.gather(*(person.until_tick(end) for person in people))
            known = [(one.welcome, one.position) for one in people]
            server.process.kill()
            server.process.wait(PATIENCE_S)
    with served(room_file, "--actors", "3", *store) as server:
        async with AsyncExitStack() as stack:
            back = [
                joined(server.port, "Nobody", resume=welcome.resume)
                for welcome, _ in known
                if welcome is not None
            ]
            found = await asyncio.gather(*map(stack.enter_async_context, back))
            for again, (welcome, position) in zip(found, known, strict=True):
                assert again.welcome is not None
                assert welcome is not None
                assert (again.id, again.welcome.resumed) == (welcome.id, True)
                assert again.welcome.name == welcome.name
                assert math.dist(again.position, position) <= LOST_S * SPEED_MPS
                assert again.tick > end
            newcomer = await stack.enter_async_context(joined(server.port, "Eve"))
            assert newcomer.id > max(welcome.id for welcome, _ in known if welcome)
        assert server.stop() == 0


async def test_everyone_comes_back_where_they_stood(room_file: Path, tmp_path: Path) -> None:
    await walk_and_be_killed(room_file, 20, "--data", str(tmp_path / "world"))


async def test_everyone_comes_back_from_a_database(room_file: Path, database_server: str) -> None:
    address = new_database(database_server)
    async with open_store(Location.of(None, address), upgrading=True):
        pass
    await walk_and_be_killed(room_file, 5, "--store", address)


# --- what a dead process has left -----------------------------------------------------------------


async def test_what_was_acknowledged_is_done_again(serving: Serving, tmp_path: Path) -> None:
    async with serving(data=tmp_path / "world", actors=3) as server:
        await checkpointed(server)
        # These may or may not be in the checkpoint that is left; the audit has them all.
        await ordered(server, op="set_parameters", scope="world", values={"risk_weight": 12})
        await ordered(server, op="hold_actor", actor="main/actor-1", held=True)
        await ordered(server, op="remove_actors", actors=["main/actor-2"])
        new = {"id": "main/new", "tags": ["fast"], "overrides": {"speed_mps": 1.6}}
        await ordered(server, op="add_actors", actors=[new])
        await ordered(server, op="set_parameters", scope="group:fast", values={"radius_m": 0.3})
        latest = await ordered(server, op="send_actor", actor="main/actor-3", target="east")
        left = died(tmp_path / "world", tmp_path / "left")
    for data in (left, tmp_path / "world"):
        async with serving(data=data, actors=3) as server:
            zone, console = server.world, server.console
            assert list(zone.actors) == ["main/actor-1", "main/actor-3", "main/new"]
            assert zone.parameters("main/actor-1").risk_weight == 12.0
            new_one = zone.parameters("main/new")
            assert (new_one.speed_mps, new_one.radius_m) == (1.6, 0.3)
            assert console.state.held == {"main/actor-1"}
            assert zone.actors["main/actor-3"].behaviour.kind == "go_to"
            assert console.changes.revision == latest.command
            # The past can be taken back: first the latest, then those before it.
            for _ in range(6):
                await ordered(server, op="revert", change="latest")
            assert list(zone.actors) == ["main/actor-1", "main/actor-3", "main/actor-2"]
            assert zone.parameters("main/actor-1").risk_weight != 12.0
            with pytest.raises(RefusedError, match="made no change"):
                await ordered(server, op="revert", change="latest")


@pytest.mark.parametrize("moment", ["before_tick", "after_tick"])
async def test_what_was_not_acknowledged_never_happened(
    serving: Serving, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, moment: str
) -> None:
    """The process dies after the command's row, or after its tick and a checkpoint of that."""
    async with serving(data=tmp_path / "world", actors=2) as server:
        await ordered(server, op="set_parameters", scope="world", values={"risk_weight": 12})
        console = server.console
        reached, go_on = asyncio.Event(), asyncio.Event()

        def stopping(method: Callable[..., Any]) -> Callable[..., Any]:
            async def stop_first(*arguments: Any, **named: Any) -> Any:
                reached.set()
                await go_on.wait()
                return await method(*arguments, **named)

            return stop_first

        if moment == "before_tick":
            inputs = console._tick_inputs
            monkeypatch.setattr(inputs, "carry_out", stopping(inputs.carry_out))
        else:
            monkeypatch.setattr(console._records, "outcomes", stopping(console._records.outcomes))
        list_of = [
            {"op": "set_parameters", "scope": "world", "values": {"risk_weight": 3}},
            {"op": "remove_actors", "actors": ["main/actor-1"]},
            {"op": "add_actors", "actors": [{"id": "main/new"}]},
            {"op": "hold_actor", "actor": "main/actor-2", "held": True},
        ]
        commands = [COMMAND.validate_python(one) for one in list_of]
        asking = asyncio.create_task(console.carry_out(BY, commands))
        await reached.wait()
        await checkpointed(server)
        left = died(tmp_path / "world", tmp_path / "left")
        go_on.set()
        await asking
    async with serving(data=left, actors=2) as server:
        assert sorted(map(str, server.world.actors)) == ["main/actor-1", "main/actor-2"]
        assert server.world.parameters("main/actor-2").risk_weight == 12.0
        assert server.console.state.held == set()
        told = await outcomes(server)
        assert told[:4] == [(one["op"], "not_done") for one in reversed(list_of)]
        assert told[4:] == [("set_parameters", "done")]
        await ordered(server, op="revert", change="latest")
        assert server.world.parameters("main/actor-2").risk_weight != 12.0
    async with serving(data=left, actors=2) as server:
        assert [outcome for _, outcome in await outcomes(server)].count("not_done") == 4


async def test_mutes_and_those_who_were_sent_out(serving: Serving, tmp_path: Path) -> None:
    async with (
        serving(data=tmp_path / "world") as server,
        joined(server.port, "Ann") as ann,
        joined(server.port, "Ben") as ben,
        joined(server.port, "Cid") as cid,
    ):
        await checkpointed(server)
        await ordered(server, op="mute", person=ann.id, seconds=600, text="hush")
        await ordered(server, op="kick", person=ben.id, text="out")
        left = died(tmp_path / "world", tmp_path / "left")
        tokens = [one.welcome.resume for one in (ann, ben, cid) if one.welcome is not None]
        ids = [ann.id, ben.id, cid.id]
    async with serving(data=left) as server:
        assert 500.0 < server.console.moderation.muted_s(ids[0]) <= 600.0
        for token, avatar, comes_back in zip(tokens, ids, (True, False, True), strict=True):
            async with joined(server.port, "Dan", resume=token) as client:
                assert client.welcome is not None
                assert client.welcome.resumed == comes_back
                assert (client.id == avatar) == comes_back


async def test_a_name_stays_with_whoever_has_it_and_a_seat_waits_no_longer_than_before(
    serving: Serving, tmp_path: Path
) -> None:
    async with (
        serving(data=tmp_path / "world", resume_seconds=1.0) as server,
        joined(server.port, "Ann"),
    ):
        await checkpointed(server)
        left = died(tmp_path / "world", tmp_path / "left")
    async with (
        serving(data=left, resume_seconds=1.0) as server,
        joined(server.port, "Ann") as other,
    ):
        assert other.welcome is not None
        assert other.welcome.name == "Ann 2"
        async with asyncio.timeout(PATIENCE_S):
            while server.world.count()[0] > 1:
                await other.next()


async def test_fresh_begins_anew_and_gives_no_id_twice(serving: Serving, tmp_path: Path) -> None:
    async with serving(data=tmp_path / "world", actors=2) as server:
        await ordered(server, op="remove_actors", actors=["main/actor-1"])
        async with joined(server.port, "Ann") as ann:
            token, avatar = ann.welcome and ann.welcome.resume, ann.id
    async with serving(data=tmp_path / "world", actors=2, fresh=True) as server:
        assert list(server.world.actors) == ["main/actor-1", "main/actor-2"]
        with pytest.raises(RefusedError, match="made no change"):
            await ordered(server, op="revert", change="latest")
        async with joined(server.port, "Ann", resume=token) as ann:
            assert ann.welcome is not None
            assert not ann.welcome.resumed
            assert ann.id > avatar
        page = await server.kept.audit.page(Filter(command="remove_actors"))
        assert len(page.rows) == 2


async def test_a_checkpoint_of_another_scene_ends_the_start(
    serving: Serving, tmp_path: Path
) -> None:
    async with serving(data=tmp_path / "world"):
        pass
    other = tmp_path / "other.json"
    other.write_text(ROOM.model_copy(update={"name": "elsewhere"}).model_dump_json())
    with pytest.raises(CheckpointError, match="of the scene 'room', and this is 'elsewhere'"):
        async with serving(data=tmp_path / "world", scene=other):
            pass


async def test_damage_that_a_digest_does_not_show_ends_the_start(
    serving: Serving, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pack = writer.pack
    monkeypatch.setattr(writer, "pack", lambda parts: pack({**parts, "zone": {"specs": [1]}}))
    async with serving(data=tmp_path / "world"):
        pass
    with pytest.raises(CheckpointError, match=r"the part 'zone' .* cannot be read .*--fresh"):
        async with serving(data=tmp_path / "world"):
            pass


async def test_a_person_whose_seat_was_forgotten_comes_in_anew(
    serving: Serving, tmp_path: Path
) -> None:
    async with (
        serving(data=tmp_path / "world") as server,
        joined(server.port, "Ann") as ann,
        connected(server.port) as again,
    ):
        assert ann.welcome is not None
        token = ann.welcome.resume
        await server.kept.store.write(
            lambda connection: connection.exec_driver_sql("DELETE FROM seats")
        )
        await _hello(again, token)
        assert await again.refusal() == ("server_full", 4007)
        async with joined(server.port, "Ann", resume=token) as anew:
            assert anew.welcome is not None
            assert not anew.welcome.resumed


async def _hello(client: Client, token: str) -> None:
    await client.send(Hello(name="Ann", version=VERSION, at=None, resume=token, operator=None))


async def test_the_metrics_tell_of_checkpoints(serving: Serving, tmp_path: Path) -> None:
    async with serving(data=tmp_path / "world") as server:
        await checkpointed(server)
        assert figure(server, "checkpoints_failed_total") == 0.0
        assert figure(server, "checkpoint_bytes") > 100.0
        assert figure(server, "checkpoint_taking_seconds") > 0.0


async def test_the_start_says_what_goes_on(
    serving: Serving, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for module in (resuming_module, keeping_module):
        monkeypatch.setattr(module, "log", structlog.get_logger(module.__name__))
    async with serving(data=tmp_path / "world"):
        pass
    with structlog.testing.capture_logs() as lines:
        async with serving(data=tmp_path / "world"):
            pass
    (told,) = [line for line in lines if line["event"] == "goes on"]
    assert told["people"] == 0

"""The work of operators is there when a server comes back."""

import asyncio
from collections.abc import Callable
from pathlib import Path

from esplanade.server.app import Running
from esplanade.server.audit.log import Filter
from tests.patience import PATIENCE_S
from tests.server.conftest import Serving
from tests.server.console.operators import Operator, operator
from tests.server.test_restart import checkpointed, died, ordered


async def test_all_that_was_acknowledged_is_there_again(serving: Serving, tmp_path: Path) -> None:
    data = tmp_path / "world"
    async with serving(actors=2, data=data) as server:
        dora = await operator(server, "dora", "director")
        risk = {"op": "set_parameters", "scope": "group:kind:calm", "values": {"risk_weight": 4}}
        later = {"op": "schedule", "when": {"after_s": 3600}, "commands": [risk]}
        for command in (
            {"op": "set_group", "group": "kind:calm", "actors": ["actor-1"]},
            {**risk, "guard": {"figure": "people", "above": 500}},
            {"op": "save_preset", "name": "mine", "from_scope": "group:kind:calm"},
            later,
            {**later, "when": {"figure": {"name": "people", "above": 400}}},
            {"op": "cancel_schedule", "id": "s2"},
            {"op": "mark", "text": "closing time"},
        ):
            status, answer = await dora.send(command)
            assert status == 200, answer
        before = {path: await dora.get(path) for path in ("/groups", "/presets", "/changes")}
        _, schedules = await dora.get("/schedules")
        _, actor = await dora.get("/actors/actor-1")
        assert actor["parameters"]["risk_weight"]["group"] == "kind:calm"
    async with serving(actors=2, data=data) as server:
        dora = Operator(server.private_port, dora.token)
        for path in ("/groups", "/presets"):
            assert await dora.get(path) == before[path]
        _, found = await dora.get("/changes")
        assert [_told(change) for change in found["changes"]] == [
            _told(change) for change in before["/changes"][1]["changes"]
        ]
        _, again = await dora.get("/schedules")
        assert (again["schedules"], again["guards"]) == (
            schedules["schedules"],
            schedules["guards"],
        )
        assert (await dora.values("actor-1"))["risk_weight"] == 4.0
        number = next(c["number"] for c in found["changes"] if c["op"] == "set_parameters")
        status, answer = await dora.send({"op": "revert", "change": number})
        assert status == 200, answer
        assert (await dora.values("actor-1"))["risk_weight"] == 9.5


def _told(change: dict[str, object]) -> dict[str, object]:
    names = ("number", "account", "op", "before", "after", "note", "reverted_by", "can_revert")
    return {name: change[name] for name in names}


async def test_a_ramp_goes_on_from_where_it_was(serving: Serving, tmp_path: Path) -> None:
    ramp = {"op": "set_parameters", "scope": "world", "values": {"risk_weight": 189.5}}
    async with serving(actors=1, data=tmp_path / "world") as server:
        answer = await ordered(server, **ramp, over_s=120.0)
        at_once = died(tmp_path / "world", tmp_path / "at_once")
        await _until(server, lambda: _risk(server) > 11.0)
        await checkpointed(server)
        died(tmp_path / "world", tmp_path / "under_way")
    async with serving(actors=1, data=at_once) as server:
        await _until(server, lambda: _risk(server) > 9.5)
    # One died under way, the other ended in order: it makes no difference.
    for data in (tmp_path / "under_way", tmp_path / "world"):
        async with serving(actors=1, data=data) as server:
            assert 11.0 < _risk(server) < 189.5
            now = _risk(server)
            await _until(server, lambda now=now: _risk(server) > now + 0.5)
            async with server.console.turn:  # no step is half done
                (change,) = server.console.changes.newest_first()
                assert (change.number, change.before) == (answer.command, _world(None))
                assert change.after == _world(_risk(server))
            await ordered(server, op="revert", change="latest")
            assert _risk(server) == 9.5
            await _until(server, lambda: server.console.ongoing.under_way == 0)
            page = await server.kept.audit.page(Filter(command="set_parameters"))
            assert [row.outcome for row in page.rows] == ["done", "begun", ""]
        async with serving(actors=1, data=data) as server:
            assert (_risk(server), server.console.ongoing.under_way) == (9.5, 0)


async def test_a_ramp_that_somebody_has_ended_does_not_go_on(
    serving: Serving, tmp_path: Path
) -> None:
    ramp = {"op": "set_parameters", "scope": "world", "values": {"risk_weight": 69.5}}
    async with serving(actors=1, data=tmp_path / "world") as server:
        await ordered(server, **ramp, over_s=600.0)
        await checkpointed(server)
        await ordered(server, **{**ramp, "values": {"risk_weight": 3}})
        left = died(tmp_path / "world", tmp_path / "left")
    async with serving(actors=1, data=left) as server:
        await _until(server, lambda: server.console.ongoing.under_way == 0)
        await checkpointed(server)
        assert _risk(server) == 3.0
        page = await server.kept.audit.page(Filter(command="set_parameters"))
        assert sorted(row.outcome for row in page.rows) == ["", "", "begun", "done", "done"]


async def test_what_was_dragged_stays_as_one_change(serving: Serving, tmp_path: Path) -> None:
    drag = {"op": "set_parameters", "scope": "world", "stream": True}
    async with serving(actors=1, data=tmp_path / "world") as server:
        await ordered(server, **drag, values={"risk_weight": 4})
        left = died(tmp_path / "world", tmp_path / "left")
    async with serving(actors=1, data=left) as server:
        assert _risk(server) == 4.0
        assert [change.after for change in server.console.changes.newest_first()] == [_world(4.0)]
        assert server.console.ongoing.under_way == 0
        await ordered(server, op="revert", change="latest")
        assert _risk(server) == 9.5


async def test_what_was_missed_is_an_event(serving: Serving, tmp_path: Path) -> None:
    async with serving(actors=1, data=tmp_path / "world") as server:
        olga = await operator(server, "olga", "tuner")
        await checkpointed(server)
        # A world that goes on after a restart is five seconds further.
        await ordered(
            server,
            op="schedule",
            when={"at_tick": server.world.tick + 60},
            commands=[{"op": "set_parameters", "scope": "world", "values": {"risk_weight": 1}}],
        )
        left = died(tmp_path / "world", tmp_path / "left")
    async with serving(actors=1, data=left) as server:
        olga = Operator(server.private_port, olga.token)
        async with asyncio.timeout(PATIENCE_S):
            while not (found := (await olga.get("/events?kind=schedule"))[1]["events"]):
                await server.console.after_tick(server.world.tick + 1)
        (event,) = found
        assert event["arguments"]["schedule"] == "s1"
        assert event["arguments"]["faults"][0]["code"] == "missed"
        assert "was missed: its tick was over" in event["text"]


def _world(value: float | None) -> dict[str, dict[str, float | None]]:
    return {"world": {"risk_weight": value}}


def _risk(server: Running) -> float:
    return server.world.parameters("main/actor-1").risk_weight


async def _until(server: Running, holds: Callable[[], bool]) -> None:
    async with asyncio.timeout(PATIENCE_S):
        while not holds():
            await server.console.after_tick(server.world.tick + 1)

"""Changes that go on: dragged values, and ramps."""

import asyncio
from typing import Any

import pytest

from esplanade.protocol.commands import Facts, Price
from esplanade.server.audit.log import Filter
from esplanade.server.console import ramps, streams
from esplanade.server.console.changes import Change
from esplanade.server.store.sql_store import SqlStore
from tests.server.console.consoles import Desk, desk
from tests.server.populated import Populated

DRAG = {"op": "set_parameters", "scope": "world", "values": {"risk_weight": 10}, "stream": True}
RAMP = {"op": "set_parameters", "scope": "world", "values": {"risk_weight": 20}, "over_s": 2.0}


async def _rows(at: Desk) -> list[tuple[str, object]]:
    page = await at.audit.page(Filter(command="set_parameters"))
    return [(row.outcome, row.body) for row in reversed(page.rows)]


async def test_what_is_dragged_is_one_change_with_the_first_and_last_value(
    world: Populated, memory: SqlStore
) -> None:
    async with desk(world, memory) as at:
        numbers = []
        for value in (10, 11, 12):
            (answer,) = await at.send({**DRAG, "values": {"risk_weight": value}})
            numbers.append(answer.command)
            assert at.value("main/a1", "risk_weight") == value
        assert len(set(numbers)) == 1
        (change,) = at.console.changes.newest_first()
        assert change.before == {"world": {"risk_weight": None}}
        assert change.after == {"world": {"risk_weight": 12.0}}
        refused = await at.refused({**DRAG, "values": {"risk_weight": -1}})
        assert refused.faults[0].path == [0, "values", "risk_weight"]
        assert at.value("main/a1", "risk_weight") == 12.0
        await at.send({"op": "revert"})
        assert at.value("main/a1", "risk_weight") == 9.5
        (answer,) = await at.send(DRAG)
        assert answer.command not in numbers
        await at.console.ongoing.close()
        rows = await _rows(at)
        assert sorted(str(outcome) for outcome, _ in rows) == [
            "",
            "",
            *["begun"] * 2,
            *["done"] * 2,
        ]
        last = next(body for outcome, body in rows if outcome == "done")
        assert isinstance(last, dict)
        assert (last["after"], last["steps"]) == ({"world": {"risk_weight": 12.0}}, 3)


async def test_a_stream_does_not_end_while_the_world_prepares_its_next_value(
    world: Populated, memory: SqlStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    endings: list[asyncio.TimerHandle] = []
    loop = asyncio.get_running_loop()
    call_later = loop.call_later

    def noted(delay: float, *given: Any, **more: Any) -> asyncio.TimerHandle:
        handle = call_later(delay, *given, **more)
        if delay == streams.GAP_S:
            endings.append(handle)
        return handle

    monkeypatch.setattr(loop, "call_later", noted)
    async with desk(world, memory) as at:
        go_on = at.console.go_on

        async def prepared(change: Change, facts: Facts) -> tuple[int, Price]:
            assert [ending.cancelled() for ending in endings] == [True]
            return await go_on(change, facts)

        monkeypatch.setattr(at.console, "go_on", prepared)
        await at.send(DRAG)
        await at.send({**DRAG, "values": {"risk_weight": 12}})
        assert [ending.cancelled() for ending in endings] == [True, False]
        await at.console.ongoing.close()
        (_, _, (outcome, body)) = await _rows(at)
        assert isinstance(body, dict)
        assert (outcome, body["after"]) == ("done", {"world": {"risk_weight": 12.0}})


async def test_somebody_else_ends_a_stream(world: Populated, memory: SqlStore) -> None:
    async with desk(world, memory) as at:
        (mine,) = await at.send(DRAG)
        risk = {"op": "set_parameters", "scope": "world", "values": {"risk_weight": 3}}
        await at.send(risk, who="oleg")
        (after,) = await at.send({**DRAG, "values": {"risk_weight": 12}})
        assert after.command != mine.command
        assert after.before == {"world": {"risk_weight": 3.0}}


async def test_a_ramp_goes_there_evenly(world: Populated, memory: SqlStore) -> None:
    async with desk(world, memory) as at:
        (answer,) = await at.send(RAMP)
        assert answer.after == {"world": {"risk_weight": 20.0}}
        await at.until(lambda: at.console.ongoing.under_way == 0)
        assert at.value("main/a1", "risk_weight") == 20.0
        steps = [
            what["after"]["world"]["risk_weight"] for kind, what in at.told if kind == "change"
        ]
        assert steps == [None, *sorted(steps[1:])]
        assert len(set(steps)) >= 4
        rows = await _rows(at)
        assert [outcome for outcome, _ in rows] == ["", "begun", "done"]
        await at.send({"op": "revert"})
        assert at.value("main/a1", "risk_weight") == 9.5


async def test_a_ramp_that_fails_ends(
    world: Populated, memory: SqlStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def failing(*_: Any) -> tuple[int, Price]:
        raise ZeroDivisionError("by nought")

    async with desk(world, memory) as at:
        monkeypatch.setattr(at.console, "go_on", failing)
        await at.send(RAMP)
        await at.until(lambda: at.console.ongoing.under_way == 0)
        outcome, body = (await _rows(at))[-1]
        assert isinstance(body, dict)
        assert (outcome, body["faults"][0]["code"]) == ("refused", "failed")


async def test_a_ramp_ends_where_it_is_taken_back_or_somebody_else_sets_the_value(
    world: Populated, memory: SqlStore
) -> None:
    async with desk(world, memory) as at:
        for ending in ({"op": "revert"}, {**RAMP, "over_s": None, "values": {"risk_weight": 2}}):
            await at.send({**RAMP, "over_s": 3600.0})
            await at.until(lambda: at.value("main/a1", "risk_weight") != 9.5)
            await at.send(ending)
            found = at.value("main/a1", "risk_weight")
            await at.until(lambda: at.console.ongoing.under_way == 0)
            assert at.value("main/a1", "risk_weight") == found
        assert found == 2.0


async def test_what_cannot_go_evenly_is_refused(world: Populated, memory: SqlStore) -> None:
    async with desk(world, memory) as at:
        body = await at.refused({**RAMP, "values": {"radius_m": 0.3}})
        assert body.faults[0].code == "not_ramped"
        order = await at.refused({**RAMP, "values": {"speed_mps": 3.0}})
        assert order.faults[0].code == "values"
        assert at.console.ongoing.under_way == 0
        await at.send({**RAMP, "values": {"max_expansions": 90}, "over_s": ramps.STEP_S})
        await at.until(lambda: at.console.ongoing.under_way == 0)
        assert at.value("main/a1", "max_expansions") == 90

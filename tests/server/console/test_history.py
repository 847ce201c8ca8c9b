"""The history of changes, values side by side, marks, and what listeners are told."""

from typing import Any

import pytest

from esplanade.server.console import history
from esplanade.server.console.changes import Changes
from esplanade.server.console.refusals import RefusedError
from esplanade.server.store.sql_store import SqlStore
from tests.server.console.consoles import Desk, desk
from tests.server.populated import Populated


def _set(scope: str, value: float, **more: Any) -> dict[str, Any]:
    return {"op": "set_parameters", "scope": scope, "values": {"risk_weight": value}, **more}


def _row(at: Desk, *columns: str) -> list[Any]:
    rows = history.diff(at.console, list(columns))["rows"]
    (row,) = [row for row in rows if row["name"] == "risk_weight"]
    return list(row["values"])


async def test_values_side_by_side_now_and_then(world: Populated, memory: SqlStore) -> None:
    async with desk(world, memory) as at:
        (first,) = await at.send(_set("world", 10))
        (second,) = await at.send(_set("group:fast", 11))
        (third,) = await at.send(_set("world", 12))
        columns = (
            *("default", "preset:timid", "world", "group:fast", "actor:a1", "actor:a2"),
            *(f"change:{second.command}", f"world@{first.command}"),
        )
        assert _row(at, *columns) == [9.5, 25.0, 12.0, 11.0, 11.0, 12.0, 11.0, 10.0]
        assert _row(at, f"actor:a1@{first.command}", f"actor:a1@{third.command}") == [10.0, 11.0]
        for wrong in (
            "preset:bold",
            "actor:a9",
            "change:999",
            "change:x",
            "elsewhere",
            "world@999",
        ):
            with pytest.raises(RefusedError) as refused:
                _row(at, "world", wrong)
            assert refused.value.faults[0].path == ["columns", 1]


async def test_changes_say_who_and_whether_they_can_be_taken_back(
    world: Populated, memory: SqlStore
) -> None:
    async with desk(world, memory) as at:
        await at.send(_set("world", 10, note="try"))
        await at.send(_set("world", 12), who="oleg")
        await at.send({"op": "mark", "text": "doors open"})
        found = history.changes(at.console, None, 2)
        mark, latest = found["changes"]
        assert (mark["op"], mark["note"], mark["can_revert"]) == ("mark", "doors open", False)
        assert (latest["account"], latest["can_revert"]) == ("oleg", True)
        (oldest,) = history.changes(at.console, found["next"], 2)["changes"]
        assert (oldest["account"], oldest["note"], oldest["can_revert"]) == ("olga", "try", False)
        assert oldest["at_us"] == at.clock()
        assert ("mark", "doors open") in [(kind, what.get("text")) for kind, what in at.told]
        (undone,) = await at.send({"op": "revert", "change": "latest_of_all"})
        assert undone.after == {"world": {"risk_weight": 10.0}}
        refused = await at.refused({"op": "revert", "change": mark["number"]})
        assert refused.faults[0].code == "unknown_change"


async def test_what_was_saved_can_be_taken_back_after_a_restart(
    world: Populated, memory: SqlStore
) -> None:
    async with desk(world, memory) as at:
        (answer,) = await at.send(_set("world", 10))
        saved = at.console.changes.save()
        loaded = Changes()
        loaded.load(saved)
        assert loaded.revision == answer.revision
        assert loaded.found("latest", "olga").after == {"world": {"risk_weight": 10.0}}
        assert loaded.save() == saved


async def test_a_listener_that_fails_is_no_hindrance(world: Populated, memory: SqlStore) -> None:
    async with desk(world, memory) as at:
        at.console.listen(lambda _kind, what: what["nothing"])
        await at.send(_set("world", 10))
        assert at.value("main/a1", "risk_weight") == 10.0


async def test_a_dry_run_estimates_the_preparation(world: Populated, memory: SqlStore) -> None:
    async with desk(world, memory) as at:
        body = {"op": "set_parameters", "scope": "world", "values": {"radius_m": 0.3}}
        (dry,) = await at.send({**body, "dry_run": True})
        assert dry.price == "prepared"
        assert dry.prepare_s is not None
        assert dry.prepare_s > 0.0
        (quick,) = await at.send(_set("world", 10, dry_run=True))
        assert quick.prepare_s is None

"""Schedules and guards: when they are carried out, with which rights, and after a restart."""

from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from esplanade.server.accounts.identity import MACHINE
from esplanade.server.audit.log import Filter
from esplanade.server.console.schedules import Schedule
from esplanade.server.store.location import Location
from esplanade.server.store.sql_store import SqlStore, open_store
from tests.server.console.consoles import Clock, Desk, add_account, desk
from tests.server.populated import Populated

RISK = {"op": "set_parameters", "scope": "world", "values": {"risk_weight": 12}}


def _later(when: dict[str, Any], *commands: dict[str, Any], **more: Any) -> dict[str, Any]:
    return {"op": "schedule", "when": when, "commands": list(commands or (RISK,)), **more}


def _schedule(at: Desk, name: str = "s1") -> Schedule:
    found = at.console.state.schedules.get(name)
    assert found is not None
    return found


async def test_it_is_carried_out_at_a_tick_after_a_span_and_at_a_time_of_day(
    world: Populated, memory: SqlStore
) -> None:
    await add_account(memory, "olga", "tuner")
    async with desk(world, memory) as at:
        now = datetime.fromtimestamp(at.clock() / 1e6, UTC)
        soon = f"{now.hour:02}:{now.minute + 1:02}"
        await at.send(
            _later({"at_tick": world.zone.tick + 60}),
            _later({"after_s": 30}, {**RISK, "scope": "actor:a1", "values": {"foresight_s": 4}}),
            _later({"at_time": soon}, {**RISK, "scope": "actor:a1", "values": {"foresight_s": 5}}),
        )
        await at.until(lambda: _schedule(at, "s1").state == "done")
        assert world.zone.tick >= (_schedule(at).due_tick or 0)
        assert at.value("main/a2", "risk_weight") == 12.0
        assert _schedule(at, "s2").state == "waiting"
        at.clock.pass_s(31)
        await at.until(lambda: _schedule(at, "s2").state == "done")
        assert at.value("main/a1", "foresight_s") == 4.0
        at.clock.pass_s(31)
        await at.until(lambda: _schedule(at, "s3").state == "done")
        assert at.value("main/a1", "foresight_s") == 5.0
        change = at.console.changes.get(_schedule(at, "s3").changes[0])
        assert change is not None
        assert (change.account, change.note) == ("olga", "schedule s3")


async def test_it_is_carried_out_when_a_figure_holds_and_taken_back_afterwards(
    world: Populated, memory: SqlStore
) -> None:
    await add_account(memory, "olga", "tuner")
    async with desk(world, memory) as at:
        crowd = [0.0]
        at.console.figures.add("crowd", "1", "For this test", lambda: crowd[0])
        when = {"figure": {"name": "crowd", "above": 40, "for_s": 0}}
        await at.send(_later(when, again_after_s=20))
        assert _schedule(at).state == "waiting"
        crowd[0] = 41.0
        await at.until(lambda: _schedule(at).state == "fired")
        assert at.value("main/a1", "risk_weight") == 12.0
        at.clock.pass_s(21)
        await at.until(lambda: _schedule(at).state == "undone")
        assert at.value("main/a1", "risk_weight") == 9.5
        unknown = await at.refused(_later({"figure": {"name": "moods", "above": 1}}))
        assert unknown.faults[0].path == [0, "when", "figure", "name"]


async def test_it_is_cancelled_and_that_is_taken_back(world: Populated, memory: SqlStore) -> None:
    await add_account(memory, "olga", "tuner")
    async with desk(world, memory) as at:
        await at.send(_later({"after_s": 30}))
        await at.send({"op": "cancel_schedule", "id": "s1"}, who="oleg")
        assert _schedule(at).state == "cancelled"
        again = await at.refused({"op": "cancel_schedule", "id": "s1"})
        assert again.faults[0].code == "unknown_schedule"
        await at.send({"op": "revert", "change": "latest_of_all"})
        assert _schedule(at).state == "waiting"
        at.clock.pass_s(31)
        await at.until(lambda: _schedule(at).state == "done")


async def test_it_has_the_rights_of_its_account_at_that_moment(
    world: Populated, memory: SqlStore
) -> None:
    directory = await add_account(memory, "olga", "director")
    async with desk(world, memory) as at:
        gone = {"op": "remove_actors", "actors": ["a3"]}
        await at.send(_later({"after_s": 10}, gone), _later({"after_s": 20}))
        await directory.set_role(MACHINE, "olga", "tuner")
        at.clock.pass_s(11)
        await at.until(lambda: _schedule(at).state == "refused")
        assert _schedule(at).faults[0]["code"] == "forbidden"
        (told,) = [what for kind, what in at.told if kind == "schedule"]
        assert (told["schedule"], told["outcome"], told["account"]) == ("s1", "refused", "olga")
        assert told["faults"] == _schedule(at).faults
        assert told["text"].startswith("schedule s1 could not be carried out: ")
        assert "main/a3" in world.zone.actors
        await directory.remove(MACHINE, "olga")
        at.clock.pass_s(10)
        await at.until(lambda: _schedule(at, "s2").state == "refused")
        await at.until(lambda: not at.console.scheduler.busy)
        page = await at.audit.page(Filter(command="schedule_refused"))
        assert [row.target for row in page.rows] == ["schedule:s2", "schedule:s1"]
        assert page.rows[1].body["faults"][0]["code"] == "forbidden"
        assert at.value("main/a1", "risk_weight") == 9.5


async def test_what_cannot_be_put_off_is_refused_with_its_place(
    world: Populated, memory: SqlStore
) -> None:
    async with desk(world, memory) as at:
        for command, path in (
            ({"op": "revert"}, ["commands", 1]),
            ({"op": "kick", "person": 1}, ["commands", 1]),
            (_later({"after_s": 1}), ["commands", 1]),
            ({**RISK, "values": {}}, ["commands", 1, "values"]),
            ({**RISK, "dry_run": True}, ["commands", 1]),
        ):
            refused = await at.refused(_later({"after_s": 30}, RISK, command))
            assert refused.faults[0].path == [0, *path], refused.faults
        passed = await at.refused(_later({"at_time": "2020-01-01T00:00:00Z"}))
        assert passed.faults[0].code == "passed"
        assert list(at.console.state.schedules) == []


async def test_it_goes_on_after_a_restart_and_what_was_missed_is_told(
    world: Populated, tmp_path: Path
) -> None:
    clock = Clock()
    async with open_store(Location.of(tmp_path)) as store:
        await add_account(store, "olga", "tuner")
        async with desk(world, store, clock) as at:
            guard = {"figure": "people", "above": 99, "for_s": 0}
            await at.send(
                _later({"after_s": 100}), _later({"after_s": 500}), RISK | {"guard": guard}
            )
            await at.send({"op": "revert"})
    clock.pass_s(200)
    async with open_store(Location.of(tmp_path)) as store, desk(world, store, clock) as at:
        assert _schedule(at, "s1").state == "missed"
        (fault,) = _schedule(at, "s1").faults
        assert (fault["code"], fault["arguments"]["now_us"]) == ("missed", clock())
        await at.until(lambda: not at.console.scheduler.busy)
        (told,) = [what for kind, what in at.told if kind == "schedule"]
        assert (told["schedule"], told["outcome"], told["faults"]) == ("s1", "missed", [fault])
        (row,) = (await at.audit.page(Filter(command="schedule_missed"))).rows
        assert (row.target, row.outcome, row.body["faults"]) == ("schedule:s1", "missed", [fault])
        assert _schedule(at, "s2").state == "waiting"
        assert at.value("main/a1", "risk_weight") == 9.5
        assert len(list(at.console.scheduler.guards)) == 1
        clock.pass_s(301)
        await at.until(lambda: _schedule(at, "s2").state == "done")
        assert at.value("main/a1", "risk_weight") == 12.0
        await at.send(_later({"after_s": 5}))
        assert _schedule(at, "s3").state == "waiting"


async def test_a_guard_takes_a_change_back(world: Populated, memory: SqlStore) -> None:
    await add_account(memory, "olga", "tuner")
    async with desk(world, memory) as at:
        contacts = [0.0]
        at.console.figures.add("contacts_per_minute", "1/min", "", lambda: contacts[0])
        guard = {"figure": "contacts_per_minute", "above": 3, "for_s": 0}
        (answer,) = await at.send({**RISK, "guard": guard})
        (made,) = at.console.scheduler.guards
        assert (made.id, made.state) == (f"g{answer.command}", "watching")
        contacts[0] = 3.5
        change = at.console.changes.get(answer.command or 0)
        assert change is not None
        await at.until(lambda: change.reverted_by is not None)
        assert at.value("main/a1", "risk_weight") == 9.5
        reverted = at.console.changes.get(change.reverted_by or 0)
        assert reverted is not None
        assert "contacts_per_minute is 3.5, above 3" in (reverted.note or "")
        wrong = await at.refused({**RISK, "guard": {**guard, "figure": "moods"}})
        assert wrong.faults[0].path == [0, "guard", "figure"]


async def test_a_guard_of_what_was_taken_back_ends(world: Populated, memory: SqlStore) -> None:
    async with desk(world, memory) as at:
        guard = {"figure": "people", "below": 1, "for_s": 3600}
        await at.send({**RISK, "guard": guard})
        (made,) = at.console.scheduler.guards
        await at.send({"op": "revert"})
        await at.until(lambda: made.state == "ended")
        await at.send({**RISK, "guard": {**guard, "within_s": 10}})
        _, second = at.console.scheduler.guards
        at.clock.pass_s(11)
        await at.until(lambda: second.state == "ended")
        assert at.value("main/a1", "risk_weight") == 12.0

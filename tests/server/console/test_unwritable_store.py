"""A store that cannot be written: what is done is remembered, and the rest is told as it is."""

from collections.abc import Callable, Sequence
from typing import Any

import pytest
from sqlalchemy import Connection

from esplanade.protocol.commands import Answer, Command
from esplanade.server.accounts.identity import Identity
from esplanade.server.audit.log import Filter
from esplanade.server.console import guards, records, scheduler
from esplanade.server.console.guards import Guard
from esplanade.server.console.moderating import Moderating
from esplanade.server.console.operated_rows import OperatedRow
from esplanade.server.console.schedule_records import ScheduleRecords
from esplanade.server.console.schedules import Schedule
from esplanade.server.console.settling import UnkeptError
from esplanade.server.store.sql_store import SqlStore
from esplanade.server.store.store import StoreBusyError, StoreError
from tests.server.console.consoles import Desk, add_account, desk
from tests.server.populated import Populated

RISK = {"op": "set_parameters", "scope": "world", "values": {"risk_weight": 12}}
GUARD = {"figure": "people", "below": 1, "for_s": 0}
LATER = {"op": "schedule", "when": {"after_s": 10}, "commands": [RISK]}


class Failing:
    """A console's way for commands that fails some times first."""

    def __init__(self, at: Desk, error: Exception, times: int) -> None:
        self._carry_out = at.console.carry_out
        self._error, self._left = error, times
        self.seen: list[str] = []
        """The states of guards at each failure."""
        self._at = at

    async def __call__(self, by: Identity, commands: Sequence[Command]) -> list[Answer]:
        if self._left:
            self._left -= 1
            self.seen += [guard.state for guard in self._at.console.scheduler.guards]
            raise self._error
        return await self._carry_out(by, commands)


@pytest.fixture(autouse=True)
def at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """No time between two tries."""
    monkeypatch.setattr(scheduler, "PAUSE_S", 0.0)


def _fail(monkeypatch: pytest.MonkeyPatch, at: Desk, error: Exception, times: int) -> Failing:
    failing = Failing(at, error, times)
    monkeypatch.setattr(at.console, "carry_out", failing)
    return failing


def _schedule(at: Desk, name: str = "s1") -> Schedule:
    found = at.console.state.schedules.get(name)
    assert found is not None
    return found


async def _outcomes(at: Desk, command: str) -> list[tuple[str, list[str]]]:
    """The outcomes of a command in the audit, the oldest first, with the codes of their faults."""
    rows = (await at.audit.page(Filter(command=command))).rows
    return [
        (row.outcome, [fault["code"] for fault in row.body.get("faults", ())])
        for row in reversed(rows)
        if row.outcome
    ]


async def test_a_guard_has_taken_back_only_once_it_has(
    world: Populated, memory: SqlStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    await add_account(memory, "olga", "tuner")
    async with desk(world, memory) as at:
        await at.send({**RISK, "guard": {**GUARD, "for_s": 0.2}})
        (guard,) = at.console.scheduler.guards
        failing = _fail(monkeypatch, at, StoreBusyError("too much waits"), 2)
        await at.until(lambda: guard.state != "watching")
        assert failing.seen == ["watching"] * 2
        assert guard.state == "taken_back"
        assert at.value("main/a1", "risk_weight") == 9.5


@pytest.mark.parametrize(
    ("error", "code"),
    [(StoreError("the disk is gone"), "unwritable"), (ZeroDivisionError("by nought"), "failed")],
)
async def test_a_guard_that_cannot_take_back_says_so(
    world: Populated,
    memory: SqlStore,
    monkeypatch: pytest.MonkeyPatch,
    error: Exception,
    code: str,
) -> None:
    await add_account(memory, "olga", "tuner")
    async with desk(world, memory) as at:
        await at.send({**RISK, "guard": {**GUARD, "for_s": 0.2}})
        (guard,) = at.console.scheduler.guards
        _fail(monkeypatch, at, error, scheduler.TRIES)
        await at.until(lambda: guard.state != "watching")
        await at.until(lambda: not at.console.scheduler.busy)
        assert (guard.state, [fault["code"] for fault in guard.faults]) == ("refused", [code])
        assert at.value("main/a1", "risk_weight") == 12.0
        (told,) = [what for kind, what in at.told if kind == "schedule"]
        assert (told["guard"], told["outcome"]) == (guard.id, "refused")
        assert await _outcomes(at, "guard_refused") == [("refused", [code])]


async def test_a_schedule_is_carried_out_though_it_cannot_be_kept(
    world: Populated, memory: SqlStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    await add_account(memory, "olga", "tuner")

    async def unkept(_: ScheduleRecords, item: Schedule | Guard) -> None:
        raise StoreError("the disk is gone")

    async with desk(world, memory) as at:
        await at.send({**LATER, "guard": GUARD | {"for_s": 3600}})
        monkeypatch.setattr(ScheduleRecords, "keep", unkept)
        at.clock.pass_s(11)
        await at.until(lambda: _schedule(at).state == "done")
        assert at.value("main/a1", "risk_weight") == 12.0
        await at.until(lambda: len(list(at.console.scheduler.guards)) == 1)


async def test_after_a_schedule_that_fails_the_next_is_carried_out(
    world: Populated, memory: SqlStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    await add_account(memory, "olga", "tuner")
    async with desk(world, memory) as at:
        await at.send(LATER, LATER)
        _fail(monkeypatch, at, ZeroDivisionError("by nought"), 1)
        at.clock.pass_s(11)
        await at.until(lambda: _schedule(at, "s2").state == "done")
        assert _schedule(at).state == "refused"
        assert [fault["code"] for fault in _schedule(at).faults] == ["failed"]


async def test_a_schedule_that_no_guard_could_watch_over_is_refused(
    world: Populated, memory: SqlStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    await add_account(memory, "olga", "tuner")
    async with desk(world, memory) as at:
        await at.send({**LATER, "guard": GUARD})
        monkeypatch.setattr(guards, "MOST", 0)
        at.clock.pass_s(11)
        await at.until(lambda: _schedule(at).state == "refused")
        assert [fault["code"] for fault in _schedule(at).faults] == ["full"]
        assert at.value("main/a1", "risk_weight") == 9.5


async def test_what_cannot_be_kept_about_people_has_an_outcome(
    world: Populated, memory: SqlStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    async def unkept(*_: Any) -> None:
        raise StoreError("the disk is gone")

    async with desk(world, memory) as at:
        monkeypatch.setattr(Moderating, "carry_out", unkept)
        with pytest.raises(StoreError, match="the disk is gone"):
            await at.send({"op": "announce", "text": "hear"})
        assert await _outcomes(at, "announce") == [("refused", ["unwritable"])]
        page = await at.audit.page(Filter(command="announce"))
        assert at.console.settled == min(row.seq for row in page.rows)


def _unwritable(write: Callable[..., None]) -> Callable[..., None]:
    def unwritable(connection: Connection, zone: str, rows: list[OperatedRow]) -> None:
        if rows:
            raise StoreError("the disk is gone")
        write(connection, zone, rows)

    return unwritable


async def test_what_the_world_has_taken_is_remembered_where_the_rest_cannot_be_kept(
    world: Populated, memory: SqlStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(records, "write_rows", _unwritable(records.write_rows))
    async with desk(world, memory) as at:
        preset = {"op": "save_preset", "name": "mine", "values": {"risk_weight": 9}}
        with pytest.raises(UnkeptError, match="the disk is gone"):
            await at.send({**RISK, "guard": GUARD | {"for_s": 3600}}, preset)
        facts = {"world": {"risk_weight": 12.0}, "preset:mine": {"preset": None}}
        assert at.console.state.now(facts) == facts
        assert at.value("main/a1", "risk_weight") == 12.0
        assert [change.op for change in at.console.changes.newest_first()] == ["set_parameters"]
        assert [guard.state for guard in at.console.scheduler.guards] == ["watching"]
        assert await _outcomes(at, "set_parameters") == [("done", [])]
        assert await _outcomes(at, "save_preset") == [("refused", ["unwritable"])]
        await at.send({"op": "revert"})
        assert at.value("main/a1", "risk_weight") == 9.5

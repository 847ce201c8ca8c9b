"""Decisions are committed before they hold; reports are written later; the forgotten go."""

import asyncio
from contextlib import suppress
from dataclasses import replace

import pytest

from esplanade.server.accounts.identity import MACHINE
from esplanade.server.audit.log import AuditLog
from esplanade.server.moderation import inbox, rows, state
from esplanade.server.moderation.bans import Ban
from esplanade.server.moderation.chat_log import KeptLine
from esplanade.server.moderation.inbox import Inbox, InboxFullError, Report
from esplanade.server.moderation.state import ModerationState
from esplanade.server.operating.forgetting import forget
from esplanade.server.store.sql_store import SqlStore
from esplanade.server.store.store import StoreError


def ban(number: int, name: str = "Eve") -> Ban:
    return Ban(number, "No.", None, 5, "mona", ("ab", "cd"), name, "192.0.2.0/24")


def report(number: int) -> Report:
    return Report(number, 5, 1, "Ann", 2, "Eve", "is rude", (1.0, 2.0, 0.0), 77, "hey")


def line(number: int, name: str = "Eve") -> KeptLine:
    return KeptLine(number, 10**18, 3, 2, name, "hey", (1, 2))


async def opened(store: SqlStore, **more: object) -> ModerationState:
    made = ModerationState(store, **more)  # type: ignore[arg-type]
    await made.load()
    return made


def given(held: ModerationState) -> int:
    """The number of the next report."""
    number = held.inbox.numbers.take()
    assert number is not None
    return number


async def test_all_is_there_again(store: SqlStore) -> None:
    first = await opened(store, keeps_chat=True, chat_days=3)
    number = first.next_ban()
    await first.decide({f"ban:{number}": {"banned": True}}, [ban(number)], "mona")
    assert first.report(report(1), "192.0.2.7")
    first.said(line(77))
    await first.later.flush()
    await first.decide({"line:77": {"hidden": True}, "report:1": {"state": "done"}}, [], "mona")
    again = await opened(store, keeps_chat=True, chat_days=3)
    assert list(again.bans) == list(first.bans)
    assert list(again.inbox) == list(first.inbox)
    assert [each.hidden for each in again.chat] == [True]
    assert again.next_ban() == number + 1


async def test_who_is_forgotten_in_the_store_is_forgotten_here(store: SqlStore) -> None:
    held = await opened(store, keeps_chat=True, chat_days=3)
    await held.decide({"ban:1": {"banned": True}}, [ban(1)], None)
    await held.decide({"ban:2": {"banned": True}}, [ban(2, "Bob")], None)
    held.report(report(1), "192.0.2.7")
    held.said(line(77))
    held.said(line(78, "Bob"))
    await held.later.flush()
    counts = await forget(store, AuditLog(store, "server"), MACHINE, "Eve")
    assert (counts["bans"], counts["reports"], counts["chat"]) == (1, 1, 1)
    held.said(line(79, "Bob"))  # not written yet, so that its row is missing for another reason
    await held.refresh()
    assert [each.id for each in held.bans] == [2]
    assert list(held.inbox) == []
    assert [each.line for each in held.chat] == [78, 79]
    counts = await forget(store, AuditLog(store, "server"), MACHINE, "mona")
    assert counts["bans"] == 1
    again = await opened(store)
    assert [(each.name_pattern, each.by) for each in again.bans] == [("Bob", None)]


async def test_what_cannot_be_written_does_not_hold(store: SqlStore) -> None:
    held = await opened(store)
    await store.close()
    with pytest.raises(StoreError):
        await held.decide({"ban:1": {"banned": True}}, [ban(1)], None)
    assert held.bans.get(1) is None


async def test_a_full_queue_refuses_and_what_waits_is_written_in_the_end(
    store: SqlStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(state, "MOST_WRITTEN_LATER", 2)
    held = await opened(store)
    taken = [held.report(report(k), f"192.0.2.{k}") for k in (1, 2, 3)]
    assert taken == [True, True, False]
    assert held.later.refused == 1
    running = asyncio.create_task(held.run())
    await held.later.written()
    running.cancel()
    with suppress(asyncio.CancelledError):
        await running
    assert [each.id for each in (await opened(store)).inbox] == [1, 2]


def test_an_inbox_forgets_the_oldest_that_are_settled(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(inbox, "MOST_KEPT", 3)
    monkeypatch.setattr(inbox, "MOST_OPEN", 3)
    box = Inbox()
    for k in (1, 2, 3):
        box.check_room(f"a{k}")
        assert box.add(report(k), f"a{k}") == []
    with pytest.raises(InboxFullError):
        box.check_room("a4")
    box.settle(2, "done", "mona")
    box.check_room("a4")
    assert box.add(report(4), "a4") == [2]
    assert ([each.id for each in box], box.open) == ([1, 3, 4], 3)


async def test_decisions_of_other_processes_are_taken_in(store: SqlStore) -> None:
    east, west = await opened(store), await opened(store)
    east.number_apart(0, 2)
    west.number_apart(1, 2)
    sent_out: list[tuple[int, int | None]] = []

    def turn_out(one: Ban, person: int | None) -> int:
        sent_out.append((one.id, person))
        return 0

    west.turns_out.append(turn_out)
    numbers = east.next_ban(), west.next_ban()
    assert len({*numbers}) == 2
    await east.decide({f"ban:{numbers[0]}": {"banned": True}}, [ban(numbers[0])], "mona")
    await west.decide({f"ban:{numbers[1]}": {"banned": True}}, [ban(numbers[1], "Bob")], "max")
    await east.decide({"people": {"slow_mode_s": 5.0}}, [], "mona")
    await west.look()
    assert sent_out == [(numbers[0], None)]  # its own was told of where it was made
    assert west.rules.every_s == 5.0
    assert sorted(each.id for each in west.bans) == sorted(numbers)
    assert {east.next_ban(), west.next_ban()}.isdisjoint(numbers)
    await west.decide({f"ban:{numbers[0]}": {"banned": False}}, [], "max")
    await east.look()
    assert east.fact(f"ban:{numbers[0]}", "banned") is False
    assert east.fact(f"ban:{numbers[1]}", "banned") is True
    await east.decide({"people": {"slow_mode_s": None}}, [], "mona")
    await west.look()
    assert west.rules.every_s == 0.0
    assert sent_out == [(numbers[0], None)]


async def test_reports_to_other_processes_are_taken_in(store: SqlStore) -> None:
    east, west = await opened(store), await opened(store)
    numbers = given(east), given(west)
    for one, number in zip((east, west), numbers, strict=True):
        assert one.report(report(number), "there")
        await one.later.flush()
    for one in (east, west):
        await one.look()
        assert (sorted(each.id for each in one.inbox), one.inbox.open) == (sorted(numbers), 2)
    assert {given(east), given(west)}.isdisjoint(numbers)
    await west.decide({f"report:{numbers[0]}": {"state": "done"}}, [], "mona")
    await east.look()
    settled = east.inbox.get(numbers[0])
    assert settled is not None
    assert (settled.state, settled.settled_by, east.inbox.open) == ("done", "mona", 1)


async def test_a_look_that_a_decision_overtakes_drops_nothing(store: SqlStore) -> None:
    held = await opened(store)
    looking = asyncio.create_task(held.look())
    await held.decide({"ban:1": {"banned": True}}, [ban(1)], None)
    await looking
    assert held.fact("ban:1", "banned") is True


async def test_a_host_that_was_frozen_shares_no_number_with_its_successor(store: SqlStore) -> None:
    frozen = await opened(store)
    frozen.number_apart(0, 2)
    assert frozen.report(report(given(frozen)), "there")  # and it is frozen before this is written
    successor = await opened(store)
    successor.number_apart(0, 2)
    assert successor.report(replace(report(given(successor)), text="shouts"), "there")
    await successor.later.flush()
    assert frozen.report(replace(report(given(frozen)), text="pushes"), "there")
    await frozen.later.flush()
    assert (frozen.later.waiting, frozen.later.failed) == (0, 0)
    await frozen.look()
    for held in (frozen, await opened(store)):
        assert sorted(each.text for each in held.inbox) == ["is rude", "pushes", "shouts"]


async def test_more_numbers_of_reports_are_reserved_before_the_last_is_given(
    store: SqlStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(rows, "REPORT_NUMBERS", 4)
    east, west = await opened(store), await opened(store)
    numbers = [given(east), given(east)]
    for held in (east, west):
        await held.refresh()
    assert (east.inbox.numbers.left, west.inbox.numbers.left) == (6, 4)
    numbers += [given(each) for each in (east, west) for _ in range(each.inbox.numbers.left)]
    assert len({*numbers}) == len(numbers) == 12
    assert east.inbox.numbers.take() is None


async def test_numbers_go_on_above_reports_of_a_version_that_reserved_none(store: SqlStore) -> None:
    await store.write(lambda connection: rows.put_report(connection, store.zone, report(5000)))
    assert given(await opened(store)) == 5001

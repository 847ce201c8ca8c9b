"""All that moderators have decided about people and chat, in memory and in the store."""

import asyncio
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from functools import partial
from typing import Any, Final

import structlog
from sqlalchemy import Connection

from esplanade.server.checkpoint.ids import Block
from esplanade.server.moderation import rows
from esplanade.server.moderation.bans import Ban, Bans
from esplanade.server.moderation.chat_log import ChatLog, KeptLine
from esplanade.server.moderation.chat_rules import SLOW, WORDS, ZONE, ChatRules
from esplanade.server.moderation.inbox import Inbox, Report
from esplanade.server.moderation.written_later import WrittenLater
from esplanade.server.store.store import Store, StoreError

MOST_WRITTEN_LATER: Final = 1024
"""Reports and lines of chat that may wait for the store; more are refused."""
REFRESH_S: Final = 30.0
"""So often it is seen whether somebody was forgotten in the store, and old lines are dropped."""
DAY_US: Final = 86_400_000_000
BANS_KEPT_US: Final = 30 * DAY_US
"""Bans that are over can be looked at for so long."""
PATIENCE_S: Final = 5.0
PEOPLE: Final = "people"
"""The subject of rules of chat that hold everywhere."""
_RULES: Final = {"slow_mode_s": SLOW, "word_filter": WORDS}

log = structlog.get_logger(__name__)
Facts = Mapping[str, Mapping[str, Any]]


class ModerationState:
    """Bans, rules of chat, the inbox, and the lines that are kept.

    Facts about them are fields of the subjects `ban:ID`, `report:ID`, `line:NUMBER`,
    `quiet_zone:NAME` and `people`. What operators decide is committed before it holds; reports and
    lines of people hold at once and are written later.
    """

    def __init__(
        self,
        store: Store,
        *,
        keeps_chat: bool = False,
        chat_days: int = 0,
        clock_us: Callable[[], int] = lambda: time.time_ns() // 1000,
    ) -> None:
        self.bans = Bans()
        self.rules = ChatRules()
        self.inbox = Inbox()
        self.chat = ChatLog(keeps=keeps_chat)
        self.later = WrittenLater(store, MOST_WRITTEN_LATER)
        self.turns_out: list[Callable[[Ban, int | None], int]] = []
        """Called with each ban that has come to hold, and the person whom it was made of, if any:
        whoever serves people sends those out whom it is of, and tells how many they are."""
        self._store = store
        self._days = chat_days
        self._rules: dict[str, Any] = {}
        """The rules of chat as they were read last."""
        self.now_us = clock_us
        self.decided: list[Callable[[], None]] = []
        """Called after each decision of an operator that is to last."""
        self._decisions = 0
        self._last_ban = 0
        self._apart = (0, 1)
        self._known: tuple[set[int], set[int], set[int]] = (set(), set(), set())
        """Ids of bans and reports, and numbers of lines, that are known to be in the store."""

    async def load(self) -> None:
        """Begin with what was kept.

        Raises
        ------
        StoreError
            The store cannot be used.
        """
        zone, old_us = self._store.zone, self.now_us() - BANS_KEPT_US

        def begin(connection: Connection) -> tuple[Any, Any, Any, Any, Block]:
            rows.drop_old_bans(connection, zone, old_us)
            self._drop_lines(connection)
            return (
                rows.all_bans(connection, zone),
                rows.all_reports(connection, zone),
                rows.all_rules(connection, zone),
                rows.last_lines(connection, zone) if self.chat.keeps else [],
                rows.reserve_reports(connection, zone),
            )

        bans, reports, rules, lines, numbers = await self._store.write(begin)
        for ban in bans:
            self.bans.put(ban)
        self._last_ban = max((ban.id for ban in bans), default=0)
        self.inbox.load(reports)
        self.inbox.numbers.add(numbers)
        self._rules = rules
        for name, value in rules.items():
            self.rules = self.rules.with_rule(name, value)
        for line in lines:
            self.chat.add(line)
        self._known = ({b.id for b in bans}, {r.id for r in reports}, {n.line for n in lines})

    # --- what operators decide ------------------------------------------------------------------

    def next_ban(self) -> int:
        """An id that no ban has had."""
        place, of = self._apart
        self._last_ban += 1 + (place - self._last_ban - 1) % of
        return self._last_ban

    def number_apart(self, place: int, of: int) -> None:
        """Let ids of bans be others than those that other processes give at the same time: this one
        is at a `place` from 0 on, `of` so many. A ban whose id is taken is refused."""
        self._apart = place, of

    def fact(self, subject: str, field: str) -> Any:
        """The present value of a field of a subject."""
        kind, _, name = subject.partition(":")
        match kind:
            case "ban":
                ban = self.bans.get(int(name))
                return ban is not None and not ban.lifted
            case "report":
                report = self.inbox.get(int(name))
                return None if report is None else report.state
            case "line":
                return self.chat.is_hidden(int(name))
            case "quiet_zone":
                return self.rules.rule(f"{ZONE}{name}")
            case "people" if field in _RULES:
                return self.rules.rule(_RULES[field])
        return None

    async def decide(self, facts: Facts, new_bans: Iterable[Ban], by: str | None) -> None:
        """Write facts that operators want into the store, and let them hold.

        Raises
        ------
        StoreError
            They could not be written, and do not hold.
        """
        bans = {ban.id: ban for ban in new_bans}
        wanted = [(s, f, v) for s, fields in facts.items() for f, v in fields.items()]
        writing = [
            change for one in wanted if (change := self._writing(*one, bans, by)) is not None
        ]
        if any(subject.startswith(("report:", "line:")) for subject, _, _ in wanted):
            await self._all_written()
        if writing:
            await self._store.write(lambda connection: [change(connection) for change in writing])
        for subject, field, value in wanted:
            self._hold(subject, field, value, bans, by)
        self._decisions += 1
        for call in self.decided:
            call()

    async def _all_written(self) -> None:
        """Wait until the reports and lines that are to be changed are in the store."""
        try:
            async with asyncio.timeout(PATIENCE_S):
                await self.later.written()
        except TimeoutError:
            raise StoreError("what people sent is not written yet") from None

    def _writing(
        self, subject: str, field: str, value: Any, bans: Mapping[int, Ban], by: str | None
    ) -> Callable[[Connection], None] | None:
        zone, (kind, _, name) = self._store.zone, subject.partition(":")
        match kind:
            case "ban" if int(name) in bans:
                return lambda connection: rows.put_ban(connection, zone, bans[int(name)])
            case "ban":
                return lambda connection: rows.lift_ban(
                    connection, zone, int(name), lifted=not value
                )
            case "report":
                return lambda connection: rows.settle_report(connection, zone, int(name), value, by)
            case "line":
                return lambda connection: rows.hide_line(connection, zone, int(name))
        rule = _rule_of(subject, field)
        if rule is None:
            return None
        return lambda connection: rows.put_rule(connection, zone, rule, value)

    def _hold(
        self, subject: str, field: str, value: Any, bans: Mapping[int, Ban], by: str | None
    ) -> None:
        kind, _, name = subject.partition(":")
        rule = _rule_of(subject, field)
        if kind == "ban" and int(name) in bans:
            self.bans.put(bans[int(name)])
            self._known[0].add(int(name))
        elif kind == "ban":
            self.bans.lift(int(name), lifted=not value)
        elif kind == "report":
            self.inbox.settle(int(name), value, by)
        elif kind == "line":
            self.chat.hide(int(name))
        elif rule is not None:
            self.rules = self.rules.with_rule(rule, value)

    # --- what people do -------------------------------------------------------------------------

    def report(self, report: Report, address: str) -> bool:
        """Take a report into the inbox; False if too many wait for the store.

        There must be room in the inbox.
        """
        zone = self._store.zone
        write = partial(rows.put_report, zone=zone, report=report)
        if not self.later.put(write, partial(self._known[1].add, report.id)):
            return False
        for gone in self.inbox.add(report, address):
            self.later.put(partial(rows.drop_report, zone=zone, report=gone))
        return True

    def said(self, line: KeptLine) -> None:
        """Keep a line of chat, where this server keeps chat."""
        if not self.chat.keeps:
            return
        self.chat.add(line)
        if self._days:
            write = partial(rows.put_line, zone=self._store.zone, line=line)
            self.later.put(write, partial(self._known[2].add, line.line))

    async def look(self) -> None:
        """Take in what other processes have decided: their rules hold, and those go whom their
        bans are of. What people have reported to them is in the inbox.

        Raises
        ------
        StoreError
            The store cannot be read.
        """
        zone, decisions = self._store.zone, -1
        reported = frozenset(self._known[1])

        def read(connection: Connection) -> tuple[list[Ban], dict[str, Any], Any]:
            reports = rows.reports_but(connection, zone, reported)
            return rows.all_bans(connection, zone), rows.all_rules(connection, zone), reports

        while decisions != self._decisions:  # what was decided here meanwhile is not in it
            decisions = self._decisions
            bans, rules, (new, states) = await self._store.read(read)
        self._known[1].update(states)
        self.inbox.take_in(new, states)
        if rules != self._rules:
            self._rules, self.rules = rules, ChatRules()
            for name, value in rules.items():
                self.rules = self.rules.with_rule(name, value)
        for gone in {ban.id for ban in self.bans} - {ban.id for ban in bans}:
            self.bans.drop(gone)
        now_us = self.now_us()
        for ban in bans:
            known = self.bans.get(ban.id)
            if known == ban:
                continue
            self.bans.put(ban)
            self._known[0].add(ban.id)
            self._last_ban = max(self._last_ban, ban.id)
            if ban.holds(now_us):
                for turn_out in self.turns_out:
                    turn_out(ban, None)

    # --- over time ------------------------------------------------------------------------------

    async def run(self) -> None:
        """Write what people do, and forget here whom the store has forgotten, until cancelled."""
        writing = asyncio.create_task(self.later.run())
        try:
            while True:
                await asyncio.sleep(REFRESH_S)
                with suppress(StoreError):
                    await self.refresh()
        finally:
            writing.cancel()
            with suppress(asyncio.CancelledError):
                await writing
            await self.later.flush()

    async def refresh(self) -> None:
        """Drop lines that are too old, and what was forgotten in the store; reserve numbers of
        reports where few are left.

        Raises
        ------
        StoreError
            The store cannot be used.
        """
        zone = self._store.zone
        known = tuple(set(ids) for ids in self._known)
        first = min((line.line for line in self.chat), default=0)

        is_low = self.inbox.numbers.left <= rows.REPORT_NUMBERS // 2

        def look(connection: Connection) -> tuple[Sequence[set[int]], Block | None]:
            self._drop_lines(connection)
            numbers = rows.reserve_reports(connection, zone) if is_low else None
            return rows.ids(connection, zone, first), numbers

        there, numbers = await self._store.write(look)
        if numbers is not None:
            self.inbox.numbers.add(numbers)
        drops = (self.bans.drop, self.inbox.drop, self.chat.drop)
        for ids, now, all_known, drop in zip(known, there, self._known, drops, strict=True):
            for gone in ids - now:
                all_known.discard(gone)
                drop(gone)

    def _drop_lines(self, connection: Connection) -> None:
        before_us = self.now_us() - self._days * DAY_US
        rows.drop_lines(connection, self._store.zone, before_us)


def _rule_of(subject: str, field: str) -> str | None:
    """The name of the rule of chat that a fact is about, if it is about one."""
    if subject.startswith(ZONE):
        return subject
    return _RULES.get(field) if subject == PEOPLE else None

"""Rows that are kept of schedules and guards, and news of those that came to nothing."""

from collections.abc import Callable, Sequence
from typing import Any, Final

import structlog
from sqlalchemy import Connection

from esplanade.protocol.commands import CommandFault, GuardCondition
from esplanade.server.audit.entries import Entry
from esplanade.server.audit.log import AuditLog
from esplanade.server.console.guards import Guard
from esplanade.server.console.operated_rows import GUARDS, SCHEDULES, OperatedRow, write_rows
from esplanade.server.console.schedules import Schedule
from esplanade.server.store.store import Store

_WORDS: Final = {
    "missed": "was missed",
    "refused": "could not be carried out",
}

log = structlog.get_logger(__name__)


class ScheduleRecords:
    """Writes schedules and guards into the store. `tell` tells the listeners of the console."""

    def __init__(
        self, store: Store, audit: AuditLog, tell: Callable[[str, dict[str, Any]], None]
    ) -> None:
        self._store = store
        self._audit = audit
        self._tell = tell

    async def keep(self, item: Schedule | Guard) -> None:
        """Keep a schedule or guard as it is now, and tell that it is another.

        Raises
        ------
        StoreError
            It cannot be written.
        """
        row = row_of(item)
        await self._store.write(lambda connection: write_rows(connection, self._store.zone, [row]))
        self._tell("about", {"about": "schedules"})

    async def failed(self, item: Schedule | Guard) -> None:
        """Keep one that was missed or refused, with a row of the audit, and make an event of it.

        Raises
        ------
        StoreError
            It cannot be written; the event is told all the same.
        """
        kind = "guard" if isinstance(item, Guard) else "schedule"
        why = "; ".join(str(fault["text"]) for fault in item.faults)
        text = f"{kind} {item.id} {_WORDS[item.state]}: {why}"
        log.warning("a schedule came to nothing", kind=kind, id=item.id, state=item.state, why=why)
        told = {"account": item.by, "outcome": item.state, "faults": list(item.faults)}
        self._tell("schedule", {"text": text, kind: item.id, **told})
        commands = item.commands if isinstance(item, Schedule) else []
        entry = Entry(
            command=f"{kind}_{item.state}",
            account=item.by,
            target=f"{kind}:{item.id}",
            outcome=item.state,
            body={"why": why, "faults": item.faults, "commands": commands},
        )
        row = row_of(item)

        def change(connection: Connection) -> None:
            self._audit.add(connection, entry)
            write_rows(connection, self._store.zone, [row])

        await self._store.write(change)
        self._tell("about", {"about": "schedules"})


def row_of(item: Schedule | Guard) -> OperatedRow:
    """The row that is kept of a schedule or guard."""
    part = GUARDS if isinstance(item, Guard) else SCHEDULES
    return OperatedRow(part, item.id, item.plain())


def guard_of(
    given: GuardCondition, changes: Sequence[int], by: str | None, rights: str, now_us: int
) -> Guard:
    """A guard over changes that were made now."""
    return Guard(
        id=f"g{changes[0]}",
        changes=list(changes),
        condition=given.condition.model_dump(mode="json"),
        until_us=now_us + round(1e6 * given.within_s),
        by=by,
        rights=rights,
    )


def why_missed(schedule: Schedule, now_us: int, tick: int) -> CommandFault | None:
    """Why a schedule that was kept was missed while the server did not run; None if it was not."""
    match schedule.state:
        case "firing":
            text = "the server ended while it was carried out; the audit says how far it came"
            return CommandFault(code="interrupted", text=text)
        case "fired" if schedule.back_us is None or now_us >= schedule.back_us:
            text = "its changes were to be taken back while the server did not run; they stay"
            arguments = {"back_us": schedule.back_us, "now_us": now_us}
            return CommandFault(code="not_taken_back", text=text, arguments=arguments)
        case "waiting" if schedule.due_us is not None and now_us >= schedule.due_us:
            return missed(schedule, now_us, "it was due while the server did not run")
        case "waiting" if schedule.due_tick is not None and tick >= schedule.due_tick:
            text = "its tick was over when the server came back"
            arguments = {"due_tick": schedule.due_tick, "tick": tick}
            return CommandFault(code="missed", text=text, arguments=arguments)
    return None


def missed(schedule: Schedule, now_us: int, text: str) -> CommandFault:
    """Say that a moment has passed."""
    arguments = {"due_us": schedule.due_us, "now_us": now_us}
    return CommandFault(code="missed", text=text, arguments=arguments)

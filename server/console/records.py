"""Rows of the audit for commands: what is wanted before a tick, and what came of it after."""

from collections.abc import Collection, Mapping, Sequence
from typing import Any

import structlog
from sqlalchemy import Connection

from esplanade.protocol.commands import CommandFault, Facts
from esplanade.server.accounts.identity import Identity
from esplanade.server.audit.entries import Entry
from esplanade.server.audit.log import AuditLog
from esplanade.server.console.audit_tail import BEGUN
from esplanade.server.console.operated_rows import OperatedRow, write_rows
from esplanade.server.console.planned import Planned
from esplanade.server.store.store import Store, StoreError

log = structlog.get_logger(__name__)


class Records:
    """Writes rows about commands; those of one list are committed together."""

    def __init__(self, store: Store, audit: AuditLog) -> None:
        self._store = store
        self._audit = audit

    async def intents(self, by: Identity, planned: list[Planned], tick: int) -> list[int]:
        """Write down what is wanted, at that tick; the numbers of the rows, once committed.

        Raises
        ------
        StoreError
            It could not be written: nothing may be carried out.
        """
        entries = [
            Entry(
                command=one.command.op,
                account=by.account,
                role=by.role,
                address=by.address,
                target=_target(one.after),
                tick=tick,
                body={
                    "via": by.via,
                    "command": one.command.model_dump(
                        mode="json",
                        exclude={"dry_run", "note", *_said_to_person(one)},
                        exclude_none=True,
                    ),
                    "before": one.before,
                    "after": one.after,
                    **({} if one.reverts is None else {"reverts": one.reverts}),
                },
                person=one.person,
                detail=_detail(one),
                note=one.command.note,
            )
            for one in planned
        ]
        return await self._store.write(
            lambda connection: [self._audit.add(connection, entry) for entry in entries]
        )

    async def outcomes(
        self,
        by: Identity,
        planned: list[Planned],
        numbers: list[int],
        tick: int | None,
        faults: list[CommandFault],
        *,
        rows: Sequence[OperatedRow] = (),
        begun: Collection[int] = (),
        more: Mapping[str, Any] | None = None,
    ) -> None:
        """Write down what came of commands in that tick, and the rows that are others by them.

        Those of the numbers `begun` go on, and will have another row once they have ended. If
        that fails it is logged only, unless there are such rows. `more` is said of each outcome.

        Raises
        ------
        StoreError
            The rows cannot be written.
        """
        entries = [
            Entry(
                command=one.command.op,
                account=by.account,
                role=by.role,
                target=_target(one.after),
                tick=tick,
                outcome="refused" if faults else BEGUN if number in begun else "done",
                refers_to=number,
                body={
                    "faults": [fault.model_dump(mode="json") for fault in faults],
                    **(more or {}),
                },
            )
            for number, one in zip(numbers, planned, strict=True)
        ]

        def change(connection: Connection) -> None:
            for entry in entries:
                self._audit.add(connection, entry)
            write_rows(connection, self._store.zone, list(rows))

        try:
            await self._store.write(change)
        except StoreError:
            if rows:
                raise
            # It is done, and its row stands: only what came of it is missing there.
            log.exception("the outcome of a command is not in the audit", commands=numbers)


def _said_to_person(one: Planned) -> set[str]:
    """Fields that may speak of a person, and so must be kept where they can be forgotten."""
    return set(one.command.private)


def _detail(one: Planned) -> dict[str, object] | None:
    said = one.command.model_dump(include=_said_to_person(one), exclude_none=True)
    return said or None


def _target(facts: Facts) -> str:
    """Return the subject of a row of the audit: the one, or the first of several."""
    subjects = list(facts)
    first = subjects[0].removeprefix("actor:").removeprefix("door:") if subjects else ""
    return first[:200]

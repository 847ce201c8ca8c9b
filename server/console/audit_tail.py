"""The end of the audit, read at a start: what can be taken back, what has to be done again."""

import copy
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Final

from pydantic import ValidationError

from esplanade.protocol.commands import COMMAND, Command, Facts, Mark, Revert, SetParameters
from esplanade.server.accounts.rights import COMMANDS
from esplanade.server.audit.entries import Entry, Row
from esplanade.server.console.changes import REMEMBERED, Change
from esplanade.server.console.facts import together
from esplanade.server.console.moderation_intents import MODERATING, REVERTIBLE

MOST_ROWS: Final = 2 * REMEMBERED + 5_000
"""No more rows are read: one for each change that is remembered, and one for its outcome."""
NOT_DONE: Final = "not_done"
"""The outcome of a command that nobody was told of, and that was rolled back at a start."""
BEGUN: Final = "begun"
"""The outcome of a change that goes on, such as a ramp, until it has ended."""


@dataclass(frozen=True)
class GoingOn:
    """A change that went on when the server ended: it was acknowledged, and has not ended."""

    change: Change
    command: Command
    account: str | None
    role: str
    wanted: Facts
    """The values that it goes to, or that were dragged first."""


@dataclass(frozen=True)
class Tail:
    """The commands on a world that goes on, as the audit has them."""

    changes: list[Change] = field(default_factory=list)
    """Those that were made, the oldest first."""
    facts: Facts = field(default_factory=dict)
    """What has to be true, of all that changed after the checkpoint or while it was taken."""
    muted_s: dict[int, float] = field(default_factory=dict)
    """People who were muted after the checkpoint, and for how many seconds."""
    kicked: set[int] = field(default_factory=set)
    """People who were sent out after the checkpoint."""
    lost: list[Row] = field(default_factory=list)
    """Commands that nobody was told of: they are rolled back."""
    going_on: list[GoingOn] = field(default_factory=list)
    """Changes that went on, the oldest first; they are among `changes` too."""
    settled: int = 0
    """The number of the last command."""
    tick: int = 0
    """The last tick that a row names."""


def read_tail(rows: Sequence[Row], settled: int) -> Tail:
    """The commands in rows of the server's own chain, in their order.

    Of commands up to `settled` the checkpoint has what they did. Of later ones, those are redone of
    which the audit knows that they were done; all others never happened.
    """
    outcomes = {row.refers_to: row.outcome for row in rows if row.refers_to is not None}
    last = {row.refers_to: row.body for row in rows if "after" in row.body}
    tail = Tail(
        settled=max([settled, *(row.seq for row in rows if _is_command(row))]),
        tick=max((row.tick or 0 for row in rows), default=0),
    )
    ended_at = {row.refers_to: row.seq for row in rows if "after" in row.body}
    facts: list[Facts] = []
    late: Facts = {}
    """Facts of what has begun before the checkpoint and ended after it."""
    for row in rows:
        if not _is_command(row):
            continue
        outcome = outcomes.get(row.seq)
        if outcome is None and row.seq > settled:
            tail.lost.append(row)
        is_done = outcome in {"done", BEGUN} or (outcome is None and row.seq <= settled)
        ended = last.get(row.seq, row.body)  # of what went on, such as a ramp
        before, after = ended.get("before", {}), ended.get("after", {})
        if outcome == BEGUN:
            after = _begun(tail, row, before, after)
        elif is_done:
            _remember(tail, row, before, after)
        if is_done:
            _leave_out(late, after)
        if row.seq > settled:
            facts.append(after if is_done else before)
        elif ended_at.get(row.seq, 0) > settled:
            late = together([late, after])
    for subject, fields in together([late, *facts]).items():
        kind, _, name = subject.partition(":")
        if kind == "person":
            _about_person(tail, int(name), fields)
        elif kind != "people":
            tail.facts[subject] = fields
    return tail


def _leave_out(facts: Facts, others: Facts) -> None:
    """Leave out of facts what others are about."""
    for subject, fields in others.items():
        for field_ in fields:
            facts.get(subject, {}).pop(field_, None)


def not_done(row: Row) -> Entry:
    """The row that says that a command never happened."""
    return Entry(
        command=row.command,
        account=row.account,
        role=row.role,
        target=row.target,
        outcome=NOT_DONE,
        refers_to=row.seq,
        body={"faults": [{"code": NOT_DONE, "text": "the server ended before it was answered"}]},
    )


def _is_command(row: Row) -> bool:
    """Whether a row says what somebody wants of the world."""
    is_command = isinstance(row.body.get("command"), dict) and row.refers_to is None
    return is_command and not row.outcome and row.command in COMMANDS


def _begun(tail: Tail, row: Row, before: Facts, wanted: Facts) -> Facts:
    """Take in a change that went on; the facts that are true of it at least."""
    try:
        command = SetParameters.model_validate(row.body["command"])
    except ValidationError:
        return wanted  # of a program that knew other commands
    after = copy.deepcopy(before if command.over_s is not None else wanted)
    _remember(tail, row, before, after)
    tail.going_on.append(GoingOn(tail.changes[-1], command, row.account, row.role, wanted))
    return {} if command.over_s is not None else wanted


def _remember(tail: Tail, row: Row, before: Facts, after: Facts) -> None:
    try:
        command = COMMAND.validate_python(row.body["command"])
    except (ValidationError, KeyError):
        return  # of a program that knew other commands, or one about people
    if isinstance(command, MODERATING) and not isinstance(command, REVERTIBLE):
        return
    reverts = row.body.get("reverts") if isinstance(command, Revert) else None
    note = command.text if isinstance(command, Mark) else row.note
    change = Change(row.seq, row.account, command.op, before, after, reverts)
    change.at_us, change.tick, change.note = row.at_us, row.tick, note
    tail.changes.append(change)


def _about_person(tail: Tail, person: int, fields: dict[str, object]) -> None:
    if fields.get("kicked"):
        tail.kicked.add(person)
    muted_s = fields.get("muted_s")
    if isinstance(muted_s, int | float):
        tail.muted_s[person] = float(muted_s)

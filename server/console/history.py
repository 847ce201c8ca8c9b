"""The history of changes, and values side by side: usual ones, presets, scopes, moments."""

from __future__ import annotations

import copy
import itertools
import re
from typing import TYPE_CHECKING, Any, Final

from esplanade.actors import Overrides
from esplanade.actors.overrides import DEFAULTS, WORLD, Scope
from esplanade.protocol.commands import Facts, full_id
from esplanade.server.console.changes import Change
from esplanade.server.console.groups import Groups
from esplanade.server.console.refusals import RefusedError
from esplanade.server.console.state import parameters_of, scope_of, with_facts

if TYPE_CHECKING:
    from esplanade.server.console.console import Console

MOST_COLUMNS: Final = 8
MOST_CHANGES: Final = 200
"""A page has no more changes."""
_MOMENT: Final = re.compile(r"(.+)@([0-9]{1,18})")


def plain_change(change: Change, console: Console) -> dict[str, Any]:
    """A change as plain data."""
    return {
        "number": change.number,
        "at_us": change.at_us,
        "tick": change.tick,
        "account": change.account,
        "op": change.op,
        "subjects": list(change.after),
        "before": copy.deepcopy(change.before),
        "after": copy.deepcopy(change.after),
        "note": change.note,
        "reverts": change.reverts,
        "reverted_by": change.reverted_by,
        "can_revert": console.changes.can_revert(change, console.state),
    }


def changes(console: Console, before: int | None, limit: int) -> dict[str, Any]:
    """The latest changes, the newest first, or those that are older than one."""
    older = (
        change
        for change in console.changes.newest_first()
        if before is None or change.number < before
    )
    found = [plain_change(change, console) for change in itertools.islice(older, limit + 1)]
    more = found[limit - 1]["number"] if len(found) > limit else None
    return {"revision": console.changes.revision, "changes": found[:limit], "next": more}


def diff(console: Console, columns: list[str]) -> dict[str, Any]:
    """The parameters in columns: a row for each, its values in the order of the columns.

    Raises
    ------
    RefusedError
        A column cannot be had.
    """
    if not 1 <= len(columns) <= MOST_COLUMNS:
        raise RefusedError.of("values", f"give 1 to {MOST_COLUMNS} columns", "columns")
    values = []
    for index, column in enumerate(columns):
        try:
            values.append(_column(console, column))
        except RefusedError as error:
            raise error.within("columns", index) from None
    rows: list[dict[str, Any]] = []
    for name in DEFAULTS:
        found = [column.get(name) for column in values]
        told = [value for value in found if value is not None]
        rows.append({"name": name, "values": found, "differs": any(v != told[0] for v in told)})
    return {"revision": console.changes.revision, "columns": columns, "rows": rows}


def _column(console: Console, column: str) -> dict[str, Any]:
    kind, _, rest = column.partition(":")
    if column == "default":
        return dict(DEFAULTS)
    if kind == "preset":
        name, _, version = rest.partition("@")
        if version and not version.isdecimal():
            raise RefusedError.of("values", f"{version!r} is no version of a preset")
        return console.state.presets.values(name, int(version) if version else None)
    if kind == "change":
        return _of_change(console, rest)
    moment = _MOMENT.fullmatch(column)
    if moment is None:
        return _effective(console, column, console.state.overrides, console.state.groups)
    overrides, groups = _after(console, int(moment[2]))
    return _effective(console, moment[1], overrides, groups)


def _of_change(console: Console, text: str) -> dict[str, Any]:
    change = console.changes.get(int(text)) if text.isdecimal() else None
    scopes = {} if change is None else parameters_of(change.after)
    if change is None or not scopes:
        what = f"change {text} is about no parameters" if change else f"there is no change {text}"
        raise RefusedError.of("unknown_change", what, change=text)
    scope = next(subject for subject in change.after if scope_of(subject) in scopes)
    return _effective(console, scope, *_after(console, change.number))


def _after(console: Console, number: int) -> tuple[Overrides, Groups]:
    """The overrides and groups right after a change: what came later is taken back."""
    if console.changes.get(number) is None:
        text = f"there is no change {number}, or it is too long ago"
        raise RefusedError.of("unknown_change", text, change=number)
    earlier: Facts = {}
    for change in console.changes.newest_first():
        if change.number <= number:
            break
        for subject, fields in change.before.items():
            earlier[subject] = {**earlier.get(subject, {}), **fields}
    return with_facts(console.state.overrides, earlier), console.state.groups.taking(earlier)


def _effective(
    console: Console, scope_text: str, overrides: Overrides, groups: Groups
) -> dict[str, Any]:
    """The values that hold in a scope, those of wider scopes among them."""
    kind, _, name = scope_text.partition(":")
    if scope_text == "world":
        return {**DEFAULTS, **overrides.of(WORLD)}
    if kind == "group" and name:
        return {**DEFAULTS, **overrides.of(WORLD), **overrides.of(Scope("group", name))}
    if kind == "actor" and name:
        actor = str(full_id(name))
        spec = console.zone.actors.get(actor)
        if spec is None:
            raise RefusedError.of("unknown_actor", f"there is no actor {actor}", actor=actor)
        found = overrides.effective(actor, groups.names(spec))
        return {name: source.value for name, source in found.items()}
    text = f"{scope_text!r} is none of default, preset:NAME, world, group:NAME, actor:ID, change:N"
    raise RefusedError.of("values", text)

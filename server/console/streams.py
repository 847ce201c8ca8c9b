"""Streams: the values of a slider that is dragged, which are one change together."""

import asyncio
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from esplanade.protocol.commands import Command, Facts, SetParameters
from esplanade.server.accounts.identity import Identity
from esplanade.server.console.changes import Change
from esplanade.server.console.going_on import Ongoing
from esplanade.server.console.intents import checked_values
from esplanade.server.console.planned import Planned
from esplanade.server.console.records import Records
from esplanade.server.console.refusals import RefusedError

if TYPE_CHECKING:
    from esplanade.server.console.console import Console

GAP_S: Final = 2.0
"""Values of a slider that come within this time of each other are one change."""
MOST: Final = 256
"""No more streams may be under way."""

Key = tuple[str | None, str]
"""The account that drags, and the scope."""


class Dragged(NamedTuple):
    """A further value of a slider: what it changed, and what the world said of it."""

    planned: Planned
    found: dict[str, Any]


class Streams:
    """The values that are dragged, by account and scope."""

    def __init__(self, console: "Console", records: Records) -> None:
        self._console = console
        self._records = records
        self._streams: dict[Key, Ongoing] = {}
        self._endings: dict[Key, asyncio.TimerHandle] = {}
        self._rows: set[asyncio.Task[None]] = set()

    def __len__(self) -> int:
        return len(self._streams)

    async def dragged(self, by: Identity, commands: Sequence[Command]) -> Dragged | None:
        """Go on with what is dragged; None if this is no further value of it.

        Raises
        ------
        RefusedError
            The value cannot be had; the one before stays.
        """
        command, console = commands[0], self._console
        if len(commands) > 1 or not isinstance(command, SetParameters):
            return None
        ongoing = self._found(by, command) if command.stream and not command.dry_run else None
        if ongoing is None:
            return None
        key = by.account, command.scope
        self._cancel(key)  # while the world prepares the value, the stream has not ended
        try:
            facts: Facts = {command.scope: checked_values(command.values, "values")}
            console.changes.check_revision(command.if_revision, facts, console.state)
            before = console.state.now(facts)
            ongoing.tick, price = await console.go_on(ongoing.change, facts)
        except RefusedError as error:
            raise error.within(0) from None
        finally:
            if self._streams.get(key) is ongoing:
                self._await_end(key)
        ongoing.steps += 1
        found = {"price": price, "number": ongoing.change.number, "tick": ongoing.tick}
        return Dragged(Planned(command, before, facts), found)

    def begin(self, by: Identity, planned: Planned, change: Change, tick: int) -> None:
        """Let a change go on with what is dragged."""
        assert isinstance(planned.command, SetParameters)  # noqa: S101
        key = by.account, planned.command.scope
        self._end(key)
        self._streams[key] = Ongoing(by, planned, change, tick)
        self._await_end(key)

    async def close(self) -> None:
        """End all of them; the rows in the audit are written."""
        for key in list(self._streams):
            self._end(key)
        await asyncio.gather(*self._rows, return_exceptions=True)

    def _found(self, by: Identity, command: SetParameters) -> Ongoing | None:
        """The stream that a dragged value goes on with; None if it begins one."""
        found = self._streams.get((by.account, command.scope))
        if found is None:
            return None
        goes_on = command.values.keys() <= found.change.after.get(
            command.scope, {}
        ).keys() and self._console.changes.can_revert(found.change, self._console.state)
        if not goes_on:
            self._end((by.account, command.scope))
            return None
        return found

    def _await_end(self, key: Key) -> None:
        self._cancel(key)
        loop = asyncio.get_running_loop()
        self._endings[key] = loop.call_later(GAP_S, self._end, key)

    def _end(self, key: Key) -> None:
        self._cancel(key)
        ongoing = self._streams.pop(key, None)
        if ongoing is None:
            return
        row = asyncio.get_running_loop().create_task(ongoing.end(self._console, self._records))
        self._rows.add(row)
        row.add_done_callback(self._rows.discard)

    def _cancel(self, key: Key) -> None:
        ending = self._endings.pop(key, None)
        if ending is not None:
            ending.cancel()

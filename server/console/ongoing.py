"""Changes that go on for a time: values that are dragged, and ramps."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import structlog

from esplanade.actors.parameter_records import MEASURES
from esplanade.protocol.commands import Command, SetParameters
from esplanade.server.accounts.identity import Identity
from esplanade.server.console import ramps, streams
from esplanade.server.console.audit_tail import GoingOn
from esplanade.server.console.changes import Change
from esplanade.server.console.going_on import Ongoing, is_ramp
from esplanade.server.console.planned import Planned
from esplanade.server.console.ramps import Ramps
from esplanade.server.console.records import Records
from esplanade.server.console.refusals import RefusedError
from esplanade.server.console.state import each
from esplanade.server.console.streams import Dragged, Streams

if TYPE_CHECKING:
    from esplanade.server.console.console import Console

log = structlog.get_logger(__name__)


class OngoingChanges:
    """The changes that go on. Each has three rows in the audit: that it is wanted, that it has
    begun, and how it ended."""

    def __init__(self, console: "Console", records: Records) -> None:
        self._console = console
        self._records = records
        self._streams = Streams(console, records)
        self._ramps = Ramps(console, records)

    @property
    def under_way(self) -> int:
        """Number of changes that go on."""
        return len(self._streams) + len(self._ramps)

    def check_room(self, command: SetParameters) -> None:
        """See that one more change may go on.

        Raises
        ------
        RefusedError
            Too many do, or it is a parameter that cannot go there evenly.
        """
        if command.stream and len(self._streams) >= streams.MOST:
            raise RefusedError.of("busy", f"{streams.MOST} values are dragged already", "stream")
        if command.over_s is not None and len(self._ramps) >= ramps.MOST:
            raise RefusedError.of("busy", f"{ramps.MOST} ramps are under way already", "over_s")
        for name in command.values if command.over_s is not None else ():
            if name in MEASURES:
                text = f"{name} needs preparation for each value, and cannot go there evenly"
                raise RefusedError.of("not_ramped", text, "values", name)

    async def dragged(self, by: Identity, commands: Sequence[Command]) -> Dragged | None:
        """Go on with what is dragged; None if this is no further value of it.

        Raises
        ------
        RefusedError
            The value cannot be had; the one before stays.
        """
        return await self._streams.dragged(by, commands)

    def begin(self, by: Identity, planned: Planned, change: Change, tick: int) -> None:
        """Let a change go on from here."""
        kind: Ramps | Streams = self._ramps if is_ramp(planned.command) else self._streams
        kind.begin(by, planned, change, tick)

    # --- restarts ---------------------------------------------------------------------------------

    def save(self) -> list[dict[str, Any]]:
        """How far ramps have come; call it between two ticks."""
        return self._ramps.save()

    def load(self, saved: Sequence[Mapping[str, Any]]) -> None:
        """Know how far ramps had come; they go on once they are resumed."""
        self._ramps.load(saved)

    async def resume(self, found: Sequence[GoingOn]) -> None:
        """Go on with the ramps that were under way when the server ended, and end the rest.

        What somebody has changed or taken back since ends as well, where it is.
        """
        console = self._console
        for one in found:
            change = console.changes.get(one.change.number)
            if change is None:
                continue
            by = Identity(account=one.account, role=one.role, rights=frozenset(), via="restart")
            planned = Planned(one.command, change.before, one.wanted)
            later = any(
                other.number > change.number and _touches(other, one)
                for other in console.changes.newest_first()
            )
            if is_ramp(one.command) and change.reverted_by is None and not later:
                log.info("a ramp goes on", change=change.number)
                self._ramps.resume(by, planned, change)
                continue
            if not later:
                change.after = console.state.now(one.wanted)
            await Ongoing(by, planned, change, console.zone.tick).end(console, self._records)

    async def close(self) -> None:
        """End what is dragged, with its rows in the audit, and stop ramps where they are."""
        await self._streams.close()
        await self._ramps.close()


def _touches(change: Change, one: GoingOn) -> bool:
    """Whether a change is about one of the values that another goes on with."""
    return any(field in change.after.get(subject, {}) for subject, field, _ in each(one.wanted))

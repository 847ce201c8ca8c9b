"""The traces of commands that the world has carried out: facts, rows, changes, guards."""

import copy
from collections.abc import Callable, Collection
from typing import TYPE_CHECKING

from esplanade.protocol.commands import ApplyPreset, CommandFault, Facts, Mark, SetParameters
from esplanade.server.accounts.identity import Identity
from esplanade.server.accounts.rights import as_text
from esplanade.server.console.changes import Change
from esplanade.server.console.facts import together
from esplanade.server.console.going_on import goes_on, is_ramp
from esplanade.server.console.guards import Guard
from esplanade.server.console.moderation_intents import MODERATING, REVERTIBLE
from esplanade.server.console.operated_rows import rows_of
from esplanade.server.console.planned import Planned
from esplanade.server.console.records import Records
from esplanade.server.console.refusals import unwritable
from esplanade.server.console.schedule_records import guard_of, row_of
from esplanade.server.console.state import PACE, STEPPED
from esplanade.server.store.store import StoreError

if TYPE_CHECKING:
    from esplanade.server.console.console import Console


class UnkeptError(StoreError):
    """The world has carried out commands, but what they keep in the store is not written."""


class Settling:
    """Remembers what the world has carried out, and writes down that it has."""

    def __init__(self, console: "Console", records: Records, clock_us: Callable[[], int]) -> None:
        self._console = console
        self._records = records
        self._clock_us = clock_us

    async def settle(
        self,
        by: Identity,
        planned: list[Planned],
        numbers: list[int],
        tick: int | None,
        facts: Facts,
    ) -> None:
        """Let facts that the world has made true be so in the state, in the audit and for undo.

        Raises
        ------
        UnkeptError
            Presets, schedules or guards cannot be written. Presets and schedules are as they were;
            all else is done, and guards watch until the server ends.
        """
        state, numbered = self._console.state, list(zip(planned, numbers, strict=True))
        stored = {s: f for s, f in facts.items() if s.startswith(("preset:", "schedule:"))}
        state.take(stored)
        guards = self._guards(by, numbered)
        rows = [*rows_of(stored, state), *map(row_of, guards)]
        begun = {number for one, number in numbered if goes_on(one.command)}
        unkept: StoreError | None = None
        try:
            await self._records.outcomes(by, planned, numbers, tick, [], rows=rows, begun=begun)
        except StoreError as error:
            unkept = error
            before = together([one.before for one in reversed(planned)])
            state.take({subject: before[subject] for subject in stored})
            undone = [pair for pair in numbered if stored.keys() & pair[0].after.keys()]
            numbered = [pair for pair in numbered if pair not in undone]
            await self._outcomes(by, undone, tick, [unwritable(error)])
            await self._outcomes(by, numbered, tick, [], begun)
        state.take({s: f for s, f in facts.items() if s not in stored})
        self._console.settled = numbers[-1]
        for one, number in numbered:
            if _is_change(one):
                self._remember(by, one, number, tick)
        for guard in guards:
            self._console.scheduler.guards.add(guard)
        if unkept is not None:
            raise UnkeptError(str(unkept)) from unkept

    async def _outcomes(
        self,
        by: Identity,
        numbered: list[tuple[Planned, int]],
        tick: int | None,
        faults: list[CommandFault],
        begun: Collection[int] = (),
    ) -> None:
        """Write down what came of some commands of a list, without what is kept of them."""
        planned, numbers = [one for one, _ in numbered], [number for _, number in numbered]
        if planned:
            await self._records.outcomes(by, planned, numbers, tick, faults, begun=begun)

    def _remember(self, by: Identity, one: Planned, number: int, tick: int | None) -> None:
        """Remember a change, so that it can be taken back, and let it go on if it does."""
        console, ramps = self._console, is_ramp(one.command)
        change = Change(
            number,
            by.account,
            one.command.op,
            copy.deepcopy(one.before),
            copy.deepcopy(one.before if ramps else one.after),
            one.reverts,
            at_us=self._clock_us(),
            tick=tick,
            note=one.command.text if isinstance(one.command, Mark) else one.command.note,
        )
        console.changes.add(change)
        if goes_on(one.command):
            console.ongoing.begin(by, one, change, tick or console.zone.tick)
        console.tell_change(change)

    def _guards(self, by: Identity, numbered: list[tuple[Planned, int]]) -> list[Guard]:
        """The guards of commands; they watch once their changes are remembered."""
        rights, now = as_text(by.rights), self._clock_us()
        return [
            guard_of(command.guard, [number], by.account, rights, now)
            for command, number in ((one.command, number) for one, number in numbered)
            if isinstance(command, SetParameters | ApplyPreset) and command.guard is not None
        ]


def _is_change(one: Planned) -> bool:
    """Whether a command is a change: not one that has passed once it is carried out."""
    if isinstance(one.command, MODERATING) and not isinstance(one.command, REVERTIBLE):
        return False
    return STEPPED not in one.after.get(PACE, {})

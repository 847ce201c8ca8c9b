"""Changes that go on for a time: values that are dragged, and ramps."""

import asyncio
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import structlog

from esplanade.actors.overrides import DEFAULTS, WORLD
from esplanade.actors.parameter_records import MEASURES
from esplanade.protocol.commands import Command, CommandFault, Facts, SetParameters
from esplanade.server.accounts.identity import Identity
from esplanade.server.console.changes import Change
from esplanade.server.console.intents import checked_values
from esplanade.server.console.planned import Planned
from esplanade.server.console.records import Records
from esplanade.server.console.refusals import RefusedError
from esplanade.server.console.state import OperatedState, each, scope_of

if TYPE_CHECKING:
    from esplanade.server.console.console import Console

STREAM_GAP_S: Final = 2.0
"""Values of a slider that come within this time of each other are one change."""
RAMP_STEP_S: Final = 0.25
"""A ramp goes on so often, in time of the world."""
MOST_RAMPS: Final = 64
"""No more ramps may be under way."""
MOST_STREAMS: Final = 256
"""No more streams may be under way."""

log = structlog.get_logger(__name__)


@dataclass
class Ongoing:
    """A change that goes on."""

    by: Identity
    planned: Planned
    change: Change
    tick: int
    """The tick in which it went on last."""
    steps: int = 1
    faults: list[CommandFault] = field(default_factory=list)
    ending: asyncio.TimerHandle | None = None


class Dragged(NamedTuple):
    """A further value of a slider: what it changed, and what the world said of it."""

    planned: Planned
    found: dict[str, Any]


class OngoingChanges:
    """The changes that go on. Each has two rows in the audit: when it begins, and when it ends."""

    def __init__(self, console: "Console", records: Records) -> None:
        self._console = console
        self._records = records
        self._streams: dict[tuple[str | None, str], Ongoing] = {}
        self._ramps: dict[int, asyncio.Task[None]] = {}
        self._rows: set[asyncio.Task[None]] = set()

    @property
    def under_way(self) -> int:
        """Number of changes that go on."""
        return len(self._streams) + len(self._ramps)

    # --- streams ----------------------------------------------------------------------------------

    def stream(self, by: Identity, command: SetParameters) -> Ongoing | None:
        """The stream that a dragged value goes on with; None if it begins one."""
        found = self._streams.get((by.account, command.scope))
        if found is None:
            return None
        goes_on = command.values.keys() <= found.change.after.get(
            command.scope, {}
        ).keys() and self._console.changes.can_revert(found.change, self._console.state)
        if not goes_on:
            self._end_stream((by.account, command.scope))
            return None
        return found

    def check_room(self, command: SetParameters) -> None:
        """See that one more change may go on.

        Raises
        ------
        RefusedError
            Too many do, or it is a parameter that cannot go there evenly.
        """
        if command.stream and len(self._streams) >= MOST_STREAMS:
            raise RefusedError.of("busy", f"{MOST_STREAMS} values are dragged already", "stream")
        if command.over_s is not None and len(self._ramps) >= MOST_RAMPS:
            raise RefusedError.of("busy", f"{MOST_RAMPS} ramps are under way already", "over_s")
        for name in command.values if command.over_s is not None else ():
            if name in MEASURES:
                text = f"{name} needs preparation for each value, and cannot go there evenly"
                raise RefusedError.of("not_ramped", text, "values", name)

    async def dragged(self, by: Identity, commands: Sequence[Command]) -> "Dragged | None":
        """Go on with what is dragged; None if this is no further value of it.

        Raises
        ------
        RefusedError
            The value cannot be had; the one before stays.
        """
        command, console = commands[0], self._console
        if len(commands) > 1 or not isinstance(command, SetParameters):
            return None
        ongoing = self.stream(by, command) if command.stream and not command.dry_run else None
        if ongoing is None:
            return None
        try:
            facts: Facts = {command.scope: checked_values(command.values, "values")}
            console.changes.check_revision(command.if_revision, facts, console.state)
            before = console.state.now(facts)
            ongoing.tick, price = await console.go_on(ongoing.change, facts)
        except RefusedError as error:
            raise error.within(0) from None
        ongoing.steps += 1
        self._await_end((by.account, command.scope))
        found = {"price": price, "number": ongoing.change.number, "tick": ongoing.tick}
        return Dragged(Planned(command, before, facts), found)

    def begin_stream(self, by: Identity, planned: Planned, change: Change, tick: int) -> None:
        """Let a change go on with what is dragged."""
        assert isinstance(planned.command, SetParameters)  # noqa: S101
        key = by.account, planned.command.scope
        self._end_stream(key)
        self._streams[key] = Ongoing(by, planned, change, tick)
        self._await_end(key)

    def _await_end(self, key: tuple[str | None, str]) -> None:
        ongoing = self._streams[key]
        if ongoing.ending is not None:
            ongoing.ending.cancel()
        loop = asyncio.get_running_loop()
        ongoing.ending = loop.call_later(STREAM_GAP_S, self._end_stream, key)

    def _end_stream(self, key: tuple[str | None, str]) -> None:
        ongoing = self._streams.pop(key, None)
        if ongoing is None:
            return
        if ongoing.ending is not None:
            ongoing.ending.cancel()
        row = asyncio.get_running_loop().create_task(self._ended(ongoing))
        self._rows.add(row)
        row.add_done_callback(self._rows.discard)

    # --- ramps ------------------------------------------------------------------------------------

    def begin_ramp(self, by: Identity, planned: Planned, change: Change, tick: int) -> None:
        """Let values go to those that are planned, from those that hold now."""
        ongoing = Ongoing(by, planned, change, tick)
        task = asyncio.get_running_loop().create_task(self._ramp(ongoing, tick))
        self._ramps[change.number] = task
        task.add_done_callback(lambda _: self._ramps.pop(change.number, None))

    async def _ramp(self, ongoing: Ongoing, begun: int) -> None:
        console, command = self._console, ongoing.planned.command
        assert isinstance(command, SetParameters)  # noqa: S101
        assert command.over_s is not None  # noqa: S101
        tick_s = console.zone.tick_s
        ticks = max(1, round(command.over_s / tick_s))
        period = max(1, round(RAMP_STEP_S / tick_s))
        first = start_of(ongoing.planned.after, console.state)
        due = begun
        part = 0.0
        try:
            while part < 1.0 and not ongoing.faults:
                due = min(due + period, begun + ticks)
                part = min(1.0, (await console.after_tick(due) - begun) / ticks)
                values = _between(first, ongoing.planned.after, part)
                if not await self._further(ongoing, values):
                    break
        except RefusedError as error:
            ongoing.faults = error.faults
        finally:
            await self._ended(ongoing)

    async def _further(self, ongoing: Ongoing, facts: Facts) -> bool:
        """Let a ramp go further; False if somebody has changed or taken back what it does."""
        console = self._console
        async with console.turn:
            if not console.changes.can_revert(ongoing.change, console.state):
                return False
            ongoing.tick, _ = await console.go_on(ongoing.change, facts)
            ongoing.steps += 1
            return True

    async def _ended(self, ongoing: Ongoing) -> None:
        """A change goes on no more: write down what became of it."""
        change = ongoing.change
        more = {"before": change.before, "after": change.after, "steps": ongoing.steps}
        await self._records.outcomes(
            ongoing.by,
            [ongoing.planned],
            [change.number],
            ongoing.tick,
            ongoing.faults,
            more=more,
        )
        self._console.tell_change(change)

    async def close(self) -> None:
        """End all of it; the rows in the audit are written."""
        for key in list(self._streams):
            self._end_stream(key)
        ramps = list(self._ramps.values())
        for ramp in ramps:
            ramp.cancel()
        await asyncio.gather(*ramps, *self._rows, return_exceptions=True)


def is_ramp(command: Command) -> bool:
    """Whether the values of a command come later, a bit in each tick."""
    return isinstance(command, SetParameters) and command.over_s is not None


def goes_on(command: Command) -> bool:
    """Whether a change goes on after its first tick."""
    return isinstance(command, SetParameters) and (command.stream or command.over_s is not None)


def start_of(facts: Facts, state: OperatedState) -> dict[str, dict[str, float]]:
    """The values that hold in the scopes of facts now, from wider scopes where they have none."""
    found: dict[str, dict[str, float]] = {}
    for subject, field_, _ in each(facts):
        scope = scope_of(subject)
        if scope.level == "own" and scope.name in state.zone.actors:
            groups = state.groups.names(state.zone.actors[scope.name])
            value = state.overrides.effective(scope.name, groups)[field_].value
        else:
            world = {**DEFAULTS, **state.overrides.of(WORLD)}
            value = {**world, **state.overrides.of(scope)}[field_]
        found.setdefault(subject, {})[field_] = value
    return found


def _between(first: dict[str, dict[str, float]], last: Facts, part: float) -> Facts:
    """Values that far on the way from the first to the last; whole ones stay whole."""
    found: Facts = {}
    for subject, name, value in each(last):
        start = first[subject][name]
        now: Any = value if part >= 1.0 else start + part * (value - start)
        if isinstance(value, int):
            now = round(now)
        found.setdefault(subject, {})[name] = now
    return found

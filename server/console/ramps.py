"""Ramps: values that go evenly to others, over some time of the world, and over restarts."""

import asyncio
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import structlog

from esplanade.actors.overrides import DEFAULTS, WORLD
from esplanade.protocol.commands import Facts, SetParameters
from esplanade.server.accounts.identity import Identity
from esplanade.server.console.changes import Change
from esplanade.server.console.going_on import Ongoing
from esplanade.server.console.planned import Planned
from esplanade.server.console.records import Records
from esplanade.server.console.refusals import RefusedError, failed
from esplanade.server.console.state import OperatedState, each, scope_of

if TYPE_CHECKING:
    from esplanade.server.console.console import Console

STEP_S: Final = 0.25
"""A ramp goes on so often, in time of the world."""
MOST: Final = 64
"""No more ramps may be under way."""

log = structlog.get_logger(__name__)

First = dict[str, dict[str, float]]


@dataclass(kw_only=True)
class Ramp(Ongoing):
    """A change that goes on by itself."""

    first: First
    """The values from which it goes."""
    begun: int
    """The tick from which its time counts."""


class Ramps:
    """The ramps that are under way, by the numbers of their changes."""

    def __init__(self, console: "Console", records: Records) -> None:
        self._console = console
        self._records = records
        self._ramps: dict[int, Ramp] = {}
        self._tasks: dict[int, asyncio.Task[None]] = {}
        self._restored: dict[int, tuple[First, int]] = {}
        """Of ramps in the checkpoint: the values from which they go, and the ticks they went."""

    def __len__(self) -> int:
        return len(self._ramps)

    def begin(self, by: Identity, planned: Planned, change: Change, tick: int) -> None:
        """Let values go to those that are planned, from those that hold now."""
        first = start_of(planned.after, self._console.state)
        self._run(Ramp(by, planned, change, tick, first=first, begun=tick))

    def save(self) -> list[dict[str, Any]]:
        """How far each has come; call it between two ticks."""
        tick = self._console.zone.tick
        return [
            {"number": number, "first": ramp.first, "ticks": max(0, tick - ramp.begun)}
            for number, ramp in self._ramps.items()
        ]

    def load(self, saved: Sequence[Mapping[str, Any]]) -> None:
        """Know how far each had come, for when they are resumed."""
        self._restored = {
            int(each["number"]): (dict(each["first"]), int(each["ticks"])) for each in saved
        }

    def resume(self, by: Identity, planned: Planned, change: Change) -> None:
        """Go on with a ramp that was under way when the server ended."""
        console = self._console
        first, ticks = self._restored.pop(change.number, (None, 0))
        now = console.zone.tick
        if first is None:  # it began after the checkpoint was taken
            first = start_of(planned.after, console.state)
        change.after = console.state.now(planned.after)
        self._run(Ramp(by, planned, change, now, first=first, begun=now - ticks))

    async def close(self) -> None:
        """Stop all of them where they are. Without rows in the audit: the next start goes on."""
        tasks = list(self._tasks.values())
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    def _run(self, ramp: Ramp) -> None:
        number = ramp.change.number
        self._ramps[number] = ramp
        self._tasks[number] = asyncio.get_running_loop().create_task(self._go(ramp))
        self._tasks[number].add_done_callback(lambda _: self._forget(number))

    def _forget(self, number: int) -> None:
        del self._ramps[number], self._tasks[number]

    async def _go(self, ramp: Ramp) -> None:
        console, command = self._console, ramp.planned.command
        assert isinstance(command, SetParameters)  # noqa: S101
        assert command.over_s is not None  # noqa: S101
        tick_s = console.zone.tick_s
        ticks = max(1, round(command.over_s / tick_s))
        period = max(1, round(STEP_S / tick_s))
        due, last = ramp.tick, ramp.begun + ticks
        part = 0.0
        try:
            while part < 1.0:
                due = min(due + period, last)
                part = min(1.0, (await console.after_tick(due) - ramp.begun) / ticks)
                if not await self._further(ramp, between(ramp.first, ramp.planned.after, part)):
                    break
        except RefusedError as error:
            ramp.faults = error.faults
        except Exception as error:
            log.exception("a ramp has failed", change=ramp.change.number)
            ramp.faults = [failed(error)]
        await ramp.end(console, self._records)

    async def _further(self, ramp: Ramp, facts: Facts) -> bool:
        """Let a ramp go further; False if somebody has changed or taken back what it does."""
        console = self._console
        async with console.turn:
            if not console.changes.can_revert(ramp.change, console.state):
                return False
            ramp.tick, _ = await console.go_on(ramp.change, facts)
            ramp.steps += 1
            return True


def start_of(facts: Facts, state: OperatedState) -> First:
    """The values that hold in the scopes of facts now, from wider scopes where they have none."""
    found: First = {}
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


def between(first: First, last: Facts, part: float) -> Facts:
    """Values that far on the way from the first to the last; whole ones stay whole."""
    found: Facts = {}
    for subject, name, value in each(last):
        start = first[subject][name]
        now: Any = value if part >= 1.0 else start + part * (value - start)
        if isinstance(value, int):
            now = round(now)
        found.setdefault(subject, {})[name] = now
    return found

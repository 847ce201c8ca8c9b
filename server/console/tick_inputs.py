"""The way of commands into a tick: inputs that wait for it, and outcomes that come of it."""

import asyncio
import itertools
from collections.abc import Mapping
from typing import Any, Final

from esplanade.protocol.commands import CommandFault
from esplanade.server.console.pacing import change_pace
from esplanade.server.console.refusals import of_world
from esplanade.server.world.frame import Frame
from esplanade.server.world.inputs import ActorCommand, Input, MoveDoor
from esplanade.server.world.outcomes import Outcome
from esplanade.server.world.pace import Pace
from esplanade.server.world.zone import Zone

PATIENCE_S: Final = 30.0
"""A command that the world has not carried out after this time is answered as not known."""
_AS_IT_IS: Final[Mapping[str, Any]] = {}


class TickInputs:
    """Inputs of the next tick, for one list of commands after the other.

    A ticker calls `drain` between two ticks, and `take` with each frame.
    """

    def __init__(self, zone: Zone, pace: Pace) -> None:
        self._zone = zone
        self._pace = pace
        self._numbers = itertools.count(1)
        self._inputs: list[Input] = []
        self._outcomes: dict[int, asyncio.Future[Outcome]] = {}
        self._tick: asyncio.Future[int] | None = None
        """Is done when the tick that has the inputs is over."""

    def new_number(self) -> int:
        """A number for an input, by which its outcome is known."""
        return next(self._numbers)

    @property
    def waits_for_tick(self) -> bool:
        """Whether a list of commands needs a tick, though it may have no inputs for it."""
        return self._tick is not None and not self._tick.done()

    async def carry_out(
        self,
        inputs: list[ActorCommand],
        doors: list[MoveDoor],
        pace: Mapping[str, Any] = _AS_IT_IS,
    ) -> tuple[int | None, list[CommandFault]]:
        """Put inputs into the next tick; the last tick in which one took effect, and faults."""
        loop = asyncio.get_running_loop()
        if pace and not (inputs or doors):
            change_pace(self._pace, pace, loop.time())
            return self._zone.tick, []
        for one in inputs:
            self._outcomes[one.command] = loop.create_future()
        self._tick = begun = loop.create_future()
        self._inputs += [*inputs, *doors]
        # They enter the next tick, be it the last before a pause or the first that is stepped.
        change_pace(self._pace, pace, loop.time())
        try:
            async with asyncio.timeout(PATIENCE_S):
                tick = await begun
                outcomes = [await self._outcomes[one.command] for one in inputs]
        except TimeoutError:
            text = f"the world has not answered within {PATIENCE_S:g} s; it may still do it"
            return None, [CommandFault(code="not_known", text=text)]
        finally:
            for one in inputs:
                self._outcomes.pop(one.command, None)
        refused = [outcome.fault for outcome in outcomes if outcome.fault is not None]
        faults = [fault for one in refused for fault in of_world(one)]
        return max((outcome.tick for outcome in outcomes), default=tick), faults

    def drain(self) -> list[Input]:
        """Return the inputs for the tick that is about to begin."""
        inputs, self._inputs = self._inputs, []
        return inputs

    def take(self, frame: Frame) -> None:
        """Learn from a frame what became of commands."""
        if self._tick is not None and not self._tick.done() and not self._inputs:
            self._tick.set_result(frame.tick)
        for outcome in frame.outcomes:
            future = self._outcomes.get(outcome.command)
            if future is not None and not future.done():
                future.set_result(outcome)

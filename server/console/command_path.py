"""The way of a list of commands: its turn, checks, the audit, a tick, and the answers."""

import asyncio
from collections.abc import Sequence
from time import perf_counter
from typing import TYPE_CHECKING, Final

from esplanade.protocol.commands import Answer, Command, CommandFault, Facts, Price
from esplanade.server.accounts.identity import Identity
from esplanade.server.console.changes import Change
from esplanade.server.console.command_plans import CommandPlans, check_list
from esplanade.server.console.facts import together
from esplanade.server.console.going_on import is_ramp
from esplanade.server.console.inputs import inputs_for
from esplanade.server.console.moderating import Moderating
from esplanade.server.console.planned import Planned
from esplanade.server.console.preparation import Preparation
from esplanade.server.console.recording import RECORDED, RECORDING, switched
from esplanade.server.console.records import Records
from esplanade.server.console.refusals import RefusedError, of_world, unwritable
from esplanade.server.console.settling import Settling
from esplanade.server.console.state import PACE, parameters_of
from esplanade.server.console.tick_inputs import TickInputs
from esplanade.server.store.store import StoreError
from esplanade.server.world.inputs import ActorCommand

if TYPE_CHECKING:
    from esplanade.server.console.console import Console

MOST_WAITING: Final = 32
"""Commands, or lists of them, that may wait for their turn; more are refused."""


class CommandPath:
    """Carries out lists of commands, one after the other.

    Each is checked as a whole; then its rows in the audit are committed, and only after that it
    enters a tick.
    """

    def __init__(
        self,
        console: "Console",
        plans: CommandPlans,
        records: Records,
        moderating: Moderating,
        tick_inputs: TickInputs,
        settling: Settling,
    ) -> None:
        self.waiting = 0
        """Number of lists of commands that wait for their turn, or are being carried out."""
        self.turn = asyncio.Lock()
        """Held by whoever changes the world: one after the other."""
        self._console = console
        self._plans = plans
        self._records = records
        self._moderating = moderating
        self._tick_inputs = tick_inputs
        self._settling = settling
        self._preparation = Preparation(console.zone)

    async def carry_out(self, by: Identity, commands: Sequence[Command]) -> list[Answer]:
        """Carry out commands; see `Console.carry_out`."""
        check_list(by, commands)
        if self.waiting >= MOST_WAITING:
            raise RefusedError.of("busy", f"{MOST_WAITING} lists of commands wait already")
        self.waiting += 1
        try:
            async with self.turn:
                return await self._carry_out(by, commands)
        finally:
            self.waiting -= 1

    async def _carry_out(self, by: Identity, commands: Sequence[Command]) -> list[Answer]:
        console = self._console
        dragged = await console.ongoing.dragged(by, commands)
        if dragged is not None:
            return [self._answer(dragged.planned, **dragged.found)]
        planned = self._plans.plan(by, commands)
        facts = together([one.after for one in planned])
        if RECORDING in facts and len(commands) > 1:
            text = "a recording begins and ends by a command alone"
            raise RefusedError.of("not_alone", text)
        inputs, doors = inputs_for(facts, console.state, console.new_number)
        price, bodies = await console.ask(lambda: self._checked(inputs, len(commands)))
        prepare_s = self._preparation.seconds(bodies) if price == "prepared" else None
        if commands[0].dry_run:
            return [self._answer(one, price=price, prepare_s=prepare_s) for one in planned]
        if any(map(is_ramp, commands)):  # their values come later, a bit in each tick
            facts = together([one.after for one in planned if not is_ramp(one.command)])
            inputs, doors = inputs_for(facts, console.state, console.new_number)
        numbers = await self._records.intents(by, planned, console.zone.tick)
        await self._moderate(by, planned, numbers)
        began = perf_counter()
        if RECORDING in facts and console.state.recorder is not None:
            tick: int | None = console.zone.tick
            wanted = facts[RECORDING][RECORDED]
            faults = await switched(console.state.recorder, on=wanted)
        else:
            pace = facts.get(PACE, {})
            tick, faults = await self._tick_inputs.carry_out(inputs, doors, pace)
        if faults:
            await self._records.outcomes(by, planned, numbers, tick, faults)
            console.settled = numbers[-1]
            raise RefusedError(faults).within(0) if len(commands) == 1 else RefusedError(faults)
        self._preparation.took(bodies, perf_counter() - began)
        await self._settling.settle(by, planned, numbers, tick, facts)
        return [
            self._answer(one, number=number, tick=tick, price=price, prepare_s=prepare_s)
            for number, one in zip(numbers, planned, strict=True)
        ]

    async def _moderate(self, by: Identity, planned: list[Planned], numbers: list[int]) -> None:
        """Do for people what was planned; if that cannot be kept, nothing of the list is done."""
        try:
            await self._moderating.carry_out(planned, by.account)
        except StoreError as error:
            # Without an outcome the next start would take the list for done.
            fault = unwritable(error)
            await self._records.outcomes(by, planned, numbers, self._console.zone.tick, [fault])
            self._console.settled = numbers[-1]
            raise

    async def go_on(self, change: Change, facts: Facts) -> tuple[int, Price]:
        """Let a change that was made go further; see `Console.go_on`."""
        console = self._console
        inputs, doors = inputs_for(facts, console.state, console.new_number)
        price, _ = await console.ask(lambda: self._checked(inputs, 2))
        before = console.state.now(facts)
        tick, faults = await self._tick_inputs.carry_out(inputs, doors)
        if faults or tick is None:
            raise RefusedError(faults)
        console.state.take(facts)
        console.changes.moved(change, before, facts)
        console.tell_change(change)
        return tick, price

    def _checked(self, inputs: list[ActorCommand], count: int) -> tuple[Price, int]:
        """Return the price of inputs that the world would take, and the number of bodies that they
        need; call it between two ticks."""
        faults: list[CommandFault] = []
        for one in inputs:
            fault = self._console.zone.check(one)
            if fault is not None:
                faults += of_world(fault)
        if faults:
            refused = RefusedError(faults)
            raise refused.within(0) if count == 1 else refused
        return self._preparation.price(inputs), self._preparation.bodies(inputs)

    def _answer(
        self,
        planned: Planned,
        price: Price,
        number: int | None = None,
        tick: int | None = None,
        prepare_s: float | None = None,
    ) -> Answer:
        console = self._console
        shadowed: dict[str, int] = {}
        for scope, values in parameters_of(planned.after).items():
            for name in values:
                count = sum(1 for _ in console.state.overrides.shadowed(scope, name))
                if count:
                    shadowed[name] = count
        return Answer(
            op=planned.command.op,
            command=number,
            tick=tick,
            revision=console.changes.revision,
            before=planned.before,
            after=planned.after,
            price=price,
            prepare_s=prepare_s,
            shadowed=shadowed,
        )

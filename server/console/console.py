"""The one path of operators' commands: rights, checks, the audit, a tick, the answer."""

import asyncio
import itertools
from collections import deque
from collections.abc import Callable, Sequence
from typing import Any, Final, TypeVar

import structlog

from esplanade.actors import Overrides
from esplanade.actors.parameter_records import MEASURES
from esplanade.protocol.commands import (
    Answer,
    ClearParameters,
    Command,
    CommandFault,
    Facts,
    Kick,
    Mute,
    Price,
    Revert,
    SetParameters,
)
from esplanade.server.accounts.identity import Identity
from esplanade.server.accounts.rights import COMMANDS, may
from esplanade.server.audit.log import AuditLog
from esplanade.server.console.changes import Change, Changes
from esplanade.server.console.inputs import inputs_for
from esplanade.server.console.intents import intended
from esplanade.server.console.moderation import (
    MODERATING,
    Moderation,
    moderate,
    wanted_of_people,
)
from esplanade.server.console.records import Planned, Records
from esplanade.server.console.refusals import RefusedError, of_world
from esplanade.server.console.state import (
    BEHAVIOUR,
    HELD,
    OPEN,
    PRESENT,
    OperatedState,
    each,
    parameters_of,
)
from esplanade.server.live.bulletin import Bulletin
from esplanade.server.store.sql_store import SqlStore
from esplanade.server.world.frame import Frame
from esplanade.server.world.inputs import ActorCommand, AddActors, Input, MoveDoor
from esplanade.server.world.inputs import SetParameters as SetInWorld
from esplanade.server.world.outcomes import Outcome
from esplanade.server.world.zone import Zone

Result = TypeVar("Result")
MOST_WAITING: Final = 32
"""Commands, or lists of them, that may wait for their turn; more are refused."""
MOST_QUESTIONS: Final = 64
"""Questions that may wait for the end of a tick; more are refused."""
PATIENCE_S: Final = 30.0
"""A command that the world has not carried out after this time is answered as not known."""

log = structlog.get_logger(__name__)


class Console:
    """Carries out commands on a zone, one list after the other, on the zone's event loop.

    Each list is checked as a whole; then its rows in the audit are committed, and only after that
    it enters a tick. A ticker calls `drain` between two ticks, and `take` with each frame.
    """

    def __init__(
        self,
        zone: Zone,
        moderation: Moderation,
        store: SqlStore,
        audit: AuditLog,
        overrides: Overrides | None = None,
    ) -> None:
        self.zone = zone
        self.state = OperatedState(zone, overrides or Overrides())
        self.changes = Changes()
        self.moderation = moderation
        self.bulletin = Bulletin()
        self._records = Records(store, audit)
        self._turn = asyncio.Lock()
        self._waiting = 0
        self._numbers = itertools.count(1)
        self._inputs: list[Input] = []
        self._questions: deque[tuple[Callable[[], Any], asyncio.Future[Any]]] = deque()
        self._outcomes: dict[int, asyncio.Future[Outcome]] = {}
        self._tick: asyncio.Future[int] | None = None

    @property
    def waiting(self) -> int:
        """Number of lists of commands that wait for their turn, or are being carried out."""
        return self._waiting

    # --- the path -------------------------------------------------------------------------------

    async def carry_out(self, by: Identity, commands: Sequence[Command]) -> list[Answer]:
        """Carry out commands, all in one tick; with `dry_run` in all of them, only check them.

        Raises
        ------
        RefusedError
            Nothing was changed; a path begins with the command's place in the list.
        StoreError
            Nothing was changed, since the audit cannot be written.
        """
        for index, command in enumerate(commands):
            _check_right(by, command.op, index)
        if len({command.dry_run for command in commands}) > 1:
            text = "a list is carried out as a whole, or checked as a whole"
            raise RefusedError.of("mixed", text, 0, "dry_run")
        if self._waiting >= MOST_WAITING:
            raise RefusedError.of("busy", f"{MOST_WAITING} lists of commands wait already")
        self._waiting += 1
        try:
            async with self._turn:
                return await self._carry_out(by, commands)
        finally:
            self._waiting -= 1

    async def _carry_out(self, by: Identity, commands: Sequence[Command]) -> list[Answer]:
        planned = self._plan(by, commands)
        facts = _together([one.after for one in planned])
        inputs, doors = inputs_for(facts, self.state, lambda: next(self._numbers))
        price = await self.ask(lambda: self._checked(inputs, len(commands)))
        if commands[0].dry_run:
            return [self._answer(one, price=price) for one in planned]
        numbers = await self._records.intents(by, planned, self.zone.tick)
        for one in planned:
            moderate(one.command, self.moderation)
        tick, faults = await self._in_a_tick(inputs, doors)
        await self._records.outcomes(by, planned, numbers, tick, faults)
        if faults:
            raise RefusedError(faults).within(0) if len(commands) == 1 else RefusedError(faults)
        self.state.take(facts)
        for number, one in zip(numbers, planned, strict=True):
            if isinstance(one.command, MODERATING):
                continue
            self.changes.add(
                Change(number, by.account, one.command, one.before, one.after, one.reverts)
            )
        return [
            self._answer(one, number=number, tick=tick, price=price)
            for number, one in zip(numbers, planned, strict=True)
        ]

    def _plan(self, by: Identity, commands: Sequence[Command]) -> list[Planned]:
        planned: list[Planned] = []
        faults: list[CommandFault] = []
        for index, command in enumerate(commands):
            pending = _together([one.after for one in planned])
            try:
                planned.append(self._plan_one(by, command, pending))
            except RefusedError as error:
                faults += error.within(index).faults
        if faults:
            raise RefusedError(faults)
        return planned

    def _plan_one(self, by: Identity, command: Command, pending: Facts) -> Planned:
        if isinstance(command, Revert):
            change = self.changes.found(command.change, by.account)
            for op in _needed_for(change):
                _check_right(by, op)
            self.changes.check_untouched(change, self.state)
            return Planned(command, change.after, change.before, change.number)
        if isinstance(command, MODERATING):
            facts = wanted_of_people(command, self.moderation)
            name = None
            if isinstance(command, Kick | Mute):
                name = self.moderation.name_of(command.person)
            return Planned(command, {}, facts, person=name)
        facts = intended(command, self.state, pending)
        if isinstance(command, SetParameters | ClearParameters):
            self.changes.check_revision(command.if_revision, facts, self.state)
        before = self.state.now(facts)
        for subject, fields in pending.items():
            for field in fields.keys() & before.get(subject, {}).keys():
                before[subject][field] = fields[field]
        return Planned(command, before, facts)

    def _checked(self, inputs: list[ActorCommand], count: int) -> Price:
        """Return the price of inputs that the world would take; call it between two ticks."""
        faults: list[CommandFault] = []
        for one in inputs:
            fault = self.zone.check(one)
            if fault is not None:
                faults += of_world(fault)
        if faults:
            refused = RefusedError(faults)
            raise refused.within(0) if count == 1 else refused
        return "prepared" if any(map(_is_prepared, inputs)) else "tick"

    async def _in_a_tick(
        self, inputs: list[ActorCommand], doors: list[MoveDoor]
    ) -> tuple[int | None, list[CommandFault]]:
        """Put inputs into the next tick; the last tick in which one took effect, and faults."""
        loop = asyncio.get_running_loop()
        for one in inputs:
            self._outcomes[one.command] = loop.create_future()
        self._tick = begun = loop.create_future()
        self._inputs += [*inputs, *doors]
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

    def _answer(
        self, planned: Planned, price: Price, number: int | None = None, tick: int | None = None
    ) -> Answer:
        shadowed: dict[str, int] = {}
        for scope, values in parameters_of(planned.after).items():
            for name in values:
                count = sum(1 for _ in self.state.overrides.shadowed(scope, name))
                if count:
                    shadowed[name] = count
        return Answer(
            op=planned.command.op,
            command=number,
            tick=tick,
            revision=self.changes.revision,
            before=planned.before,
            after=planned.after,
            price=price,
            shadowed=shadowed,
        )

    # --- between ticks --------------------------------------------------------------------------

    async def ask(self, question: Callable[[], Result]) -> Result:
        """The answer to a question about the zone that can only be asked between two ticks.

        Raises
        ------
        RefusedError
            Too many questions wait, or the world does not tick.
        """
        if len(self._questions) >= MOST_QUESTIONS:
            raise RefusedError.of("busy", f"{MOST_QUESTIONS} questions wait already")
        future: asyncio.Future[Result] = asyncio.get_running_loop().create_future()
        self._questions.append((question, future))
        try:
            async with asyncio.timeout(PATIENCE_S):
                return await future
        except TimeoutError:
            raise RefusedError.of("busy", "the world does not answer") from None

    def drain(self) -> list[Input]:
        """Answer the questions, and return the inputs for the tick that is about to begin."""
        for _ in range(len(self._questions)):
            question, future = self._questions.popleft()
            if future.done():
                continue
            try:
                future.set_result(question())
            except Exception as error:  # noqa: BLE001 - it is raised where it was asked
                future.set_exception(error)
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


def _check_right(by: Identity, op: str, *path: int) -> None:
    if may(by.rights, op):
        return
    needed = COMMANDS[op].value
    raise RefusedError.of(
        "forbidden", f"{op} needs the right {needed}, which you do not have", *path, right=needed
    )


def _needed_for(change: Change) -> set[str]:
    """The commands whose rights are needed to take a change back."""
    ops = {BEHAVIOUR: "set_behaviour", HELD: "hold_actor", OPEN: "move_door", PRESENT: "add_actors"}
    return {ops.get(field, "set_parameters") for _, field, _ in each(change.after)}


def _is_prepared(command: ActorCommand) -> bool:
    if isinstance(command, SetInWorld):
        return not command.values.keys().isdisjoint(MEASURES)
    return isinstance(command, AddActors)


def _together(all_facts: Sequence[Facts]) -> Facts:
    """Facts one after the other: later ones prevail."""
    found: Facts = {}
    for facts in all_facts:
        for subject, fields in facts.items():
            found[subject] = {**found.get(subject, {}), **fields}
    return found

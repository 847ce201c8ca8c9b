"""The one path of operators' commands: rights, checks, the audit, a tick, the answer."""

import asyncio
import copy
import itertools
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from time import perf_counter
from typing import Any, Final, TypeVar

import structlog

from esplanade.actors import Overrides
from esplanade.protocol.commands import (
    Answer,
    ApplyPreset,
    ClearParameters,
    Command,
    CommandFault,
    Facts,
    Mark,
    Price,
    Revert,
    SetParameters,
)
from esplanade.server.accounts.identity import Identity
from esplanade.server.accounts.rights import COMMANDS, as_text, may
from esplanade.server.audit.log import AuditLog, now_us
from esplanade.server.console.changes import Change, Changes
from esplanade.server.console.facts import together
from esplanade.server.console.figures import ContactRate, zone_figures
from esplanade.server.console.groups import GROUP
from esplanade.server.console.guards import Guard
from esplanade.server.console.history import plain_change
from esplanade.server.console.inputs import inputs_for
from esplanade.server.console.intents import intended
from esplanade.server.console.kept_intents import KEPT, check_guard, kept_facts, ops_within
from esplanade.server.console.kept_rows import rows_of
from esplanade.server.console.lasting import LastingChanges, is_ramp, lasts
from esplanade.server.console.listeners import Listener, Listeners
from esplanade.server.console.moderating import KINDS, LASTING, MODERATING, Moderating
from esplanade.server.console.moderation import Moderation
from esplanade.server.console.pacing import change_pace
from esplanade.server.console.preparation import Preparation
from esplanade.server.console.presets import PRESET, Presets
from esplanade.server.console.records import Planned, Records
from esplanade.server.console.refusals import RefusedError, of_world
from esplanade.server.console.scheduler import Scheduler, guard_of, guard_row
from esplanade.server.console.schedules import SCHEDULE
from esplanade.server.console.state import (
    BEHAVIOUR,
    FACTOR,
    HELD,
    OPEN,
    PACE,
    PAUSED,
    PRESENT,
    STEPPED,
    OperatedState,
    each,
    parameters_of,
)
from esplanade.server.store.sql_store import SqlStore
from esplanade.server.store.store import StoreError
from esplanade.server.world.frame import Frame
from esplanade.server.world.inputs import ActorCommand, Input, MoveDoor
from esplanade.server.world.outcomes import Outcome
from esplanade.server.world.pace import Pace
from esplanade.server.world.zone import Zone

Result = TypeVar("Result")
_AS_IT_IS: Final[Mapping[str, Any]] = {}
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
        presets: Presets | None = None,
        pace: Pace | None = None,
        clock_us: Callable[[], int] = now_us,
    ) -> None:
        self.zone = zone
        self.pace = pace or Pace()
        self.state = OperatedState(zone, overrides or Overrides(), presets, self.pace)
        self.changes = Changes()
        self.moderation = moderation
        contacts = ContactRate(zone)
        self.figures = zone_figures(zone, contacts)
        self.scheduler = Scheduler(self, self.figures, contacts, store, audit, clock_us)
        self._clock_us = clock_us
        self._preparation = Preparation(zone)
        self._listeners = Listeners()
        self._ticks: list[tuple[int, asyncio.Future[int]]] = []
        self.begun = 0
        """The row of the audit, of the server's chain, with which the world of now began."""
        self.settled = 0
        """The last command whose outcome is in the audit; all before it is in the state too."""
        self._moderating = Moderating(moderation, zone)
        self.state.elsewhere.update(dict.fromkeys(KINDS, self._moderating.fact))
        self._records = Records(store, audit)
        self.lasting = LastingChanges(self, self._records)
        self.turn = asyncio.Lock()
        """Held by whoever changes the world: one after the other."""
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

    def new_number(self) -> int:
        """A number for an input, by which its outcome is known."""
        return next(self._numbers)

    def save(self) -> dict[str, Any]:
        """What is set, and which commands are in it; call it between two ticks."""
        return {"begun": self.begun, "settled": self.settled, "state": self.state.save()}

    def load(self, saved: Mapping[str, Any]) -> None:
        """Go on from what was saved.

        Raises
        ------
        ValueError, KeyError, TypeError
            Something is missing, or cannot be.
        """
        self.begun, self.settled = int(saved["begun"]), int(saved["settled"])
        self.state.load(saved["state"])

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
            async with self.turn:
                return await self._carry_out(by, commands)
        finally:
            self._waiting -= 1

    async def _carry_out(self, by: Identity, commands: Sequence[Command]) -> list[Answer]:
        dragged = await self.lasting.dragged(by, commands)
        if dragged is not None:
            return [self._answer(dragged.planned, **dragged.found)]
        planned = self._plan(by, commands)
        facts = together([one.after for one in planned])
        inputs, doors = inputs_for(facts, self.state, self.new_number)
        price, bodies = await self.ask(lambda: self._checked(inputs, len(commands)))
        prepare_s = self._preparation.seconds(bodies) if price == "prepared" else None
        if commands[0].dry_run:
            return [self._answer(one, price=price, prepare_s=prepare_s) for one in planned]
        if any(map(is_ramp, commands)):  # their values come later, a bit in each tick
            facts = together([one.after for one in planned if not is_ramp(one.command)])
            inputs, doors = inputs_for(facts, self.state, self.new_number)
        numbers = await self._records.intents(by, planned, self.zone.tick)
        await self._moderating.carry_out(planned, by.account)
        began = perf_counter()
        tick, faults = await self._in_a_tick(inputs, doors, facts.get(PACE, {}))
        if faults:
            await self._records.outcomes(by, planned, numbers, tick, faults)
            self.settled = numbers[-1]
            raise RefusedError(faults).within(0) if len(commands) == 1 else RefusedError(faults)
        self._preparation.took(bodies, perf_counter() - began)
        await self._settle(by, planned, numbers, tick, facts)
        return [
            self._answer(one, number=number, tick=tick, price=price, prepare_s=prepare_s)
            for number, one in zip(numbers, planned, strict=True)
        ]

    async def _settle(
        self,
        by: Identity,
        planned: list[Planned],
        numbers: list[int],
        tick: int | None,
        facts: Facts,
    ) -> None:
        """Remember what the world has carried out, and write down that it has."""
        both = list(zip(planned, numbers, strict=True))
        kept = {s: f for s, f in facts.items() if s.startswith(("preset:", "schedule:"))}
        self.state.take(kept)
        guards = self._guards(by, both)
        rows = [*rows_of(kept, self.state), *map(guard_row, guards)]
        done = [(one, number) for one, number in both if not lasts(one.command)]
        ended, of_ended = [one for one, _ in done], [number for _, number in done]
        try:
            await self._records.outcomes(by, ended, of_ended, tick, [], rows=rows)
        except StoreError:
            before = together([one.before for one in reversed(planned)])
            self.state.take({subject: before[subject] for subject in kept})
            raise
        self.state.take({s: f for s, f in facts.items() if s not in kept})
        self.settled = numbers[-1]
        for one, number in both:
            if _passes(one.command) or STEPPED in one.after.get(PACE, {}):
                continue
            ramps = is_ramp(one.command)
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
            self.changes.add(change)
            if ramps:
                self.lasting.begin_ramp(by, one, change, tick or self.zone.tick)
            elif lasts(one.command):
                self.lasting.begin_stream(by, one, change, tick or self.zone.tick)
            self.tell_change(change)
        for guard in guards:
            self.scheduler.guards.add(guard)

    def _guards(self, by: Identity, both: list[tuple[Planned, int]]) -> list[Guard]:
        """The guards of commands; they watch once their changes are remembered."""
        rights, now = as_text(by.rights), self._clock_us()
        return [
            guard_of(command.guard, [number], by.account, rights, now)
            for command, number in ((one.command, number) for one, number in both)
            if isinstance(command, SetParameters | ApplyPreset) and command.guard is not None
        ]

    async def go_on(self, change: Change, facts: Facts) -> tuple[int, Price]:
        """Let a change that was made go further; call it when it is your turn.

        Raises
        ------
        RefusedError
            The world does not take it.
        """
        inputs, doors = inputs_for(facts, self.state, self.new_number)
        price, _ = await self.ask(lambda: self._checked(inputs, 2))
        before = self.state.now(facts)
        tick, faults = await self._in_a_tick(inputs, doors)
        if faults or tick is None:
            raise RefusedError(faults)
        self.state.take(facts)
        self.changes.moved(change, before, facts)
        self.tell_change(change)
        return tick, price

    # --- what others are told -------------------------------------------------------------------

    def listen(self, listener: Listener) -> None:
        """Let somebody know of each change from now on, on the zone's loop; see `Listeners`."""
        self._listeners.add(listener)

    def tell(self, kind: str, what: dict[str, Any]) -> None:
        """Tell the listeners something."""
        self._listeners.tell(kind, what)

    def tell_change(self, change: Change) -> None:
        """Tell the listeners what a change is now."""
        self._listeners.tell_change(change, plain_change(change, self))

    # --- checks ---------------------------------------------------------------------------------

    def _plan(self, by: Identity, commands: Sequence[Command]) -> list[Planned]:
        planned: list[Planned] = []
        faults: list[CommandFault] = []
        for index, command in enumerate(commands):
            pending = together([one.after for one in planned])
            try:
                planned.append(self._plan_one(by, command, pending))
            except RefusedError as error:
                faults += error.within(index).faults
        if faults:
            raise RefusedError(faults)
        return planned

    def _plan_one(self, by: Identity, command: Command, pending: Facts) -> Planned:
        if isinstance(command, Revert):
            return self._plan_revert(by, command, pending)
        person = None
        if isinstance(command, MODERATING):
            wanted = self._moderating.wanted(command, pending)
            facts, person = wanted.facts, wanted.person
            if not isinstance(command, LASTING):
                return Planned(command, {}, facts, person=person)
        elif isinstance(command, Mark):
            return Planned(command, {}, {})
        elif isinstance(command, KEPT):
            self._check_conditions(command)
            facts = kept_facts(command, by, self.state, pending, self._clock_us())
        else:
            self._check_conditions(command)
            facts = intended(command, self.state, pending)
        if isinstance(command, SetParameters | ClearParameters):
            self.changes.check_revision(command.if_revision, facts, self.state)
        before = self.state.now(facts)
        for subject, fields in pending.items():
            for field in fields.keys() & before.get(subject, {}).keys():
                before[subject][field] = fields[field]
        return Planned(command, before, facts, person=person)

    def _plan_revert(self, by: Identity, command: Revert, pending: Facts) -> Planned:
        change = self.changes.found(command.change, by.account)
        for op in _needed_for(change):
            _check_right(by, op)
        if not change.after:
            text = f"change {change.number} has changed nothing that could be taken back"
            raise RefusedError.of("unknown_change", text, "change", change=change.number)
        self.changes.check_untouched(change, self.state, pending)
        return Planned(command, change.after, change.before, change.number)

    def _check_conditions(self, command: Command) -> None:
        """Check the guard of a command, and what goes on after its first tick."""
        check_guard(command, self.figures)
        if isinstance(command, SetParameters | ApplyPreset) and command.guard is not None:
            self.scheduler.guards.check_room()
        if isinstance(command, SetParameters):
            self.lasting.check_room(command)

    def _checked(self, inputs: list[ActorCommand], count: int) -> tuple[Price, int]:
        """Return the price of inputs that the world would take, and the number of bodies that they
        need; call it between two ticks."""
        faults: list[CommandFault] = []
        for one in inputs:
            fault = self.zone.check(one)
            if fault is not None:
                faults += of_world(fault)
        if faults:
            refused = RefusedError(faults)
            raise refused.within(0) if count == 1 else refused
        return self._preparation.price(inputs), self._preparation.bodies(inputs)

    async def _in_a_tick(
        self,
        inputs: list[ActorCommand],
        doors: list[MoveDoor],
        pace: Mapping[str, Any] = _AS_IT_IS,
    ) -> tuple[int | None, list[CommandFault]]:
        """Put inputs into the next tick; the last tick in which one took effect, and faults."""
        loop = asyncio.get_running_loop()
        if pace and not (inputs or doors):
            change_pace(self.pace, pace, loop.time())
            return self.zone.tick, []
        for one in inputs:
            self._outcomes[one.command] = loop.create_future()
        self._tick = begun = loop.create_future()
        self._inputs += [*inputs, *doors]
        # They enter the next tick, be it the last before a pause or the first that is stepped.
        change_pace(self.pace, pace, loop.time())
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
        self,
        planned: Planned,
        price: Price,
        number: int | None = None,
        tick: int | None = None,
        prepare_s: float | None = None,
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
            prepare_s=prepare_s,
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

    @property
    def waits_for_tick(self) -> bool:
        """Whether a list of commands needs a tick, though it may have no inputs for it."""
        return self._tick is not None and not self._tick.done()

    def drain(self) -> list[Input]:
        """Answer the questions, and return the inputs for the tick that is about to begin."""
        self.answer()
        inputs, self._inputs = self._inputs, []
        return inputs

    def answer(self) -> None:
        """Answer the questions that can be asked between two ticks only."""
        for _ in range(len(self._questions)):
            question, future = self._questions.popleft()
            if future.done():
                continue
            try:
                future.set_result(question())
            except Exception as error:  # noqa: BLE001 - it is raised where it was asked
                future.set_exception(error)

    def take(self, frame: Frame) -> None:
        """Learn from a frame what became of commands."""
        if self._tick is not None and not self._tick.done() and not self._inputs:
            self._tick.set_result(frame.tick)
        for outcome in frame.outcomes:
            future = self._outcomes.get(outcome.command)
            if future is not None and not future.done():
                future.set_result(outcome)
        if self._ticks:
            over = [future for due, future in self._ticks if due <= frame.tick]
            self._ticks = [one for one in self._ticks if one[0] > frame.tick]
            for ended in over:
                if not ended.done():
                    ended.set_result(frame.tick)
        self.scheduler.ticked(frame.tick)

    async def after_tick(self, due: int) -> int:
        """Wait until that tick is over; returns the one that is over then."""
        if self.zone.tick >= due:
            return self.zone.tick
        future: asyncio.Future[int] = asyncio.get_running_loop().create_future()
        self._ticks.append((due, future))
        return await future

    async def load_kept(self) -> None:
        """Take in the presets, schedules and guards that the store has kept.

        Raises
        ------
        StoreError
            They cannot be read.
        """
        await self.scheduler.load()

    async def close(self) -> None:
        """End all that the console does by itself."""
        await self.scheduler.close()
        await self.lasting.close()


def _passes(command: Command) -> bool:
    """Whether a command is about people and leaves nothing that could be taken back."""
    return isinstance(command, MODERATING) and not isinstance(command, LASTING)


def _check_right(by: Identity, op: str, *path: int) -> None:
    if may(by.rights, op):
        return
    needed = COMMANDS[op].value
    raise RefusedError.of(
        "forbidden", f"{op} needs the right {needed}, which you do not have", *path, right=needed
    )


def _needed_for(change: Change) -> set[str]:
    """The commands whose rights are needed to take a change back."""
    ops = {
        BEHAVIOUR: "set_behaviour",
        HELD: "hold_actor",
        OPEN: "move_door",
        PRESENT: "add_actors",
        FACTOR: "pace",
        PAUSED: "pace",
        PRESET: "save_preset",
        SCHEDULE: "schedule",
    }
    needed = set()
    for subject, field, value in each(change.before):
        if subject.partition(":")[0] in KINDS:
            needed.add("unban")
        elif field.startswith(GROUP):
            needed.add("set_group")
        else:
            needed.add(ops.get(field, "set_parameters"))
        if field == SCHEDULE and value is not None:
            needed |= ops_within(value["commands"])
    return needed

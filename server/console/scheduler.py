"""Carries out schedules when they are due, and takes changes back where guards say so."""

import asyncio
from collections import deque
from collections.abc import Callable, Coroutine, Sequence
from time import monotonic
from typing import TYPE_CHECKING, Any, Final

import structlog

from esplanade.protocol.commands import COMMAND, Command, CommandFault, GuardCondition, Revert
from esplanade.server.audit.log import AuditLog
from esplanade.server.console.authority import Authority
from esplanade.server.console.figures import ContactRate, Figures
from esplanade.server.console.guards import Guard, Guards
from esplanade.server.console.operated_rows import GUARDS, PRESETS, SCHEDULES, read_rows
from esplanade.server.console.refusals import RefusedError, failed, unwritable
from esplanade.server.console.schedule_records import (
    ScheduleRecords,
    guard_of,
    missed,
    why_missed,
)
from esplanade.server.console.schedules import LATE_S, Schedule
from esplanade.server.console.settling import UnkeptError
from esplanade.server.store.store import Store, StoreError

if TYPE_CHECKING:
    from esplanade.server.console.console import Console

LOOK_S: Final = 0.5
"""Figures are looked at so often."""
TRIES: Final = 5
"""Work that finds too much waiting, or a store that cannot be used, is tried so often."""
PAUSE_S: Final = 1.0
"""Time between two tries."""

log = structlog.get_logger(__name__)


class Scheduler:
    """Looks after each tick what is due, and does it in a task of its own, one after the other."""

    def __init__(
        self,
        console: "Console",
        figures: Figures,
        contacts: ContactRate,
        store: Store,
        audit: AuditLog,
        clock_us: Callable[[], int],
    ) -> None:
        self.guards = Guards()
        self._console = console
        self._figures = figures
        self._contacts = contacts
        self._store = store
        self._rows = ScheduleRecords(store, audit, console.tell)
        self._authority = Authority(store)
        self._clock_us = clock_us
        self._work: deque[Coroutine[Any, Any, None]] = deque()
        self._task: asyncio.Task[None] | None = None
        self._look_at_s = 0.0

    @property
    def waiting(self) -> int:
        """Number of schedules and guards that wait to be carried out."""
        return len(self._work)

    @property
    def busy(self) -> bool:
        """Whether something is being carried out, or waits for it."""
        return self._task is not None and not self._task.done()

    # --- after each tick --------------------------------------------------------------------------

    def ticked(self, tick: int) -> None:
        """A tick has ended: see what is due. Called on the zone's loop."""
        now_us = self._clock_us()
        due = self._console.state.schedules.due(now_us, tick)
        now_s = monotonic()
        if now_s >= self._look_at_s:
            self._look_at_s = now_s + LOOK_S
            self._contacts.sample()
            due += self._look(now_s, now_us)
        for schedule in due:
            if schedule.due_us is not None and now_us - schedule.due_us > 1e6 * LATE_S:
                text = "it was due while the world did not run"
                self._miss(schedule, missed(schedule, now_us, text))
                continue
            schedule.state = "firing"
            self._do(self._fire(schedule, tick))
        for schedule in self._console.state.schedules.back(now_us):
            schedule.back_us = None
            self._do(self._take_back(schedule))

    def _look(self, now_s: float, now_us: int) -> list[Schedule]:
        """The schedules whose figures are beyond their limits; guards are looked after at once."""
        schedules = self._console.state.schedules
        names = schedules.figures() | self.guards.figures()
        values = {name: self._figures.value(name) for name in names}
        for guard in self.guards.watching():
            changes = [self._console.changes.get(number) for number in guard.changes]
            stand = any(change is not None and change.reverted_by is None for change in changes)
            if now_us >= guard.until_us or not stand:
                self.guards.end(guard, "ended")
                self._do(self._rows.keep(guard))
        for guard in self.guards.held(values, now_s):
            self.guards.act(guard)
            self._do(self._guarded(guard, values[guard.condition["name"]]))
        return schedules.held(values, now_s)

    async def load(self) -> None:
        """Take in what was kept. What was missed meanwhile is told as missed.

        Raises
        ------
        StoreError
            It cannot be read.
        """
        now_us, state = self._clock_us(), self._console.state
        for part, name, body in await read_rows(self._store):
            assert body is not None  # noqa: S101
            if part == PRESETS:
                state.presets.load(name, body)
            elif part == SCHEDULES:
                schedule = state.schedules.load(body)
                why = why_missed(schedule, now_us, self._console.zone.tick)
                if why is not None:
                    self._miss(schedule, why)
            elif part == GUARDS:
                self.guards.add(Guard(**body))

    async def close(self) -> None:
        """End what is being done."""
        if self._task is not None:
            self._task.cancel()
            await asyncio.gather(self._task, return_exceptions=True)
        while self._work:
            self._work.popleft().close()

    # --- one after the other ----------------------------------------------------------------------

    def _do(self, work: Coroutine[Any, Any, None]) -> None:
        self._work.append(work)
        if self._task is None or self._task.done():
            self._task = asyncio.get_running_loop().create_task(self._work_off())

    async def _work_off(self) -> None:
        while self._work:
            try:
                await self._work.popleft()
            except StoreError:
                log.exception("what became of a schedule or guard is not kept")
            except Exception:
                log.exception("a schedule or guard has failed")

    async def _fire(self, schedule: Schedule, tick: int) -> None:
        await self._keep(schedule)
        changes, faults = await self._carried_out(schedule, lambda: self._due_commands(schedule))
        schedule.changes, schedule.faults = changes, faults
        now_us = self._clock_us()
        schedule.fired = {"at_us": now_us, "tick": tick}
        if faults:
            schedule.state = "refused"
        elif schedule.again_after_s is not None:
            schedule.state = "fired"
            schedule.back_us = now_us + round(1e6 * schedule.again_after_s)
        else:
            schedule.state = "done"
        await self._keep(schedule)
        if changes and schedule.guard is not None:
            given = GuardCondition.model_validate(schedule.guard)
            guard = guard_of(given, changes, schedule.by, schedule.rights, now_us)
            self.guards.add(guard)
            await self._keep(guard)

    def _due_commands(self, schedule: Schedule) -> list[Command]:
        """The commands of a schedule; refused if no guard could watch over what they change."""
        if schedule.guard is not None:
            self.guards.check_room()
        return [_with_note(each, schedule) for each in schedule.commands]

    async def _take_back(self, schedule: Schedule) -> None:
        faults = await self._reverted(
            schedule, schedule.changes, f"schedule {schedule.id}: its time is over"
        )
        schedule.state, schedule.faults = ("refused", faults) if faults else ("undone", [])
        await self._keep(schedule)

    async def _guarded(self, guard: Guard, value: float | None) -> None:
        condition = guard.condition
        side = "above" if condition.get("above") is not None else "below"
        why = f"guard {guard.id}: {condition['name']} is {value:g}, {side} {condition[side]:g}"
        guard.faults = await self._reverted(guard, guard.changes, why)
        self.guards.end(guard, "refused" if guard.faults else "taken_back")
        await self._keep(guard)

    async def _reverted(
        self, item: Schedule | Guard, changes: Sequence[int], why: str
    ) -> list[dict[str, Any]]:
        """Take back what still holds of some changes; the faults."""

        def reverts() -> list[Command]:
            return [
                Revert(op="revert", change=number, note=why)
                for number in reversed(changes)
                if self._is_a_change(number)
            ]

        _, faults = await self._carried_out(item, reverts)
        return faults

    async def _carried_out(
        self, item: Schedule | Guard, commands: Callable[[], list[Command]]
    ) -> tuple[list[int], list[dict[str, Any]]]:
        """Carry commands out with the rights of the account now; the changes, and faults."""
        faults: list[CommandFault] = []
        for number in range(TRIES):
            if number:
                await asyncio.sleep(PAUSE_S)
            try:
                return await self._tried(item, commands()), []
            except RefusedError as error:
                faults = error.faults
                if faults[0].code != "busy":
                    break
            except UnkeptError as error:  # what the world has carried out is not done twice
                faults = [unwritable(error)]
                break
            except StoreError as error:
                faults = [unwritable(error)]
            except Exception as error:
                log.exception("a schedule or guard has failed", id=item.id)
                faults = [failed(error)]
                break
        return [], [fault.model_dump(mode="json") for fault in faults]

    async def _tried(self, item: Schedule | Guard, commands: list[Command]) -> list[int]:
        """The changes that commands make; a refusal if the account is gone."""
        if not commands:
            return []
        kind = "guard" if isinstance(item, Guard) else "schedule"
        by = await self._authority.identity(item.by, item.rights, f"{kind} {item.id}")
        if by is None:
            raise RefusedError.of("forbidden", f"there is no account {item.by} any more")
        answers = await self._console.carry_out(by, commands)
        return [answer.command for answer in answers if answer.command is not None]

    def _is_a_change(self, number: int) -> bool:
        change = self._console.changes.get(number)
        return change is not None and bool(change.after) and change.reverted_by is None

    def _miss(self, schedule: Schedule, why: CommandFault) -> None:
        schedule.state, schedule.faults = "missed", [why.model_dump(mode="json")]
        self._do(self._rows.failed(schedule))

    async def _keep(self, item: Schedule | Guard) -> None:
        """Keep something as it is now; if that cannot be, it goes on all the same."""
        try:
            if item.state == "refused":
                await self._rows.failed(item)
            else:
                await self._rows.keep(item)
        except StoreError:
            log.exception("a schedule or guard is not kept", id=item.id, state=item.state)


def _with_note(given: dict[str, Any], schedule: Schedule) -> Command:
    note = f"schedule {schedule.id}" + (f": {schedule.note}" if schedule.note else "")
    return COMMAND.validate_python({**given, "note": given.get("note") or note[:500]})

"""The console of operators: all that they command goes through it, to the zone and back."""

import asyncio
from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeVar

from esplanade.actors import Overrides
from esplanade.protocol.commands import Answer, Command, Facts, Price
from esplanade.server.accounts.identity import Identity
from esplanade.server.audit.log import AuditLog, now_us
from esplanade.server.console.between_ticks import BetweenTicks
from esplanade.server.console.changes import Change, Changes
from esplanade.server.console.command_path import CommandPath
from esplanade.server.console.command_plans import CommandPlans
from esplanade.server.console.figures import ContactRate, zone_figures
from esplanade.server.console.history import plain_change
from esplanade.server.console.listeners import Listener, Listeners
from esplanade.server.console.moderating import Moderating
from esplanade.server.console.moderation import Moderation
from esplanade.server.console.moderation_intents import KINDS, ModerationIntents
from esplanade.server.console.ongoing import OngoingChanges
from esplanade.server.console.presets import Presets
from esplanade.server.console.records import Records
from esplanade.server.console.scheduler import Scheduler
from esplanade.server.console.settling import Settling
from esplanade.server.console.state import OperatedState
from esplanade.server.console.tick_inputs import TickInputs
from esplanade.server.store.store import Store
from esplanade.server.world.frame import Frame
from esplanade.server.world.inputs import Input
from esplanade.server.world.pace import Pace
from esplanade.server.world.zone import Zone

Result = TypeVar("Result")


class Console:
    """Carries out commands on a zone, one list after the other, on the zone's event loop.

    A ticker calls `drain` between two ticks, and `take` with each frame.
    """

    def __init__(
        self,
        zone: Zone,
        moderation: Moderation,
        store: Store,
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
        self.begun = 0
        """The row of the audit, of the server's chain, with which the world of now began."""
        self.settled = 0
        """The last command whose outcome is in the audit; all before it is in the state too."""
        intents = ModerationIntents(moderation, zone)
        self.state.elsewhere.update(dict.fromkeys(KINDS, intents.fact))
        self._records = Records(store, audit)
        self.ongoing = OngoingChanges(self, self._records)
        plans = CommandPlans(
            self.state,
            self.changes,
            intents,
            self.figures,
            self.scheduler.guards,
            self.ongoing.check_room,
            clock_us,
        )
        self._listeners = Listeners()
        self._tick_inputs = TickInputs(zone, self.pace)
        self._path = CommandPath(
            self,
            plans,
            self._records,
            Moderating(moderation, intents),
            self._tick_inputs,
            Settling(self, self._records, clock_us),
        )
        self._between_ticks = BetweenTicks(zone)

    @property
    def waiting(self) -> int:
        """Number of lists of commands that wait for their turn, or are being carried out."""
        return self._path.waiting

    @property
    def turn(self) -> asyncio.Lock:
        """Held by whoever changes the world: one after the other."""
        return self._path.turn

    def new_number(self) -> int:
        """A number for an input, by which its outcome is known."""
        return self._tick_inputs.new_number()

    # --- the path -------------------------------------------------------------------------------

    async def carry_out(self, by: Identity, commands: Sequence[Command]) -> list[Answer]:
        """Carry out commands, all in one tick; with `dry_run` in all of them, only check them.

        Raises
        ------
        RefusedError
            Nothing was changed; a path begins with the command's place in the list.
        UnkeptError
            The world has carried them out, but presets, schedules or guards cannot be written;
            presets and schedules are as they were.
        StoreError
            Nothing was changed, since the store cannot be written.
        """
        return await self._path.carry_out(by, commands)

    async def go_on(self, change: Change, facts: Facts) -> tuple[int, Price]:
        """Let a change that was made go further; call it when it is your turn.

        Raises
        ------
        RefusedError
            The world does not take it.
        """
        return await self._path.go_on(change, facts)

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

    # --- between ticks --------------------------------------------------------------------------

    async def ask(self, question: Callable[[], Result]) -> Result:
        """The answer to a question about the zone that can only be asked between two ticks.

        Raises
        ------
        RefusedError
            Too many questions wait, or the world does not tick.
        """
        return await self._between_ticks.ask(question)

    async def after_tick(self, due: int) -> int:
        """Wait until that tick is over; returns the one that is over then."""
        return await self._between_ticks.after_tick(due)

    @property
    def waits_for_tick(self) -> bool:
        """Whether a list of commands needs a tick, though it may have no inputs for it."""
        return self._tick_inputs.waits_for_tick

    def drain(self) -> list[Input]:
        """Answer the questions, and return the inputs for the tick that is about to begin."""
        self.answer()
        return self._tick_inputs.drain()

    def answer(self) -> None:
        """Answer the questions that can be asked between two ticks only."""
        self._between_ticks.answer()

    def take(self, frame: Frame) -> None:
        """Learn from a frame what became of commands."""
        self._tick_inputs.take(frame)
        self._between_ticks.ticked(frame.tick)
        self.scheduler.ticked(frame.tick)

    # --- restarts -------------------------------------------------------------------------------

    def save(self) -> dict[str, Any]:
        """All that is set, and which commands are in it; call it between two ticks."""
        return {
            "begun": self.begun,
            "settled": self.settled,
            "state": self.state.save(),
            "ramps": self.ongoing.save(),
        }

    def load(self, saved: Mapping[str, Any]) -> None:
        """Go on from what was saved.

        Raises
        ------
        ValueError, KeyError, TypeError
            Something is missing, or cannot be.
        """
        self.begun, self.settled = int(saved["begun"]), int(saved["settled"])
        self.state.load(saved["state"])
        self.ongoing.load(saved.get("ramps", ()))

    async def load_operated(self) -> None:
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
        await self.ongoing.close()

"""Carries out what operators want of actors while the world runs, as inputs of ticks."""

from collections.abc import Callable, Hashable, Iterable, Mapping
from typing import Final

import structlog

from esplanade.actors import ActorSpec, Population
from esplanade.actors.parameter_records import MEASURES
from esplanade.planning import Scene
from esplanade.server.world.actors import ActorAvatars
from esplanade.server.world.command_checks import check
from esplanade.server.world.command_effects import CommandEffects
from esplanade.server.world.derivation import Derivation
from esplanade.server.world.inputs import (
    ActorCommand,
    ActorsDerived,
    AddActors,
    OneActorCommand,
    SetParameters,
    parts_of,
)
from esplanade.server.world.outcomes import CommandError, Fault, FaultCode, Outcome, fault_of

MOST_WAITING: Final = 64
"""Commands that wait for what is derived for them; more are refused."""

log = structlog.get_logger(__name__)


class ActorCommands:
    """Commands are checked, then carried out as a whole; a refused one leaves no trace.

    One that needs something derived waits, and so do later ones for the same actors; the actors go
    on as they are until then.
    """

    def __init__(
        self,
        population: Population,
        avatars: ActorAvatars,
        scene: Scene,
        most_actors: int,
        roster: Iterable[ActorSpec],
        want_door: Callable[[str, bool], None],
    ) -> None:
        self._population = population
        self._scene = scene
        self._most_actors = most_actors
        self.derived_outside = False
        """Whether commands wait for `ActorsDerived`, where they have anything to wait for."""
        self._effects = CommandEffects(population, avatars, want_door, roster)
        self._waiting: dict[int, ActorCommand] = {}
        self._outcomes: list[Outcome] = []

    @property
    def specs(self) -> Mapping[Hashable, ActorSpec]:
        """The specification of each actor; its behaviour is the latest that it was given."""
        return self._effects.specs

    @property
    def waiting(self) -> int:
        """Number of commands that wait."""
        return len(self._waiting)

    @property
    def those_waiting(self) -> list[ActorCommand]:
        """The commands that wait, the longest first."""
        return list(self._waiting.values())

    def restore(self, specs: Iterable[ActorSpec]) -> None:
        """Know these actors, and no others: those of a zone that goes on after a restart."""
        self._effects.restore(specs)

    def wait(self, commands: Iterable[ActorCommand]) -> None:
        """Let these commands wait, the longest first, and no others."""
        self._waiting = {each.command: each for each in commands}

    def begin(self) -> None:
        """A new tick: nothing has come of it yet."""
        self._outcomes = []

    @property
    def outcomes(self) -> list[Outcome]:
        """The outcomes of commands in this tick."""
        return self._outcomes

    def take(self, command: ActorCommand, tick: int) -> list[int]:
        """Carry out a command, or let it wait; returns the avatars that have left the world."""
        try:
            check(command, self._population, self._most_actors, values=False)
            waits = self.derived_outside and (
                self._is_heavy(command) or self._stands_behind(command)
            )
            if waits:
                check(command, self._population, self._most_actors)
                self._supersede(command, tick)
                self._wait(command)
        except Exception as error:  # noqa: BLE001 - whatever it is, it is told
            self._tell(command.command, tick, error)
            return []
        return [] if waits else self._carry_out(command, None, tick)

    def take_derived(self, derived: ActorsDerived, tick: int) -> list[int]:
        """Carry out the command for which that was derived, if it still waits.

        Returns the avatars that have left the world.
        """
        command = self._waiting.pop(derived.command, None)
        if command is None:
            return []
        if derived.fault is not None:
            fault = Fault(FaultCode.REFUSED, derived.fault)
            self._outcomes.append(Outcome(derived.command, tick, fault))
            return []
        return self._carry_out(command, derived, tick)

    def work(self) -> Callable[[], ActorsDerived] | None:
        """Derives what the command needs that waits for longest; heavy, safe in any thread.

        Ask between two ticks; None if no command waits.
        """
        for command in self._waiting.values():
            return Derivation(self._population, self._scene, command).derive
        return None

    def _is_heavy(self, command: ActorCommand) -> bool:
        return any(self._derives(one) for one in parts_of(command))

    def _derives(self, command: OneActorCommand) -> bool:
        if isinstance(command, SetParameters):
            makes_bodies = not command.values.keys().isdisjoint(MEASURES)
            return makes_bodies and bool(
                self._population.new_bodies(command.actors, command.values)
            )
        return isinstance(command, AddActors)

    def _stands_behind(self, command: ActorCommand) -> bool:
        """Whether a command waits that is about one of the same actors."""
        actors = set(command.actors)
        return any(not actors.isdisjoint(other.actors) for other in self._waiting.values())

    def _wait(self, command: ActorCommand) -> None:
        if command.command in self._waiting:
            raise CommandError(FaultCode.BUSY, f"command {command.command} waits already")
        if len(self._waiting) >= MOST_WAITING:
            raise CommandError(FaultCode.BUSY, f"{MOST_WAITING} commands wait already")
        self._waiting[command.command] = command

    def _supersede(self, command: ActorCommand, tick: int) -> None:
        """Drop waiting commands all of whose values this one sets for the same actors."""
        if not isinstance(command, SetParameters):
            return
        for number, other in list(self._waiting.items()):
            if (
                isinstance(other, SetParameters)
                and other.actors == command.actors
                and other.values.keys() <= command.values.keys()
            ):
                del self._waiting[number]
                text = f"command {command.command} came before it was ready"
                fault = Fault(FaultCode.SUPERSEDED, text, {"by": command.command})
                self._outcomes.append(Outcome(number, tick, fault))

    # --- carrying out -------------------------------------------------------------------------

    def _carry_out(
        self, command: ActorCommand, derived: ActorsDerived | None, tick: int
    ) -> list[int]:
        """Carry a command out, or undo it and say why; returns the avatars that have left.

        One that has waited, for which something is `derived`, is checked again.
        """
        undo = None
        try:
            if derived is not None:
                check(command, self._population, self._most_actors)
            undo = self._effects.undo_point()
            if derived is not None and derived.bodies is not None:
                self._population.grid.apply_bodies(derived.bodies)
            left = self._effects.apply(command, derived or ActorsDerived(command.command))
        except Exception as error:  # noqa: BLE001 - whatever it is, the world goes on
            if undo is not None:
                undo()
            self._tell(command.command, tick, error)
            return []
        self._outcomes.append(Outcome(command.command, tick))
        return left

    def _tell(self, number: int, tick: int, error: Exception) -> None:
        fault = fault_of(error)
        if fault.code is FaultCode.FAILED:
            log.error("a command failed and was undone", command=number, exc_info=error)
        self._outcomes.append(Outcome(number, tick, fault))

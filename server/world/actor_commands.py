"""Carries out what operators want of actors while the world runs, as inputs of ticks."""

from collections.abc import Callable, Hashable, Iterable, Sequence
from typing import Final

import structlog

from esplanade.actors import ActorSpec, BehaviourSpec, Newcomer, Population
from esplanade.actors.behaviour_spec import GoToSpec
from esplanade.actors.parameter_records import MEASURES
from esplanade.planning import Scene
from esplanade.server.world.actors import ActorAvatars
from esplanade.server.world.command_checks import check
from esplanade.server.world.derivation import Derivation
from esplanade.server.world.inputs import (
    ActorCommand,
    ActorsDerived,
    AddActors,
    ChangeBehaviour,
    HoldActors,
    PlaceActor,
    RemoveActors,
    SendActors,
    SetParameters,
)
from esplanade.server.world.outcomes import CommandError, Fault, FaultCode, Outcome, fault_of
from esplanade.server.world.routes import Point

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
    ) -> None:
        self._population = population
        self._avatars = avatars
        self._scene = scene
        self._most_actors = most_actors
        self.derived_outside = False
        """Whether commands wait for `ActorsDerived`, where they have anything to wait for."""
        self.specs: dict[Hashable, ActorSpec] = {spec.id: spec for spec in roster}
        """The specification of each actor; its behaviour is the latest that it was given."""
        self._waiting: dict[int, ActorCommand] = {}
        self._outcomes: list[Outcome] = []

    @property
    def waiting(self) -> int:
        """Number of commands that wait."""
        return len(self._waiting)

    def restore(self, specs: Iterable[ActorSpec]) -> None:
        """Know these actors, and no others: those of a zone that goes on after a restart."""
        self.specs = {spec.id: spec for spec in specs}

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
            undo = self._population.undo_point()
            if derived is not None and derived.bodies is not None:
                self._population.grid.apply_bodies(derived.bodies)
            left = self._apply(command, derived or ActorsDerived(command.command))
        except Exception as error:  # noqa: BLE001 - whatever it is, the world goes on
            if undo is not None:
                undo()
            self._tell(command.command, tick, error)
            return []
        self._outcomes.append(Outcome(command.command, tick))
        return left

    def _apply(self, command: ActorCommand, derived: ActorsDerived) -> list[int]:
        population = self._population
        match command:
            case SetParameters():
                population.set_many(command.actors, command.values, derived.potentials)
            case AddActors():
                self._add(command, derived.places)
            case RemoveActors():
                population.remove_many(command.actors)
                for actor in command.actors:
                    self.specs.pop(actor, None)
                return self._avatars.remove(command.actors)
            case PlaceActor():
                population.place(command.actor, command.place)
                self._avatars.put(command.actor)
            case ChangeBehaviour() | SendActors() | HoldActors():
                for actor in command.actors:
                    self._lead(actor, command)
        return []

    def _add(self, command: AddActors, places: Sequence[Point]) -> None:
        found: Sequence[Point | None] = places or [spec.place for spec in command.specs]
        arrivals = zip(command.specs, command.parameters, found, strict=True)
        self._population.add_many(
            [Newcomer(spec.id, spec.behaviour.make(), own, place) for spec, own, place in arrivals]
        )
        for spec in command.specs:
            self._avatars.name(spec.id, spec.name)
            self.specs[spec.id] = spec

    def _lead(self, actor: str, command: ChangeBehaviour | SendActors | HoldActors) -> None:
        if isinstance(command, HoldActors):
            self._population.hold(actor, command.held)
            return
        behaviour: BehaviourSpec
        if isinstance(command, SendActors):
            behaviour = GoToSpec(target=command.target)
        else:
            behaviour = command.behaviour
        self._population.set_behaviour(actor, behaviour.make())
        if actor in self.specs:
            update = {"behaviour": behaviour}
            self.specs[actor] = self.specs[actor].model_copy(update=update)

    def _tell(self, number: int, tick: int, error: Exception) -> None:
        fault = fault_of(error)
        if fault.code is FaultCode.FAILED:
            log.error("a command failed and was undone", command=number, exc_info=error)
        self._outcomes.append(Outcome(number, tick, fault))

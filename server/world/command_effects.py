"""Effects of commands on actors: first on actors, which can fail, then on what is seen of them."""

from collections.abc import Callable, Hashable, Iterable, Sequence

from esplanade.actors import ActorSpec, BehaviourSpec, Newcomer, Population
from esplanade.actors.behaviour_spec import GoToSpec
from esplanade.server.world.actors import ActorAvatars
from esplanade.server.world.inputs import (
    ActorCommand,
    ActorsDerived,
    AddActors,
    Batch,
    ChangeBehaviour,
    HoldActors,
    OneActorCommand,
    PlaceActor,
    RemoveActors,
    SendActors,
    SetParameters,
    parts_of,
)
from esplanade.server.world.looks import look_of
from esplanade.server.world.routes import Point


class CommandEffects:
    """Applies commands. If one raises, `undo_point` puts all back that it may have changed."""

    def __init__(
        self,
        population: Population,
        avatars: ActorAvatars,
        want_door: Callable[[str, bool], None],
        roster: Iterable[ActorSpec],
    ) -> None:
        self._population = population
        self._avatars = avatars
        self._want_door = want_door
        self.specs: dict[Hashable, ActorSpec] = {}
        """The specification of each actor; its behaviour is the latest that it was given."""
        self.restore(roster)

    def restore(self, specs: Iterable[ActorSpec]) -> None:
        """Know these actors, and no others."""
        self.specs = {spec.id: spec for spec in specs}
        self._wear(self.specs)

    def undo_point(self) -> Callable[[], None]:
        """Return a call that puts actors and their specifications back."""
        restore, specs = self._population.undo_point(), dict(self.specs)

        def undo() -> None:
            restore()
            self.specs = specs

        return undo

    def apply(self, command: ActorCommand, derived: ActorsDerived) -> list[int]:
        """Carry out all parts of a command; returns the avatars that have left the world."""
        places = list(derived.places)
        parts = parts_of(command)
        for one in parts:
            self._change(one, derived, places)
        # From here on nothing can fail: what would is found by the checks before.
        left: list[int] = []
        for one in parts:
            left += self._show(one)
        if isinstance(command, Batch):
            for door in command.doors:
                self._want_door(door.name, door.is_open)
        return left

    def _change(
        self, command: OneActorCommand, derived: ActorsDerived, places: list[Point]
    ) -> None:
        population = self._population
        match command:
            case SetParameters():
                population.set_many(command.actors, command.values, derived.potentials)
            case AddActors():
                found = [places.pop(0) for _ in command.specs] if places else []
                self._add(command, found)
            case RemoveActors():
                population.remove_many(command.actors)
                for actor in command.actors:
                    self.specs.pop(actor, None)
            case PlaceActor():
                population.place(command.actor, command.place)
            case ChangeBehaviour() | SendActors() | HoldActors():
                for actor in command.actors:
                    self._lead(actor, command)

    def _show(self, command: OneActorCommand) -> list[int]:
        match command:
            case AddActors():
                for spec in command.specs:
                    self._avatars.name(spec.id, spec.name)
                self._wear(spec.id for spec in command.specs)
            case RemoveActors():
                return self._avatars.remove(command.actors)
            case PlaceActor():
                self._avatars.put(command.actor)
            case ChangeBehaviour() | SendActors():
                self._wear(command.actors)
        return []

    def _wear(self, actors: Iterable[Hashable]) -> None:
        """Show these actors as they are specified, which depends on what they do."""
        for actor in actors:
            if actor in self.specs:
                self._avatars.wear(actor, look_of(self.specs[actor]))

    def _add(self, command: AddActors, places: Sequence[Point]) -> None:
        found: Sequence[Point | None] = places or [spec.place for spec in command.specs]
        arrivals = zip(command.specs, command.parameters, found, strict=True)
        self._population.add_many(
            [
                # A place that was derived is that of one actor alone.
                Newcomer(spec.id, spec.behaviour.make(), own, at, near=spec.near and not places)
                for spec, own, at in arrivals
            ]
        )
        self.specs.update({spec.id: spec for spec in command.specs})

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

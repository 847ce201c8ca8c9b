"""Checks commands on actors before anything is changed by them."""

from collections.abc import Collection, Iterable

from esplanade.actors import Behaviour, GoTo, Population
from esplanade.server.world.inputs import (
    ActorCommand,
    AddActors,
    Batch,
    ChangeBehaviour,
    OneActorCommand,
    PlaceActor,
    RemoveActors,
    SendActors,
    SetParameters,
    parts_of,
)
from esplanade.server.world.outcomes import CommandError, Fault, FaultCode, fault_of


def check(
    command: ActorCommand, population: Population, most_actors: int, *, values: bool = True
) -> None:
    """Find what is wrong with a command, as far as that can be told before it is tried.

    It changes nothing, and may be asked between two ticks of whether a command would be taken.
    Without `values`, those of parameters are left to whoever sets them.

    Raises
    ------
    CommandError, ParameterError, ValueError
        The command cannot be carried out.
    """
    there = Present(population, most_actors)
    if isinstance(command, Batch):
        for door in command.doors:
            if door.name not in population.grid.doors:
                text = f"the scene has no door {door.name!r}"
                raise CommandError(FaultCode.UNKNOWN_DOOR, text, door=door.name)
    for one in parts_of(command):
        _check_one(one, population, there, values=values)


def fault_in(command: ActorCommand, population: Population, most_actors: int) -> Fault | None:
    """The fault of a command, as `check` finds it; None if there is none."""
    try:
        check(command, population, most_actors)
    except Exception as error:  # noqa: BLE001 - whatever it is, it is told
        return fault_of(error)
    return None


class Present:
    """The actors that will be there, as the commands of a batch come and go one after the other."""

    def __init__(self, population: Population, most_actors: int) -> None:
        self._table = population.table
        self._most = most_actors
        self._come: set[str] = set()
        self._gone: set[str] = set()

    def __contains__(self, actor: str) -> bool:
        return actor in self._come or (actor in self._table and actor not in self._gone)

    def are_old(self, actors: Iterable[str]) -> bool:
        """Whether all of them were there before."""
        return self._come.isdisjoint(actors)

    def add(self, actors: Collection[str]) -> None:
        """Let actors come in."""
        there = len(self._table) - len(self._gone) + len(self._come)
        if there + len(actors) > self._most:
            text = f"there is room for {self._most} actors, {there} are there"
            raise CommandError(FaultCode.FULL, text, most=self._most, there=there)
        for actor in actors:
            if actor in self:
                text = f"there already is an actor {actor}"
                raise CommandError(FaultCode.TAKEN, text, actor=actor)
        self._come.update(actors)

    def remove(self, actors: Iterable[str]) -> None:
        """Let actors go."""
        for actor in actors:
            if actor in self._come:
                self._come.discard(actor)
            else:
                self._gone.add(actor)


def _check_one(
    command: OneActorCommand, population: Population, there: Present, *, values: bool
) -> None:
    actors = command.actors
    if len(set(actors)) < len(actors):
        raise CommandError(FaultCode.REFUSED, "an actor is named twice")
    if isinstance(command, AddActors):
        _check_newcomers(command, population, there)
        return
    for actor in actors:
        if actor not in there:
            raise CommandError(FaultCode.UNKNOWN_ACTOR, f"there is no actor {actor}", actor=actor)
    if isinstance(command, SetParameters | PlaceActor) and not there.are_old(actors):
        text = "an actor that comes in has its parameters and its place already"
        raise CommandError(FaultCode.REFUSED, text)
    match command:
        case SetParameters() if values:
            population.navigator.check_values(actors, command.values)
        case RemoveActors():
            there.remove(actors)
        case ChangeBehaviour():
            _check_behaviour(population, command.behaviour.make())
        case SendActors():
            _check_behaviour(population, GoTo(command.target))
        case PlaceActor():
            population.navigator.check_place(command.place[:2], command.place[2])


def _check_newcomers(command: AddActors, population: Population, there: Present) -> None:
    if len(command.specs) != len(command.parameters):
        raise CommandError(FaultCode.REFUSED, "each new actor needs its parameters")
    there.add(command.actors)
    for spec in command.specs:
        _check_behaviour(population, spec.behaviour.make())
        if spec.place is not None:
            population.navigator.check_place(spec.place[:2], spec.place[2])


def _check_behaviour(population: Population, behaviour: Behaviour) -> None:
    try:
        population.check_targets(behaviour)
    except KeyError as error:
        raise CommandError(FaultCode.UNKNOWN_PLACE, str(error.args[0])) from None

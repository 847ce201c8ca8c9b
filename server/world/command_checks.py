"""Checks commands on actors before anything is changed by them."""

from esplanade.actors import Behaviour, GoTo, Population
from esplanade.server.world.inputs import (
    ActorCommand,
    AddActors,
    ChangeBehaviour,
    PlaceActor,
    SendActors,
    SetParameters,
)
from esplanade.server.world.outcomes import CommandError, FaultCode


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
    table, actors = population.table, command.actors
    if len(set(actors)) < len(actors):
        raise CommandError(FaultCode.REFUSED, "an actor is named twice")
    if isinstance(command, AddActors):
        _check_newcomers(command, population, most_actors)
        return
    for actor in actors:
        if actor not in table:
            raise CommandError(FaultCode.UNKNOWN_ACTOR, f"there is no actor {actor}", actor=actor)
    match command:
        case SetParameters() if values:
            population.navigator.check_values(actors, command.values)
        case ChangeBehaviour():
            _check_behaviour(population, command.behaviour.make())
        case SendActors():
            _check_behaviour(population, GoTo(command.target))
        case PlaceActor():
            population.navigator.check_place(command.place[:2], command.place[2])


def _check_newcomers(command: AddActors, population: Population, most_actors: int) -> None:
    there = len(population)
    if there + len(command.specs) > most_actors:
        raise CommandError(
            FaultCode.FULL,
            f"there is room for {most_actors} actors, {there} are there",
            most=most_actors,
            there=there,
        )
    if len(command.specs) != len(command.parameters):
        raise CommandError(FaultCode.REFUSED, "each new actor needs its parameters")
    for spec in command.specs:
        if spec.id in population.table:
            raise CommandError(
                FaultCode.TAKEN, f"there already is an actor {spec.id}", actor=spec.id
            )
        _check_behaviour(population, spec.behaviour.make())
        if spec.place is not None:
            population.navigator.check_place(spec.place[:2], spec.place[2])


def _check_behaviour(population: Population, behaviour: Behaviour) -> None:
    try:
        population.check_targets(behaviour)
    except KeyError as error:
        raise CommandError(FaultCode.UNKNOWN_PLACE, str(error.args[0])) from None

"""Inputs are everything that may happen to a world from outside; a list per tick replays it."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from esplanade.actors import ActorParameters, ActorSpec, BehaviourSpec
from esplanade.actors.behaviour import Target
from esplanade.actors.potential_pool import GoalKey, RenewedPotential
from esplanade.planning.grid.bodies_change import BodiesChange
from esplanade.planning.grid.door_change import DoorChange
from esplanade.protocol.looks import NO_LOOK, Look
from esplanade.server.world.routes import Point, Route


@dataclass(frozen=True, slots=True)
class Join:
    """A new person joins. `ticket` is the caller's mark, and comes back with the avatar's id."""

    ticket: int
    name: str
    at: Point | None
    """The wished place x, y and height, metres; None for any spawn point."""
    anywhere: bool = True
    """Whether the wished place itself is given; otherwise the spawn point nearest to it is."""
    id: int | None = None
    """The id of somebody who comes from another zone and keeps it; None for a new one."""
    look: Look = NO_LOOK


@dataclass(frozen=True, slots=True)
class Attach:
    """Somebody looks through this person's eyes again, knowing nothing of the world.

    `ticket` is the caller's mark, and comes back in the frame.
    """

    id: int
    ticket: int = 0


@dataclass(frozen=True, slots=True)
class Detach:
    """The client of this person looks no more; the avatar stands still where it is."""

    id: int


@dataclass(frozen=True, slots=True)
class Leave:
    """The avatar goes out of the world."""

    id: int


@dataclass(frozen=True, slots=True)
class Stand:
    """The avatar stands still where it is: its client has fallen silent."""

    id: int


@dataclass(frozen=True, slots=True)
class Steer:
    """Walk in a direction (radians from +x) until told otherwise."""

    id: int
    seq: int
    direction_rad: float
    speed_mps: float


@dataclass(frozen=True, slots=True, eq=False)
class SteerMany:
    """The same as one `Steer` after the other, each of another person."""

    ids: tuple[int, ...]
    seqs: tuple[int, ...]
    directions_rad: NDArray[np.float64]
    speeds_mps: NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Follow:
    """Walk along a route that was found, to its end."""

    id: int
    seq: int
    route: Route


@dataclass(frozen=True, slots=True)
class PeoplePlaced:
    """People, all different, are at these places at the end of this tick.

    They mean to go nowhere then. Replays in which people do not walk by themselves have it.
    """

    ids: tuple[int, ...]
    places: tuple[Point, ...]


@dataclass(frozen=True, slots=True)
class MoveDoor:
    """Open or close a door, once nobody stands in its way."""

    name: str
    is_open: bool


@dataclass(frozen=True, slots=True)
class Say:
    """A person says a line."""

    id: int
    text: str


@dataclass(frozen=True, slots=True)
class SetAway:
    """A person is away from the screen from now on, or there again."""

    id: int
    away: bool


@dataclass(frozen=True, slots=True)
class MakeGesture:
    """The avatar makes a gesture, one of `esplanade.protocol.codes.Gesture`."""

    id: int
    gesture: int


@dataclass(frozen=True, slots=True)
class SetLook:
    """A person's avatar looks otherwise from now on."""

    id: int
    look: Look


@dataclass(frozen=True, slots=True)
class Watch:
    """A person wants the plans of an actor from now on, or of none."""

    id: int
    actor_id: int | None


@dataclass(frozen=True, slots=True)
class DoorDerived:
    """The changes that a door makes to the ground are derived: it moves, if it still may."""

    change: DoorChange


@dataclass(frozen=True, slots=True)
class PotentialDerived:
    """The potential of a goal is derived anew, since the ground has changed."""

    potential: RenewedPotential


@dataclass(frozen=True, slots=True)
class SetParameters:
    """Some parameters of some actors, all different, from this tick on: all, or none.

    `values` has one number by a parameter's name, or one for each of the actors.
    """

    command: int
    actors: tuple[str, ...]
    values: Mapping[str, ArrayLike]


@dataclass(frozen=True, slots=True)
class AddActors:
    """Actors come into the world, with the parameters of each; all, or none."""

    command: int
    specs: tuple[ActorSpec, ...]
    parameters: tuple[ActorParameters, ...]

    @property
    def actors(self) -> tuple[str, ...]:
        """Their ids."""
        return tuple(spec.id for spec in self.specs)


@dataclass(frozen=True, slots=True)
class RemoveActors:
    """Actors go out of the world; all, or none."""

    command: int
    actors: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class ChangeBehaviour:
    """Actors do something else from now on, each for itself; all, or none."""

    command: int
    actors: tuple[str, ...]
    behaviour: BehaviourSpec


@dataclass(frozen=True, slots=True)
class SendActors:
    """Actors go to a place or a point and stay there until they are told something else."""

    command: int
    actors: tuple[str, ...]
    target: Target


@dataclass(frozen=True, slots=True)
class PlaceActor:
    """An actor is elsewhere from now on: at a point, or on the nearest ground where it fits."""

    command: int
    actor: str
    place: Point

    @property
    def actors(self) -> tuple[str, ...]:
        """Its id."""
        return (self.actor,)


@dataclass(frozen=True, slots=True)
class HoldActors:
    """Actors stand where they are, making way, or go on with what they did."""

    command: int
    actors: tuple[str, ...]
    held: bool


@dataclass(frozen=True, slots=True)
class ActorsDerived:
    """All that a command on actors waited for is derived: it is carried out, if it still can be.

    A replay in another process may leave out all but the command and the places: what is not given
    is derived in the tick, to the same end.
    """

    command: int
    bodies: BodiesChange | None = None
    potentials: Mapping[GoalKey, NDArray[np.float32]] = field(default_factory=dict)
    places: tuple[Point, ...] = ()
    """The places of new actors."""
    fault: str | None = None
    """Why it could not be derived."""


@dataclass(frozen=True, slots=True)
class IdsReserved:
    """New avatars may get these ids too: from `first` up to and without `end`."""

    first: int
    end: int


@dataclass(frozen=True, slots=True)
class ActorsStood:
    """In this tick planning failed when it was recorded: the actors stand."""


@dataclass(frozen=True, slots=True)
class PlanEvery:
    """Each actor is planned every so many ticks from this one on."""

    ticks: int


@dataclass(frozen=True, slots=True)
class SteerActors:
    """In this tick these actors go at these velocities, m/s, which were decided elsewhere."""

    actors: tuple[str, ...]
    velocities_mps: tuple[tuple[float, float], ...]


@dataclass(frozen=True, slots=True)
class Still:
    """In this tick nobody moves and nothing is planned, since the world is paused.

    All other inputs of the tick are taken in, so that people can come, talk and go meanwhile.
    """


Movement = Steer | Follow
OfPerson = (
    Attach | Detach | Leave | Stand | Steer | Follow | Say | Watch | SetAway | MakeGesture | SetLook
)
"""Inputs of one avatar, by its `id`."""
OneActorCommand = (
    SetParameters
    | AddActors
    | RemoveActors
    | ChangeBehaviour
    | SendActors
    | PlaceActor
    | HoldActors
)
"""Commands on actors that do one thing."""


@dataclass(frozen=True, slots=True)
class Batch:
    """Commands on actors and doors, one after the other in one tick: all of them, or none.

    The numbers of its commands count for nothing; the outcome is that of the batch.
    """

    command: int
    commands: tuple[OneActorCommand, ...]
    doors: tuple[MoveDoor, ...] = ()

    @property
    def actors(self) -> tuple[str, ...]:
        """Ids of all actors that it is about."""
        return tuple(dict.fromkeys(actor for one in self.commands for actor in one.actors))


ActorCommand = OneActorCommand | Batch
"""Commands on actors. Each has a number, and a frame has the outcome of each by that number."""


def parts_of(command: ActorCommand) -> tuple[OneActorCommand, ...]:
    """The commands that a batch consists of, or the command itself."""
    return command.commands if isinstance(command, Batch) else (command,)


DerivedInput = DoorDerived | PotentialDerived | ActorsDerived
Input = (
    Join
    | SteerMany
    | PeoplePlaced
    | MoveDoor
    | OfPerson
    | DerivedInput
    | ActorCommand
    | ActorsStood
    | PlanEvery
    | SteerActors
    | Still
    | IdsReserved
)

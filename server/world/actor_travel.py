"""Actors who go from zone to zone, through portals that let them."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import count
from typing import Any, Final, Protocol

import structlog

from esplanade.actors import ActorParameters, ActorSpec
from esplanade.actors.behaviour_spec import WanderSpec
from esplanade.planning import Portal
from esplanade.planning.scene.portal_areas import NO_PORTAL, portals_at
from esplanade.server.world.frame import Frame
from esplanade.server.world.inputs import ActorCommand, AddActors, HoldActors, RemoveActors
from esplanade.server.world.outcomes import Fault, FaultCode
from esplanade.server.world.routes import Point
from esplanade.server.world.state import ACTOR
from esplanade.server.world.travels import Gone, Lately
from esplanade.server.world.zone import Zone

REMEMBERED_S: Final = 60.0
"""Comings and goings are remembered for so long: checkpoints of zones are of different moments."""

log = structlog.get_logger(__name__)


@dataclass(frozen=True)
class Traveller:
    """An actor that is to come into a zone: all that goes along, and who waits for the end."""

    spec: ActorSpec
    parameters: ActorParameters
    ended: Callable[[Fault | None], None]
    """Is told whether the actor is in: None, or why it is not."""


class Destination(Protocol):
    """A zone that actors go to."""

    def expect(self, traveller: Traveller) -> None:
        """Take in an actor of another zone, in one of the next ticks."""
        ...


class ActorTravel:
    """Lets actors of a zone out through its portals, and takes in those of other zones.

    An actor that comes to stand in a portal is held, and goes once the other zone has taken it
    in; where it is refused it goes on as before. It keeps its id, and does what it did; where its
    places are not known it wanders. A ticker calls `drain` between two ticks, and `take` with each
    frame. Numbers of commands are negative, so that they are not those of operators.
    """

    def __init__(self, world: Zone) -> None:
        self._world = world
        self._portals: Sequence[Portal] = ()
        self._exits: Mapping[str, tuple[Destination, Point]] = {}
        self._numbers = count(-1, -1)
        self._expected: list[Traveller] = []
        self._asked: dict[int, Traveller] = {}
        self._inputs: list[ActorCommand] = []
        self._inside: set[str] = set()
        """Actors who were in a portal when it was last looked at, or came out of it."""
        self._under_way: set[str] = set()
        self.came = 0
        """Actors who have come from other zones."""
        self._lately = Lately()
        self.before = Lately()
        """The comings and goings in the checkpoint that the world goes on from."""

    def open(
        self, portals: Iterable[Portal], exits: Mapping[str, tuple[Destination, Point]]
    ) -> None:
        """Let actors leave by some of the portals: to where, by the name of the portal."""
        self._portals, self._exits = [each for each in portals if each.name in exits], exits

    def expect(self, traveller: Traveller) -> None:
        """Take in an actor of another zone, in one of the next ticks."""
        self._expected.append(traveller)

    def refusal(self, traveller: Traveller) -> Fault | None:
        """The reason for which an actor of another zone would not be taken in now; None if it
        would."""
        return self._admitted(traveller)[2]

    def move(self, to: "ActorTravel", bounds: tuple[float, float, float, float]) -> None:
        """Let all actors go over to a zone that takes the place of this one, whose scene has
        changed. Each stands nearest to where it is now. It is to be called until none is left."""
        x0, y0, x1, y1 = bounds
        for actor in map(str, self._world.actors):
            avatar = self._world.avatar_of(actor)
            if actor in self._under_way or avatar is None:
                continue
            x, y, z_m = self._world.where(avatar)
            place = min(max(x, x0), x1), min(max(y, y0), y1), z_m
            self._send(actor, to, place)

    def drain(self) -> list[ActorCommand]:
        """Return the inputs of the next tick."""
        for actor, portal in self._newly_inside():
            if actor not in self._under_way:
                self._send(actor, *self._exits[portal], portal)
        expected, self._expected = self._expected, []
        for traveller in expected:
            self._take_in(traveller)
        inputs, self._inputs = self._inputs, []
        return inputs

    def take(self, frame: Frame) -> None:
        """Learn from a frame who has come in."""
        if not self._asked:
            return
        for outcome in frame.outcomes:
            traveller = self._asked.pop(outcome.command, None)
            if traveller is not None:
                self._end(traveller, outcome.fault)

    # --- restarts -----------------------------------------------------------------------------

    def save(self) -> dict[str, Any]:
        """The actors on the way, and those who have come or gone lately, as plain data."""
        self._lately.forget(self._world.tick - round(REMEMBERED_S / self._world.tick_s))
        return {"under_way": sorted(self._under_way), **self._lately.save()}

    def load(self, saved: Mapping[str, Any]) -> None:
        """Take in what the zone that goes on had saved, before the first tick.

        Raises
        ------
        ValueError, KeyError, TypeError
            It is not what `save` gives.
        """
        self.before = Lately.load(saved)
        waiting = tuple(str(actor) for actor in saved["under_way"] if actor in self._world.actors)
        if waiting:
            self._world.redo([HoldActors(next(self._numbers), waiting, held=False)])

    def has(self, actor: str) -> bool:
        """Whether the actor is in this zone."""
        return actor in self._world.actors

    def give_up(self, actor: str) -> None:
        """Take an actor out that is in another zone, before the first tick."""
        self._world.redo([RemoveActors(next(self._numbers), (actor,))])

    def find_again(self, gone: "Gone") -> None:
        """Let an actor come out of a portal once more by which it had gone."""
        if gone.portal in self._exits:
            to = self._exits[gone.portal][0]
            to.expect(Traveller(gone.spec, gone.parameters, lambda _: None))

    def _newly_inside(self) -> list[tuple[str, str]]:
        """The actors who have come into a portal since the last look, and its name."""
        if not self._portals:
            return []
        state = self._world.state
        slots = state.of_kind(ACTOR)
        found = portals_at(self._portals, state.positions[slots], state.heights[slots])
        inside = found != NO_PORTAL
        here = {}
        for avatar, portal in zip(
            state.ids[slots[inside]].tolist(), found[inside].tolist(), strict=True
        ):
            actor = self._world.actor_of(avatar)
            if actor is not None:
                here[actor] = self._portals[portal].name
        came = [(actor, portal) for actor, portal in here.items() if actor not in self._inside]
        self._inside = set(here)
        return came

    def _send(self, actor: str, to: Destination, arrival: Point, portal: str = "") -> None:
        self._under_way.add(actor)
        spec = self._world.actors[actor].model_copy(update={"place": arrival, "near": True})
        self._inputs.append(HoldActors(next(self._numbers), (actor,), held=True))

        parameters = self._world.parameters(actor)

        def ended(fault: Fault | None) -> None:
            number = next(self._numbers)
            self._under_way.discard(actor)
            if fault is None:
                self._lately.gone[actor] = Gone(self._world.tick, portal, spec, parameters)
                self._lately.came.pop(actor, None)
                self._inputs.append(RemoveActors(number, (actor,)))
            else:
                self._inputs.append(HoldActors(number, (actor,), held=False))

        to.expect(Traveller(spec, parameters, ended))

    def _take_in(self, traveller: Traveller) -> None:
        traveller, command, fault = self._admitted(traveller)
        if fault is not None:
            traveller.ended(fault)
            return
        self._asked[command.command] = traveller
        self._inputs.append(command)

    def _admitted(self, traveller: Traveller) -> tuple[Traveller, AddActors, Fault | None]:
        """A traveller as it would come in, by which command, and why that cannot be."""
        command = self._command(traveller)
        fault = self._world.check(command)
        if fault is not None and fault.code is FaultCode.UNKNOWN_PLACE:
            wandering = traveller.spec.model_copy(update={"behaviour": WanderSpec()})
            traveller = replace(traveller, spec=wandering)
            command = self._command(traveller)
            fault = self._world.check(command)
        return traveller, command, fault

    def _command(self, traveller: Traveller) -> AddActors:
        return AddActors(next(self._numbers), (traveller.spec,), (traveller.parameters,))

    def _end(self, traveller: Traveller, fault: Fault | None) -> None:
        if fault is None:
            self.came += 1
            self._inside.add(traveller.spec.id)
            self._lately.came[traveller.spec.id] = self._world.tick
            self._lately.gone.pop(traveller.spec.id, None)
            log.info("actor has travelled", actor=traveller.spec.id)
        traveller.ended(fault)


def bring_together(zones: Sequence[ActorTravel]) -> None:
    """Let each actor of a world that goes on be in one of its zones, before the first tick.

    Checkpoints of zones are of different moments, so that an actor that was on its way may be in
    two of them, or in none. It is where it had come to last.
    """
    gone = {actor: (zone, one) for zone in zones for actor, one in zone.before.gone.items()}
    came = {actor for zone in zones for actor in zone.before.came}
    for actor in sorted(came | gone.keys()):
        found = [zone for zone in zones if zone.has(actor)]
        if not found and actor not in came:
            origin, one = gone[actor]
            origin.find_again(one)
        found.sort(key=lambda zone: (actor in zone.before.came, actor not in zone.before.gone))
        for other in found[:-1]:
            other.give_up(actor)

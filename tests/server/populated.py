"""A small world with real actors, driven tick by tick, with or without derivation outside."""

from collections.abc import Sequence
from concurrent.futures import Future
from typing import Any, cast

from esplanade.actors import ActorParameters, ActorSpec
from esplanade.planning import Door, LayeredGrid, Place, Scene, Spawn, Wall
from esplanade.server.net.ground_work import GroundWork
from esplanade.server.populating import names_of, populate_from
from esplanade.server.roster import Roster
from esplanade.server.world.audience import Audience, News
from esplanade.server.world.frame import Frame
from esplanade.server.world.inputs import AddActors, Input, Join
from esplanade.server.world.outcomes import Fault
from esplanade.server.world.zone import Zone
from tests.server.worlds import TICK_S, rules

HALL = Scene(
    name="hall",
    bounds=(0.0, 0.0, 14.0, 9.0),
    walls=(Wall(start=(7.0, 0.0), end=(7.0, 3.0)), Wall(start=(7.0, 5.0), end=(7.0, 9.0))),
    doors=(Door(name="gate", start=(7.0, 3.0), end=(7.0, 5.0)),),
    spawns=(Spawn(position=(3.0, 3.0), radius_m=1.0),),
    places=(Place(name="west", position=(2.0, 7.0)), Place(name="east", position=(12.0, 7.0))),
)
"""Two halves with a door between them."""


def spec(number: int, kind: str = "idle", **more: Any) -> ActorSpec:
    """The actor `main/a1`, `main/a2`, ...: it stands in a row at the bottom unless told else."""
    behaviour = {"kind": kind, **more.pop("behaviour", {})}
    place = more.pop("place", (1.0 + 1.2 * number, 1.0, 0.0))
    return ActorSpec.model_validate(
        {"id": f"main/a{number}", "name": f"A{number}", "behaviour": behaviour, "place": place}
        | more
    )


class AtOnce:
    """An executor that is done before it returns, so that a test knows when."""

    def submit(self, work: Any, *arguments: Any) -> "Future[Any]":
        done: Future[Any] = Future()
        done.set_result(work(*arguments))
        return done


class Populated:
    """A world of these actors. With `outside`, what is heavy comes as inputs of later ticks."""

    def __init__(
        self,
        specs: Sequence[ActorSpec],
        *,
        outside: bool = False,
        scene: Scene = HALL,
        room_for: int = 0,
    ) -> None:
        """With `room_for` there is room for as many actors as in a world that began with those."""
        self.grid = grid = LayeredGrid.from_scene(scene)
        roster = Roster(actors=tuple(specs))
        self.population = populate_from(roster, grid, scene, TICK_S, 3)
        self.zone = Zone(
            scene,
            grid,
            self.population,
            {**names_of(roster), **dict.fromkeys(range(room_for), "")},
            rules(),
            tick_s=TICK_S,
            max_people=16,
            seed=3,
            clock=lambda: 0.0,
            roster=roster.actors,
        )
        self.audience = Audience(self.zone.rules, self.zone.origin_m, self.zone.times)
        self.work = GroundWork(self.zone, cast(Any, AtOnce())) if outside else None
        self.inputs: list[list[Input]] = []
        """Of every tick so far."""

    def frame(self, *inputs: Input) -> Frame:
        """One tick of the zone, which its audience is told of."""
        self.inputs.append([*inputs, *(self.work.drain() if self.work else [])])
        self.zone.begin(self.inputs[-1])
        frame = self.zone.finish(self.zone.think())
        self.latest = self.audience.take(frame)
        return frame

    def news(self, *inputs: Input) -> News:
        """Return the news that the audience makes of one tick."""
        self.frame(*inputs)
        return self.latest

    def frames(self, ticks: int) -> list[Frame]:
        """Run this number of ticks without inputs of their own."""
        return [self.frame() for _ in range(ticks)]

    def join(self, *places: tuple[float, float]) -> list[int]:
        """Ids of new people at these places, who look from now on."""
        frame = self.frame(*(Join(k, f"p{k}", (*place, 0.0)) for k, place in enumerate(places)))
        return [avatar_id for _, avatar_id in frame.joined]

    def fault(self, command: Input) -> Fault:
        """Return the fault of a command that is refused at once."""
        (outcome,) = self.frame(command).outcomes
        assert outcome.fault is not None
        return outcome.fault

    def slot(self, actor_id: str) -> int:
        avatar_id = self.zone.avatar_of(actor_id)
        assert avatar_id is not None
        return self.zone.state.slot(avatar_id)


def adding(command: int, *specs: ActorSpec, **parameters: float) -> AddActors:
    """A command that adds these actors, all with these parameters."""
    return AddActors(command, specs, tuple(ActorParameters(**parameters) for _ in specs))

"""What may happen to a zone, by inputs of all kinds: people, operators, doors, trouble."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from esplanade.actors.behaviour_spec import BEHAVIOUR_SPEC
from esplanade.protocol.looks import Look
from esplanade.server.world.inputs import (
    ActorsStood,
    Batch,
    ChangeBehaviour,
    Detach,
    Follow,
    HoldActors,
    IdsReserved,
    Input,
    Join,
    Leave,
    MakeGesture,
    MoveDoor,
    PlaceActor,
    PlanEvery,
    RemoveActors,
    SendActors,
    SetAway,
    SetLook,
    SetParameters,
    Stand,
    Steer,
    SteerActors,
    SteerMany,
    Still,
    Watch,
)
from esplanade.server.world.state import PERSON
from tests.server.populated import Populated, adding, spec

ROUND = {"stops": ["east", "west"], "pause_s": 0.3}
TOUR = {"kind": "guide", "tour": ["west", "east"], "pause_s": 0.2}
ACTORS = ["main/a1", "main/a2", "main/a3", "main/a9"]


class Happening(NamedTuple):
    """What happens after some ticks: to whom, as a number among those who are there."""

    ticks: int
    kind: str
    who: int
    amount: float


def hall() -> Populated:
    return Populated(
        [
            spec(1, "patrol", behaviour=ROUND),
            spec(2, "wander", behaviour={"least_pause_s": 0.1, "most_pause_s": 0.4}),
            spec(3, "guide", behaviour=TOUR),
        ],
        outside=True,
    )


class Scene(NamedTuple):
    """Those to whom something happens, and where."""

    number: int
    """That of a command, or of a movement."""
    who: int
    amount: float
    at: tuple[float, float, float]
    people: tuple[int, ...]
    person: int
    actor: str
    avatar: int | None


def _behaviour(scene: Scene) -> Input:
    kind = [TOUR, {"kind": "patrol", **ROUND}, {"kind": "wander"}][scene.who % 3]
    return ChangeBehaviour(scene.number, (scene.actor,), BEHAVIOUR_SPEC.validate_python(kind))


def _body(scene: Scene) -> Input:
    radius_m = (0.25, 0.3, 0.4)[scene.who % 3]
    values = {"radius_m": radius_m, "height_m": 1.5 + scene.amount}
    return SetParameters(scene.number, (scene.actor,), values)


def _steer_many(scene: Scene) -> Input:
    count = len(scene.people)
    directions, speeds = np.linspace(0.0, 6.0, count), np.full(count, 3.0 * scene.amount)
    return SteerMany(scene.people, (scene.number,) * count, directions, speeds)


def _batch(scene: Scene) -> Input:
    held = HoldActors(scene.number, (scene.actor,), held=False)
    return Batch(scene.number, (held,), (MoveDoor("gate", is_open=scene.amount < 0.5),))


MAKERS: dict[str, Callable[[Scene], Input]] = {
    "join": lambda s: Join(s.number, f"p{s.number}", s.at if s.who % 2 else None),
    "hop": lambda s: Join(s.number, "from elsewhere", s.at, anywhere=False, id=5000 + s.number),
    "leave": lambda s: Leave(s.person),
    "steer": lambda s: Steer(s.person, s.number, 6.28 * s.amount, 1.5),
    "steer_many": _steer_many,
    "follow": lambda s: Follow(s.person, s.number, ((3.0, 4.0, 0.0), (6.5, 4.0, 0.0), s.at)),
    "stand": lambda s: Stand(s.person),
    "detach": lambda s: Detach(s.person),
    "away": lambda s: SetAway(s.person, s.who % 2 == 0),
    "gesture": lambda s: MakeGesture(s.person, 1 + s.who % 4),
    "look": lambda s: SetLook(s.person, Look(1 + s.who % 12, stature_cm=150 + s.who % 50)),
    "watch": lambda s: Watch(s.person, s.avatar),
    "ids": lambda s: IdsReserved(10_000 * (s.number + 1), 10_000 * (s.number + 1) + 5),
    "door": lambda s: MoveDoor("gate", is_open=s.who % 2 == 0),
    "temper": lambda s: SetParameters(s.number, (s.actor,), {"risk_weight": 1 + 20 * s.amount}),
    "body": _body,
    "add": lambda s: adding(s.number, spec(9, "wander", place=None), radius_m=0.3),
    "remove": lambda s: RemoveActors(s.number, (s.actor,)),
    "behaviour": _behaviour,
    "hold": lambda s: HoldActors(s.number, (s.actor,), s.amount < 0.5),
    "send": lambda s: SendActors(s.number, (s.actor,), s.at),
    "place": lambda s: PlaceActor(s.number, s.actor, s.at),
    "batch": _batch,
    "steered": lambda s: SteerActors((s.actor, "hall/nobody"), ((s.amount, -0.5), (1.0, 0.0))),
    "interval": lambda s: PlanEvery(1 + s.who % 3),
    "still": lambda _: Still(),
    "stood": lambda _: ActorsStood(),
}
OFTEN = ["join", "follow", "steer", "door", "door", "body"]


def input_of(world: Populated, happening: Happening, number: int) -> Input:
    """The input by which something happens; `number` is that of a command."""
    state, actor = world.zone.state, ACTORS[happening.who % len(ACTORS)]
    ids = tuple(state.ids[state.of_kind(PERSON)].tolist())
    amount = happening.amount
    scene = Scene(
        number,
        happening.who,
        amount,
        (1.0 + 12.0 * amount, 1.5 + 5.0 * amount, 0.0),
        ids,
        ids[happening.who % len(ids)] if ids else 4999,
        actor,
        world.zone.avatar_of(actor),
    )
    return MAKERS[happening.kind](scene)

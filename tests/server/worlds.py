"""Small worlds for tests, without sockets."""

import json
from collections.abc import Iterable
from functools import cache
from itertools import count
from pathlib import Path

import msgpack

from esplanade.planning import LayeredGrid, Place, Scene, Spawn, Wall
from esplanade.server.world.audience import Audience, News
from esplanade.server.world.frame import Frame, Tickets
from esplanade.server.world.inputs import Input, Join
from esplanade.server.world.rules import Rules
from esplanade.server.world.zone import Zone
from tests.server.doubles import ScriptedPopulation

TICK_S = 0.05

ROOM = Scene(
    name="room",
    bounds=(0.0, 0.0, 20.0, 20.0),
    walls=(Wall(start=(10.0, 0.0), end=(10.0, 15.0)),),
    spawns=(Spawn(position=(3.0, 3.0), radius_m=1.0),),
    places=(Place(name="west", position=(2.0, 10.0)), Place(name="east", position=(18.0, 10.0))),
)
"""Two halves behind a wall at x = 10, with a way round at its upper end."""

FIELD = Scene.open_space((0.0, 0.0, 200.0, 200.0))

_MESH = """\
v 0 0 0
v 10 0 0
v 10 0 10
v 0 0 10
v 5 3 0
v 10 3 0
v 10 3 10
v 5 3 10
f 1 4 3 2
f 5 8 7 6
"""
"""y up: a floor of 10 m square, and another over half of it, 3 m higher."""

grid_of = cache(LayeredGrid.from_scene)


def write_mesh_world(folder: Path) -> Path:
    """A scene file of a mesh, which lies beside it; spawns on both floors."""
    (folder / "house.obj").write_text(_MESH)
    spawns = [{"position": [2, -5]}, {"position": [8, -5], "z_m": 3}]
    scene = {"bounds": [0, -10, 10, 0], "mesh": "house.obj", "spawns": spawns}
    path = folder / "house.json"
    path.write_text(json.dumps(scene))
    return path


def rules(**changes: float) -> Rules:
    values: dict[str, float] = {
        "person_radius_m": 0.25,
        "person_clearance_m": 0.25,
        "person_max_speed_mps": 3.0,
        "person_walk_speed_mps": 1.6,
        "view_radius_m": 20.0,
        "view_limit": 50,
        "steps_radius_m": 10.0,
        "steps_limit": 20,
        "viewer_bytes": 1_000_000,
        "tick_rate": round(1.0 / TICK_S),
    }
    return Rules(**{**values, **changes})  # type: ignore[arg-type]


class Trial:
    """A world that a test drives tick by tick."""

    def __init__(
        self,
        scene: Scene = ROOM,
        population: ScriptedPopulation | None = None,
        seed: int = 1,
        max_people: int = 64,
        **changes: float,
    ) -> None:
        self.population = population or ScriptedPopulation(TICK_S)
        self.grid = grid_of(scene)
        ticks = count()
        self.world = Zone(
            scene,
            self.grid,
            self.population.as_population(),
            {actor_id: str(actor_id) for actor_id in self.population.positions},
            rules(**changes),
            tick_s=TICK_S,
            max_people=max_people,
            seed=seed,
            clock=lambda: float(next(ticks)),
        )
        self.audience = Audience(self.world.rules, self.world.origin_m, self.world.times)
        self.joined: Tickets = []

    def frame(self, *inputs: Input) -> Frame:
        """One tick of the zone, which the audience is not told of."""
        self.world.begin(inputs)
        frame = self.world.finish(self.world.think())
        self.joined = frame.joined
        return frame

    def tick(self, *inputs: Input, writing: bool = True) -> News:
        """One whole tick; with `writing`, every viewer is sent its snapshot."""
        news = self.audience.take(self.frame(*inputs))
        if writing:
            places = list(range(len(news.snapshots.viewers)))
            self.audience.wrote(news.snapshots, places)
        return news

    def ticks(self, number: int) -> None:
        for _ in range(number):
            self.tick()

    def join(self, *places: tuple[float, float]) -> list[int]:
        """Ids of new people at these places."""
        self.tick(*(Join(k, f"p{k}", (*place, 0)) for k, place in enumerate(places)))
        return [avatar_id for _, avatar_id in self.joined]

    def position(self, avatar_id: int) -> tuple[float, float]:
        x, y = self.world.state.positions[self.world.state.slot(avatar_id)].tolist()
        return x, y

    def speed(self, avatar_id: int) -> float:
        return float(self.world.state.speeds[self.world.state.slot(avatar_id)])


def block_of(news: News, viewer: int) -> bytes:
    """The packed records that this viewer is to be sent."""
    snapshots = news.snapshots
    place = snapshots.viewers.index(viewer)
    begin = snapshots.record_ends[place - 1] if place else 0
    return snapshots.records[begin : snapshots.record_ends[place]].tobytes()


def steps_of(news: News, viewer: int) -> bytes:
    """The packed steps that this viewer is to be sent."""
    snapshots = news.snapshots
    place = snapshots.viewers.index(viewer)
    begin = snapshots.step_ends[place - 1] if place else 0
    return snapshots.steps[begin : snapshots.step_ends[place]].tobytes()


def entered_ids(news: News, viewer: int) -> list[int]:
    """Ids of the avatars that came into this viewer's view."""
    return [msgpack.unpackb(packed)["id"] for packed in news.entered.get(viewer, [])]


def ids_in(records: Iterable[tuple[int, ...]]) -> list[int]:
    return sorted(int(record[0]) for record in records)

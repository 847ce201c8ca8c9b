"""Actors who go from zone to zone: each is in exactly one of them in the end."""

from collections.abc import Iterator

import pytest

from esplanade.planning import Place, Portal, Scene
from esplanade.server.world.actor_travel import ActorTravel
from esplanade.server.world.inputs import RemoveActors, Still
from tests.server.populated import HALL, Populated, spec

DOOR = Portal(
    name="door", points=((12.0, 1.0), (14.0, 1.0), (14.0, 3.0), (12.0, 3.0)), arrival=(10.0, 2.0)
)
HERE = HALL.model_copy(update={"portals": (DOOR,)})
ELSEWHERE = Scene(
    name="elsewhere",
    bounds=(0.0, 0.0, 12.0, 12.0),
    places=(Place(name="stage", position=(10.0, 10.0)), Place(name="bar", position=(2.0, 10.0))),
    portals=(DOOR.model_copy(update={"points": ((0.0, 1.0), (2.0, 1.0), (2.0, 3.0), (0.0, 3.0))}),),
)
IN_DOOR = (13.0, 2.0, 0.0)
ANN = "main/a1"


class Two:
    """Two zones whose actors may go from one to the other; both tick in turns."""

    def __init__(self, *specs: object, outside: bool = False) -> None:
        self.here = Populated(specs, scene=HERE, outside=outside)  # type: ignore[arg-type]
        self.there = Populated([spec(9, place=(6.0, 6.0, 0.0))], scene=ELSEWHERE, outside=outside)
        self.travels = [ActorTravel(each.zone) for each in (self.here, self.there)]
        here, there = self.travels
        here.open(HERE.portals, {"door": (there, (4.0, 2.0, 0.0))})
        there.open(ELSEWHERE.portals, {"door": (here, DOOR.arrival_place)})

    def tick(self, ticks: int = 1) -> None:
        for _ in range(ticks):
            for world, travel in zip((self.here, self.there), self.travels, strict=True):
                travel.take(world.frame(*travel.drain()))

    def where(self, actor: str) -> list[str]:
        zones = {"here": self.here.zone, "there": self.there.zone}
        return [name for name, zone in zones.items() if actor in zone.actors]

    def close(self) -> None:
        self.here.population.close()
        self.there.population.close()


@pytest.fixture
def made(request: pytest.FixtureRequest) -> Iterator[list[Two]]:
    found: list[Two] = []
    yield found
    for each in found:
        each.close()


@pytest.mark.parametrize("outside", [False, True])
def test_an_actor_that_stands_in_a_portal_comes_out_in_the_other_zone(
    made: list[Two], outside: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("esplanade.server.net.ground_work.taken_s", lambda: 0.0)
    two = Two(spec(1, place=IN_DOOR, overrides={"speed_mps": 0.7}), spec(2), outside=outside)
    made.append(two)
    two.tick(12)
    assert two.where(ANN) == ["there"]
    assert two.where("main/a2") == ["here"]
    assert two.there.zone.parameters(ANN).speed_mps == 0.7
    assert two.there.zone.actors[ANN].name == "A1"
    avatar = two.there.zone.avatar_of(ANN)
    assert avatar is not None
    assert two.there.zone.where(avatar)[:2] == pytest.approx((4.0, 2.0), abs=0.3)
    assert [travel.came for travel in two.travels] == [0, 1]
    assert two.here.zone.avatar_of(ANN) is None


def test_an_actor_whose_places_are_not_known_wanders(made: list[Two]) -> None:
    two = Two(spec(1, "patrol", place=IN_DOOR, behaviour={"stops": ["west", "east"]}), spec(2))
    made.append(two)
    two.tick(4)
    assert two.where(ANN) == ["there"]
    assert two.there.zone.actors[ANN].behaviour.kind == "wander"
    before = two.there.zone.where(two.there.zone.avatar_of(ANN) or 0)
    two.tick(200)
    assert two.there.zone.where(two.there.zone.avatar_of(ANN) or 0) != before


def test_an_actor_that_is_refused_goes_on_where_it_is(made: list[Two]) -> None:
    two = Two(spec(1, "go_to", place=IN_DOOR, behaviour={"target": "west"}))
    made.append(two)
    # Somebody of that id is in the other zone.
    taken = Two(spec(1, place=IN_DOOR))
    made.append(taken)
    here, there = two.travels[0], ActorTravel(taken.here.zone)
    here.open(HERE.portals, {"door": (there, (4.0, 2.0, 0.0))})
    for _ in range(3):
        here.take(two.here.frame(*here.drain()))
        there.take(taken.here.frame(*there.drain()))
    assert ANN in two.here.zone.actors
    assert there.came == 0
    x = two.here.zone.where(two.here.zone.avatar_of(ANN) or 0)[0]
    for _ in range(60):
        here.take(two.here.frame(*here.drain()))
    assert two.here.zone.where(two.here.zone.avatar_of(ANN) or 0)[0] < x - 1.0


def test_an_actor_that_is_removed_on_its_way_out_is_in_the_other_zone_alone(
    made: list[Two],
) -> None:
    two = Two(spec(1, place=IN_DOOR), spec(2))
    made.append(two)
    here, there = two.travels
    two.here.frame()
    here.take(two.here.frame(*here.drain(), RemoveActors(1, (ANN,))))
    assert two.where(ANN) == []
    there.take(two.there.frame(*there.drain()))
    two.tick(2)
    assert two.where(ANN) == ["there"]


def test_actors_come_into_a_zone_that_is_paused(made: list[Two]) -> None:
    two = Two(spec(1, place=IN_DOOR), spec(2))
    made.append(two)
    here, there = two.travels
    two.here.frame()
    here.take(two.here.frame(*here.drain()))
    there.take(two.there.frame(Still(), *there.drain()))
    assert two.where(ANN) == ["here", "there"]
    here.take(two.here.frame(*here.drain()))
    assert two.where(ANN) == ["there"]


def test_without_exits_for_actors_they_stay(made: list[Two]) -> None:
    two = Two(spec(1, place=IN_DOOR))
    made.append(two)
    two.travels[0].open(HERE.portals, {})
    two.tick(4)
    assert two.where(ANN) == ["here"]


def test_the_same_inputs_without_the_other_zone_give_the_same_frames(made: list[Two]) -> None:
    two = Two(spec(1, place=IN_DOOR), spec(2, "wander"))
    made.append(two)
    two.tick(30)
    again = Populated([spec(1, place=IN_DOOR), spec(2, "wander")], scene=HERE)
    for inputs in two.here.inputs:
        again.frame(*inputs)
    assert again.zone.state.positions.tobytes() == two.here.zone.state.positions.tobytes()
    assert again.zone.actors == two.here.zone.actors
    again.population.close()

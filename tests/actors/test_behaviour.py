"""Behaviours on their own: what goal they give for what they see."""

import math
from collections.abc import Mapping

import numpy as np
import pytest

from esplanade.actors import Behaviour, GoTo, Guide, Idle, Patrol, Perception, Wander
from esplanade.actors.tours import Tour
from esplanade.planning import Body, LayeredGrid, Place, Polygon, Scene
from tests.actors.worlds import block, plaza
from tests.planning.storeys import storeyed
from tests.planning.worlds import UPPER_M

SCENE = plaza()
GRID = LayeredGrid.from_scene(SCENE)
ADULT = Body.adult()
GATE, FOUNTAIN, STAGE = ((*place.position, place.z_m) for place in SCENE.places)


def seeing(
    time_s: float = 0.0,
    position: tuple[float, float] = (6.0, 6.0),
    arrived: bool = False,
    stuck: bool = False,
    people: Mapping[str, tuple[float, float, float]] | None = None,
    scene: Scene = SCENE,
    grid: LayeredGrid = GRID,
    seed: int = 0,
    z_m: float = 0.0,
    body: Body = ADULT,
) -> Perception:
    rng = np.random.default_rng(seed)
    return Perception(time_s, position, z_m, arrived, stuck, people or {}, scene, grid, body, rng)


def test_idle_wants_nothing() -> None:
    assert Idle().update(seeing()) is None
    assert Idle().targets() == ()


def test_go_to_wants_one_place_or_point() -> None:
    assert GoTo("gate").update(seeing()) == GATE
    assert GoTo((3.0, 4.0, 3.3)).update(seeing(arrived=True)) == (3.0, 4.0, 3.3)
    assert GoTo("gate").targets() == ("gate",)
    with pytest.raises(KeyError, match=r"no place named 'moon'.*gate, fountain, stage"):
        GoTo("moon").update(seeing())


def test_wander_rests_where_it_arrives_and_then_goes_elsewhere() -> None:
    wander = Wander(pause_s=(2.0, 2.0))
    first = wander.update(seeing())
    assert first in {GATE, FOUNTAIN, STAGE}
    there = first[:2]
    assert wander.update(seeing(1.0)) == first
    assert wander.update(seeing(5.0, there, arrived=True)) == first
    assert wander.update(seeing(6.9, there, arrived=True)) == first
    second = wander.update(seeing(7.0, there, arrived=True))
    assert second != first
    assert wander.update(seeing(7.1, there)) == second


def test_wander_gives_up_what_cannot_be_reached() -> None:
    wander = Wander()
    first = wander.update(seeing(seed=1))
    goals = {wander.update(seeing(stuck=True, seed=seed)) for seed in range(10)}
    assert goals - {first}


def test_wander_without_places_goes_anywhere_free() -> None:
    scene = Scene.open_space((0.0, 0.0, 12.0, 12.0))
    goals = [
        Wander().update(seeing(scene=scene, grid=LayeredGrid.from_scene(scene), seed=seed))
        for seed in range(20)
    ]
    assert len(set(goals)) == 20
    assert all(math.dist(goal[:2], (6.0, 6.0)) > 1.0 for goal in goals)


def test_wandering_anywhere_is_for_the_body_that_wanders() -> None:
    low = Polygon(
        points=((4.0, 0.0), (8.0, 0.0), (8.0, 8.0), (4.0, 8.0)), offset_m=1.5, height_m=1.0
    )
    scene = Scene(bounds=(0.0, 0.0, 8.0, 8.0), polygons=(low,))
    grid = LayeredGrid.from_scene(scene)
    goals = {
        body: [
            Wander().update(seeing(position=(2.0, 4.0), scene=scene, grid=grid, seed=k, body=body))
            for k in range(20)
        ]
        for body in (ADULT, Body.child())
    }
    assert max(goal[0] for goal in goals[ADULT]) < 4.0
    assert max(goal[0] for goal in goals[Body.child()]) > 4.5


def test_wander_stays_where_there_is_nowhere_else() -> None:
    scene = Scene.open_space((0.0, 0.0, 0.8, 0.8))
    view = seeing(position=(0.4, 0.4), scene=scene, grid=LayeredGrid.from_scene(scene))
    assert Wander().update(view) is None


def test_patrol_goes_round_and_round() -> None:
    patrol = Patrol(["gate", "fountain", (6.0, 10.0, 0)], pause_s=1.0)
    time_s, visited = 0.0, []
    for _ in range(5):
        goal = patrol.update(seeing(time_s))
        visited.append(goal)
        assert patrol.update(seeing(time_s, arrived=True)) == goal
        assert patrol.update(seeing(time_s + 0.9, arrived=True)) == goal
        patrol.update(seeing(time_s + 1.0, arrived=True))
        time_s += 2.0
    assert visited == [GATE, FOUNTAIN, STAGE, GATE, FOUNTAIN]


def test_patrol_leaves_out_a_stop_it_cannot_reach() -> None:
    patrol = Patrol(["gate", "fountain"])
    assert patrol.update(seeing()) == GATE
    assert patrol.update(seeing(3.0, stuck=True)) == FOUNTAIN


@pytest.mark.parametrize("behaviour", [Patrol, Guide])
def test_a_round_needs_stops(behaviour) -> None:
    with pytest.raises(ValueError, match="at least one stop"):
        behaviour([])


def test_a_guides_distances_are_in_order() -> None:
    with pytest.raises(ValueError, match="join_m must lie below lag_m"):
        Guide(["gate"], join_m=5.0, lag_m=4.0)


def near(distance_m: float, z_m: float = 0.0) -> dict[str, tuple[float, float, float]]:
    return {"ann": (6.0 + distance_m, 6.0, z_m)}


def joined() -> Guide:
    guide = Guide(["gate", "fountain"], join_m=3.0, lag_m=6.0, join_after_s=2.0, patience_s=15.0)
    for time_s in (0.0, 1.0, 2.0):
        assert guide.update(seeing(time_s, people=near(2.0))) == GATE
    assert guide.followers == {"ann"}
    return guide


def test_who_stays_near_a_guide_follows_and_who_passes_does_not() -> None:
    guide = Guide(["gate"], join_after_s=2.0)
    guide.update(seeing(0.0, people=near(2.0)))
    guide.update(seeing(1.0, people=near(4.0)))
    guide.update(seeing(2.5, people=near(2.0)))
    assert guide.followers == frozenset()
    joined()


def test_a_guide_waits_for_who_falls_behind_and_goes_on_when_they_are_back() -> None:
    guide = joined()
    assert guide.update(seeing(3.0, people=near(5.9))) == GATE
    assert guide.update(seeing(4.0, people=near(6.1))) is None
    assert guide.waiting
    assert guide.update(seeing(5.0, people=near(4.0))) is None
    assert guide.update(seeing(6.0, people=near(2.9))) == GATE
    assert not guide.waiting
    assert guide.followers == {"ann"}


def test_a_guides_patience_ends() -> None:
    guide = joined()
    assert guide.update(seeing(4.0, people=near(9.0))) is None
    assert guide.update(seeing(18.9, people=near(9.0))) is None
    assert guide.update(seeing(19.0, people=near(9.0))) == GATE
    assert guide.followers == frozenset()


def test_a_guide_forgets_who_has_left() -> None:
    guide = joined()
    assert guide.update(seeing(4.0, people=near(9.0))) is None
    assert guide.update(seeing(5.0, people={})) == GATE
    assert guide.followers == frozenset()
    assert not guide.waiting


def test_a_follower_on_another_floor_is_far_behind() -> None:
    guide = joined()
    assert guide.update(seeing(4.0, people=near(1.0, z_m=3.3))) is None
    assert guide.update(seeing(5.0, people=near(1.0, z_m=0.2))) == GATE


def test_who_is_on_another_floor_does_not_follow() -> None:
    guide = Guide(["gate"], join_after_s=2.0)
    for time_s in (0.0, 1.0, 2.0, 3.0):
        guide.update(seeing(time_s, people=near(1.0, z_m=3.3)))
    assert guide.followers == frozenset()
    for time_s in (4.0, 5.0, 6.0):
        guide.update(seeing(time_s, people=near(1.0, z_m=3.3), z_m=3.3))
    assert guide.followers == {"ann"}


def test_a_place_straight_above_is_somewhere_to_wander_to() -> None:
    places = tuple(
        Place(name=name, position=(12.0, 6.0), z_m=z_m)
        for name, z_m in (("below", 0.0), ("above", UPPER_M))
    )
    scene = storeyed().model_copy(update={"places": places})
    grid = LayeredGrid.from_scene(scene)
    for here, there in ((0.0, UPPER_M), (UPPER_M, 0.0)):
        view = seeing(position=(12.0, 6.0), z_m=here, scene=scene, grid=grid)
        assert Wander().update(view) == (12.0, 6.0, there)


def test_wandering_anywhere_keeps_to_the_floor() -> None:
    scene = storeyed()
    grid = LayeredGrid.from_scene(scene)
    for seed in range(12):
        view = seeing(position=(12.0, 2.0), z_m=UPPER_M, scene=scene, grid=grid, seed=seed)
        x, y, z_m = Wander().update(view)
        assert abs(grid.floor_at((x, y), z_m) - UPPER_M) < 1e-3
        assert x > 8.2
        assert 0.0 <= y <= 12.0


def test_a_guide_leads_on_along_its_tour() -> None:
    guide = Guide(["gate", "fountain"], pause_s=1.0)
    assert guide.targets() == ("gate", "fountain")
    guide.update(seeing(0.0, arrived=True))
    assert guide.update(seeing(1.0, arrived=True)) == FOUNTAIN


SIGHTS = SCENE.model_copy(update={"polygons": (block(1.0, 4.0, 3.0, 5.0),)})
"""The plaza with a stand beside the gate."""
STAND = (2.0, 4.5, 1.5)


def test_a_guide_points_at_what_stands_at_a_stop_while_it_explains() -> None:
    guide = Guide(["gate", "fountain"], pause_s=5.0, join_after_s=2.0)
    for time_s in (0.0, 1.0, 2.0):
        guide.update(seeing(time_s, people=near(2.0), scene=SIGHTS))
        assert guide.points_at is None
    for time_s in (3.0, 5.0, 7.9):
        guide.update(seeing(time_s, arrived=True, people=near(2.0), scene=SIGHTS))
        assert guide.points_at == STAND
    assert guide.update(seeing(8.0, arrived=True, people=near(2.0), scene=SIGHTS)) == FOUNTAIN
    assert guide.points_at is None
    guide.update(seeing(9.0, arrived=True, people=near(2.0), scene=SIGHTS))
    assert guide.points_at is None, "nothing stands there"


def test_a_guide_explains_nothing_to_nobody_or_to_who_is_left_behind() -> None:
    guide = Guide(["gate"], pause_s=50.0, join_after_s=2.0)
    guide.update(seeing(0.0, arrived=True, scene=SIGHTS))
    assert guide.points_at is None
    for time_s in (1.0, 3.0):
        guide.update(seeing(time_s, arrived=True, people=near(2.0), scene=SIGHTS))
    assert guide.points_at == STAND
    guide.update(seeing(4.0, arrived=True, people=near(9.0), scene=SIGHTS))
    assert guide.points_at is None


@pytest.mark.parametrize("behaviour", [Idle(), GoTo("gate"), Wander(), Patrol(["gate"])])
def test_others_do_not_point(behaviour: Behaviour) -> None:
    behaviour.update(seeing(0.0, arrived=True, people=near(1.0), scene=SIGHTS))
    assert behaviour.points_at is None


def test_a_guide_says_where_one_is_and_where_one_goes_to_those_whom_it_leads() -> None:
    guide = Guide(["gate", (1.0, 2.0, 0.0)], pause_s=5.0, join_after_s=2.0)
    assert said(guide, 0.0) == said(guide, 1.0) == []
    assert said(guide, 2.0) == ["Welcome to the tour of 2 stops."]
    assert [saying.to for saying in guide.says] == [{"ann"}]
    assert said(guide, 3.0, arrived=True) == ["This is gate, stop 1 of 2."]
    assert said(guide, 7.9, arrived=True) == []
    assert said(guide, 8.0, arrived=True) == ["We go on to stop 2."]
    assert said(guide, 9.0, arrived=True) == ["This is stop 2 of 2."]
    assert guide.tour == Tour(("gate", ""), 1, frozenset({"ann"}))
    # To nobody it says nothing.
    guide.update(seeing(10.0, arrived=True, people={}))
    assert guide.update(seeing(20.0, arrived=True, people={})) == GATE
    assert guide.says == ()
    assert Patrol(["gate"]).tour is None


def said(guide: Guide, time_s: float, *, arrived: bool = False) -> list[str]:
    """The sentences of a guide beside whom somebody stands."""
    guide.update(seeing(time_s, arrived=arrived, people=near(2.0)))
    return [saying.text for saying in guide.says]

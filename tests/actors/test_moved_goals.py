"""Goals of actors where their bodies do not fit: told of, and refused where they are strict."""

import pytest

from esplanade.actors import ActorParameters, Navigator, Population, Reason
from esplanade.actors.behaviour_spec import BEHAVIOUR_SPEC
from esplanade.planning import (
    LayeredGrid,
    MoveReason,
    PathStatus,
    PlanModel,
    Polygon,
    Scene,
    find_path,
)

SOLID = Polygon(points=((4, 4), (8, 4), (8, 8), (4, 8)), height_m=3, kind="wall")
SCENE = Scene(bounds=(0, 0, 12, 12), polygons=(SOLID,))


def navigator() -> Navigator:
    found = Navigator(SCENE, tick_s=0.1, plan=PlanModel(threads=1))
    found.add_actor("a", (1.0, 6.0), None, ActorParameters())
    return found


def reason_after(of: Navigator, ticks: int) -> Reason:
    for _ in range(ticks):
        of.observe({})
        of.tick()
    return of.state("a").reason


def test_a_goal_inside_a_solid_is_moved_and_that_is_told() -> None:
    zone = navigator()
    zone.set_goal("a", (5.5, 6.0))
    moved = zone.moved("a")
    assert moved is not None
    assert moved.reason is MoveReason.INSIDE_WALL
    assert moved.distance_m == pytest.approx(1.75, abs=0.2)
    assert moved.place[0] < 4.0
    assert reason_after(zone, 100) is Reason.ARRIVED
    zone.set_goal("a", (1.0, 1.0))
    assert zone.moved("a") is None
    zone.close()


def test_a_strict_goal_is_refused() -> None:
    zone = navigator()
    zone.set_goal("a", (5.5, 6.0), strict=True)
    assert zone.moved("a") is not None
    assert reason_after(zone, 5) is Reason.NO_PATH
    zone.set_goal("a", (2.0, 6.0), strict=True)
    assert reason_after(zone, 60) is Reason.ARRIVED
    zone.close()


def test_a_population_explains_where_a_goal_was_moved() -> None:
    population = Population(LayeredGrid.from_scene(SCENE), SCENE, tick_s=0.1)
    for name, strict in (("lax", False), ("strict", True)):
        spec = {"kind": "go_to", "target": [5.5, 6.0, 0.0], "strict": strict}
        behaviour = BEHAVIOUR_SPEC.validate_python(spec).make()
        population.add(name, behaviour, None, (1.0, 5.0 if strict else 7.0))
    for _ in range(3):
        population.advance({})
    lax, strict = population.explain("lax"), population.explain("strict")
    assert lax.moved is not None
    assert "inside a wall or solid" in str(lax.moved)
    assert lax.reason is not Reason.NO_PATH
    assert strict.moved is not None
    assert strict.reason is Reason.NO_PATH
    population.close()


def test_find_path_tells_and_refuses() -> None:
    zone = navigator()
    start, near, inside = (1.0, 6.0, 0.0), (3.9, 6.0, 0.0), (4.3, 6.0, 0.0)
    path = find_path(zone.grid, start, near)
    assert (path.status, path.goal_moved) == (PathStatus.FOUND, None)
    path = find_path(zone.grid, start, (1.0, 1.0, 0.0), strict=True)
    assert (path.status, path.start_moved, path.goal_moved) == (PathStatus.FOUND, None, None)
    path = find_path(zone.grid, start, inside)
    if path.status is PathStatus.FOUND:
        assert path.goal_moved is not None
        assert path.goal_moved.reason is MoveReason.INSIDE_WALL
    refused = find_path(zone.grid, start, inside, strict=True)
    assert refused.status is PathStatus.GOAL_BLOCKED
    zone.close()

from esplanade.planning import LayeredGrid, Polygon, Portal, Scene, Spawn, Wall
from esplanade.planning.routes.portal_reach import unreached_portals

WEST = Portal(name="west", points=((1.0, 4.0), (2.0, 4.0), (2.0, 6.0), (1.0, 6.0)))
EAST = Portal(name="east", points=((8.0, 4.0), (9.0, 4.0), (9.0, 6.0), (8.0, 6.0)))
HALVES = Scene(
    bounds=(0.0, 0.0, 10.0, 10.0),
    walls=(Wall(start=(5.0, 0.0), end=(5.0, 10.0)),),
    portals=(WEST, EAST),
)
"""Two halves that a wall keeps apart, with a portal in each."""


def unreached(scene: Scene, *arrivals: tuple[float, float, float]) -> list[str]:
    return unreached_portals(LayeredGrid.from_scene(scene), scene, arrivals)


def test_portals_are_reached_from_the_spawns() -> None:
    spawns = (Spawn(position=(2.0, 8.0)), Spawn(position=(8.0, 8.0)))
    assert unreached(HALVES.model_copy(update={"spawns": spawns})) == []
    assert unreached(HALVES.model_copy(update={"spawns": spawns[:1]})) == ["east"]
    # One who comes out of a portal that is shut in gets nowhere: spawns count where there are any.
    scene = HALVES.model_copy(update={"spawns": spawns[:1]})
    assert unreached(scene, (8.5, 5.0, 0.0)) == ["east"]


def test_without_spawns_they_are_reached_from_where_people_arrive() -> None:
    assert unreached(HALVES, (8.5, 5.0, 0.0)) == ["west"]
    assert unreached(HALVES) == []


def test_a_portal_inside_a_wall_or_in_the_air_is_not_reached() -> None:
    block = Polygon(
        points=((7.5, 3.5), (9.5, 3.5), (9.5, 6.5), (7.5, 6.5)), height_m=3.0, kind="wall"
    )
    scene = HALVES.model_copy(update={"walls": (), "polygons": (block,)})
    assert unreached(scene) == ["east"]
    high = EAST.model_copy(update={"z_m": 4.0})
    assert unreached(HALVES.model_copy(update={"walls": (), "portals": (WEST, high)})) == ["east"]

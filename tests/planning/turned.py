"""Doors, flights, ramps and kerbs that are turned and moved, and who gets there.

The judge of plans is shapely: what is left of the bounds without obstacles that are widened by the
radius. Nothing is asked within 1.5 cm of the radius, where the answer may be either.
"""

import math

from hypothesis import assume
from hypothesis import strategies as st
from shapely import LineString, Point, Polygon, box, union_all

from esplanade.actors import ActorParameters, Navigator, Reason
from esplanade.planning import LayeredGrid, PlanModel, Scene
from esplanade.planning.routes.walking_route import RouteSearch, SharedWaves

SIDE_M = 9.0
BAND_M = 0.015
Pairs = list[tuple[float, float]]


class Turned:
    """A place in a scene that is turned and moved by a part of a cell."""

    def __init__(self, degrees: float, aside_m: tuple[float, float]) -> None:
        self._cos, self._sin = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        self._x, self._y = 0.5 * SIDE_M + aside_m[0], 0.5 * SIDE_M + aside_m[1]

    def at(self, along: float, across: float) -> tuple[float, float]:
        return (
            self._x + along * self._cos - across * self._sin,
            self._y + along * self._sin + across * self._cos,
        )

    def rectangle(self, a0: float, c0: float, a1: float, c1: float) -> Pairs:
        return [self.at(a, c) for a, c in ((a0, c0), (a1, c0), (a1, c1), (a0, c1))]


turns = st.builds(
    Turned,
    st.integers(0, 359).map(float),
    st.tuples(*[st.integers(-12, 12).map(lambda v: v / 100)] * 2),
)
radii = st.integers(20, 40).map(lambda v: v / 100)
slim_radii = st.integers(15, 40).map(lambda v: v / 100)


@st.composite
def doorways(draw) -> tuple[Scene, object, tuple[float, float], tuple[float, float], float]:
    """A wall across the scene with a door in it, a corridor, and perhaps a pillar beside."""
    turned, radius_m = draw(turns), draw(slim_radii)
    width = 2.0 * radius_m + draw(st.sampled_from([-0.1, -0.05, 0.04, 0.06, 0.1, 0.2]))
    thick = draw(st.sampled_from([0.0, 0.1, 0.3, 1.5]))
    half, far = 0.5 * width, 30.0
    rings, walls = [], []
    if thick:
        for a, b in ((-7.0, -half), (half, 7.0)):
            rings.append(turned.rectangle(-0.5 * thick, a, 0.5 * thick, b))
    else:
        walls = [(turned.at(0.0, -far), turned.at(0.0, -half))]
        walls.append((turned.at(0.0, half), turned.at(0.0, far)))
    if draw(st.booleans()):
        c, size = draw(st.integers(-8, 8)) / 10, draw(st.sampled_from([0.1, 0.4]))
        a = draw(st.integers(5, 15)) / 10 + 0.5 * thick
        rings.append(turned.rectangle(a, c, a + size, c + size))
    scene = Scene.model_validate(
        {
            "bounds": (0.0, 0.0, SIDE_M, SIDE_M),
            "walls": [{"start": a, "end": b, "height_m": 3.0} for a, b in walls],
            "polygons": [{"points": ring, "height_m": 3.0} for ring in rings],
        }
    )
    obstacles = union_all([*map(LineString, walls), *map(Polygon, rings)])
    return scene, obstacles, turned.at(-2.8, 0.0), turned.at(2.8, 0.0), radius_m


def leads_there(obstacles, start, goal, radius_m) -> bool:
    """Whether a disc gets from one point to another, and fits at both."""
    free = box(0.0, 0.0, SIDE_M, SIDE_M) - obstacles.buffer(radius_m, quad_segs=64)
    pieces = getattr(free, "geoms", [free])
    return any(piece.covers(Point(start)) and piece.covers(Point(goal)) for piece in pieces)


def expected(obstacles, start, goal, radius_m) -> bool:
    """The judge's answer; undecided examples are left out."""
    wide = leads_there(obstacles, start, goal, radius_m + BAND_M)
    assume(leads_there(obstacles, start, goal, radius_m - BAND_M) == wide)
    fits = Point(start).distance(obstacles), Point(goal).distance(obstacles)
    assume(min(fits) > radius_m + 0.6)
    return wide


def has_route(grid: LayeredGrid, start, goal, radius_m: float) -> bool:
    search = RouteSearch(SharedWaves(grid), start, goal, radius_m)
    while not search.advance():
        pass
    return search.route is not None


def arrives(scene: Scene, start, goal, radius_m: float, seconds: float = 40.0) -> bool:
    """Whether a live actor really gets there."""
    nav = Navigator(scene, tick_s=0.1, plan=PlanModel(threads=1))
    parameters = ActorParameters(radius_m=radius_m)
    nav.add_actor("a", start[:2], goal[:2], parameters, z_m=start[2], goal_z_m=goal[2])
    state = None
    for _ in range(int(seconds / 0.1)):
        nav.observe({})
        state = nav.tick()["a"]
        if state.reason in (Reason.ARRIVED, Reason.NO_PATH):
            break
    nav.close()
    return state is not None and state.reason is Reason.ARRIVED


def flight(turned: Turned, width: float) -> Scene:
    """Eight steps up to a floor."""
    return Scene.model_validate(
        {
            "bounds": (0.0, 0.0, SIDE_M, SIDE_M),
            "stairs": [
                {
                    "start": turned.at(-1.2, 0.0),
                    "end": turned.at(1.2, 0.0),
                    "width_m": width,
                    "top_m": 1.6,
                    "steps": 8,
                }
            ],
            "polygons": [
                {
                    "kind": "floor",
                    "height_m": 1.6,
                    "points": turned.rectangle(1.2, -1.2, 3.2, 1.2),
                }
            ],
        }
    )


def ramp(turned: Turned, width: float) -> Scene:
    """A slope up to a floor, 1.2 m above the ground."""
    half = 0.5 * width
    slope = {
        "kind": "floor",
        "height_m": 1.2,
        "points": turned.rectangle(-2.4, -half, 1.2, half),
        "ramp": {"start": turned.at(-2.4, 0.0), "end": turned.at(1.2, 0.0)},
    }
    floor = {"kind": "floor", "height_m": 1.2, "points": turned.rectangle(1.2, -1.2, 3.2, 1.2)}
    return Scene.model_validate({"bounds": (0.0, 0.0, SIDE_M, SIDE_M), "polygons": [slope, floor]})


def kerb(turned: Turned, height: float, depth: float) -> Scene:
    """A kerb all across the scene."""
    ring = turned.rectangle(-0.5 * depth, -9.0, 0.5 * depth, 9.0)
    solid = {"kind": "floor", "height_m": height, "points": ring}
    return Scene.model_validate({"bounds": (0.0, 0.0, SIDE_M, SIDE_M), "polygons": [solid]})

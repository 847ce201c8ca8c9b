"""Whether there is a way, by the four who answer that: tool, `scene check`, a person, an actor."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Final

from benchmarks._turned_scenes import Case, Point3

from esplanade.actors import ActorParameters, Navigator, Reason
from esplanade.planning import LayeredGrid, PathStatus, Place, PlanModel, Spawn, find_path
from esplanade.planning.routes.walking_route import Route, RouteSearch, SharedWaves
from esplanade.scenery.reach import reach_of

TICK_S: Final = 0.05
SPEED_MPS: Final = 1.4
ACTOR_TICK_S: Final = 0.1
NEAR_M: Final = 0.3
"""A body that ends so near to the goal has arrived."""
BLOCKED_TICKS: Final = 20
"""A body that gets nowhere for so long gives up, as people who follow a route do."""
HELD_UP_M: Final = 0.01
"""A body that gets no further so near to a corner goes on to the next, as people do."""
ROUNDING_M: Final = 1e-3
"""A body that is held up keeps so much less room, as people on routes do."""
_STEP_SHARE: Final = 0.1


def tool(grid: LayeredGrid, case: Case) -> bool:
    """Whether `find_path` finds the way there and the way back."""
    return all(
        find_path(grid, each.start, each.goal, each.body).status is PathStatus.FOUND
        for each in (case, case.back)
    )


def check(grid: LayeredGrid, case: Case) -> bool:
    """Whether `scene check` finds the goal from a spawn at the start, and the other way round."""
    for each in (case, case.back):
        spawn = Spawn(position=each.start[:2], z_m=each.start[2], radius_m=0.0)
        place = Place(name="goal", position=each.goal[:2], z_m=each.goal[2])
        scene = each.scene.model_copy(update={"spawns": (spawn,), "places": (place,)})
        if reach_of(grid, scene, each.body).places_missed:
            return False
    return True


def person(grid: LayeredGrid, case: Case) -> bool:
    """Whether `walk_to` finds the way, there and back, and who walks along it gets there."""
    for each in (case, case.back):
        route = route_of(grid, each)
        if route is None or not walks(grid, each, route):
            return False
    return True


def keys(grid: LayeredGrid, case: Case) -> bool:
    """Whether who walks straight to the goal gets there, and back."""
    return all(walks(grid, each, (each.goal,)) for each in (case, case.back))


def actor(grid: LayeredGrid, case: Case, back: bool = True) -> bool:
    """Whether a live actor gets there, and back."""
    return all(_arrives(grid, each) for each in ((case, case.back) if back else (case,)))


ANSWERS: Final[dict[str, Callable[[LayeredGrid, Case], bool]]] = {
    "tool": tool,
    "check": check,
    "person": person,
    "actor": actor,
}


def route_of(grid: LayeredGrid, case: Case) -> Route | None:
    """The route of a person who wants to walk to the goal."""
    search = RouteSearch(SharedWaves(grid), case.start, case.goal, case.body.radius_m)
    while not search.advance():
        pass
    return search.route


def walks(grid: LayeredGrid, case: Case, route: Route) -> bool:
    """Whether a person who is moved towards one point of a route after the other gets there."""
    x, y, z = case.start
    blocked, step = 0, SPEED_MPS * TICK_S
    for corner in route:
        while (left := math.dist((x, y), corner[:2])) > 1e-6:
            share = min(1.0, step / left)
            move = share * (corner[0] - x), share * (corner[1] - y)
            room_m = case.body.radius_m - (ROUNDING_M if blocked else 0.0)
            places, heights = grid.walk([(x, y)], [z], [move], room_m)
            moved = math.dist((x, y), places[0])
            (x, y), z = places[0].tolist(), float(heights[0])
            blocked = blocked + 1 if moved < _STEP_SHARE * share * left else 0
            if blocked >= BLOCKED_TICKS:
                return False
            if blocked and math.dist((x, y), corner[:2]) < HELD_UP_M:
                break
    return _is_near((x, y, z), case.goal)


def _arrives(grid: LayeredGrid, case: Case) -> bool:
    nav = Navigator(grid, tick_s=ACTOR_TICK_S, plan=PlanModel(threads=1))
    body = case.body
    parameters = ActorParameters(radius_m=body.radius_m, edge_cells=body.edge_cells)
    (x, y, z), (gx, gy, gz) = case.start, case.goal
    nav.add_actor("a", (x, y), (gx, gy), parameters, z_m=z, goal_z_m=gz)
    state = nav.state("a")
    patience_s = 20.0 + 4.0 * math.dist((x, y), (gx, gy))
    for _ in range(int(patience_s / ACTOR_TICK_S)):
        nav.observe({})
        state = nav.tick()["a"]
        if state.reason in (Reason.ARRIVED, Reason.NO_PATH):
            break
    nav.close()
    place = (*state.position, state.z_m)
    return state.reason is Reason.ARRIVED and _is_near(place, case.goal)


def _is_near(place: Point3, goal: Point3) -> bool:
    return math.dist(place[:2], goal[:2]) <= NEAR_M and abs(place[2] - goal[2]) <= NEAR_M

"""Routes for people who want to walk to a point: a few straight legs around obstacles."""

from esplanade.planning import LayeredGrid
from esplanade.planning.routes.walking_route import Point, Route, RouteSearch, SharedWaves

__all__ = ["Point", "Route", "RouteSearch", "SharedWaves", "find_route"]


def find_route(grid: LayeredGrid, start: Point, goal: Point, clearance_m: float) -> Route | None:
    """A shortest route to the free place nearest to the goal; None where there is no route.

    It is a whole `RouteSearch`; cost O(cells nearer to the goal than the start).
    """
    search = RouteSearch(SharedWaves(grid), start, goal, clearance_m)
    while not search.advance():
        pass
    return search.route

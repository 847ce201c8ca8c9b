"""Figs. 10 and 11 of Lei & Li: scenes, ways of people, and the actor's; tests walk them too."""

from collections.abc import Callable, Mapping
from typing import Final, NamedTuple

import numpy as np

from esplanade.planning import Polygon, Scene

Point = tuple[float, float]
Walk = Callable[[float], Point]


class Figure(NamedTuple):
    """One experiment: people change their goals while the actor is on its way."""

    scene: Scene
    start: Point
    goal: Point
    people: Mapping[str, Walk]
    seconds: float


def block(x0: float, y0: float, x1: float, y1: float) -> Polygon:
    """A building with walls along the axes."""
    return Polygon(points=((x0, y0), (x1, y0), (x1, y1), (x0, y1)), height_m=3.0)


def along(*corners: Point, speed_mps: float = 1.2) -> Walk:
    """A person who walks from corner to corner and stays at the last; seconds -> (x, y)."""
    points = np.array(corners)
    walked = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])

    def at(seconds: float) -> Point:
        way = speed_mps * seconds
        return (
            float(np.interp(way, walked, points[:, 0])),
            float(np.interp(way, walked, points[:, 1])),
        )

    return at


def _scene(*buildings: Polygon) -> Scene:
    return Scene.open_space((0.0, 0.0, 20.0, 16.0), polygons=buildings)


FIG_10: Final = Figure(
    _scene(block(3, 10, 7, 13), block(13, 3, 16, 6)),
    start=(10.0, 2.0),
    goal=(10.0, 14.0),
    people={"0": along((4.2, 8.0), (8.8, 8.0), (10.6, 13.5), speed_mps=1.2)},
    seconds=16.0,
)
"""A person comes from the left, and turns where it would pass in front: into the actor's way."""

FIG_11: Final = Figure(
    _scene(block(3, 10, 6, 13), block(9, 7, 11, 9), block(14, 3, 16, 5)),
    start=(18.0, 2.0),
    goal=(3.0, 15.0),
    people={
        "0": along((2.0, 3.0), (8.0, 4.0), (17.0, 8.0), speed_mps=1.1),
        "1": along((18.0, 12.0), (12.0, 11.0), (12.0, 4.0), (4.0, 2.0), speed_mps=1.2),
        "2": along((7.0, 14.0), (8.0, 10.5), (15.0, 12.0), speed_mps=1.0),
    },
    seconds=25.0,
)

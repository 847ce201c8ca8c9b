"""Small worlds that the actors' tests are set in, and a way to run them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from hypothesis import settings
from numpy.typing import NDArray

from esplanade.actors import ActorParameters, Navigator, Reason
from esplanade.planning import Place, PlanModel, Polygon, Scene

TICK_S = 0.1
BODY = ActorParameters(radius_m=0.25, speed_mps=1.3, max_speed_mps=1.7, max_acceleration_mps2=2.0)

Point = tuple[float, float]
Walk = Callable[[float], tuple[float, ...]]


def holds(examples: int) -> settings:
    """Settings for this many examples, the same in every run."""
    return settings(max_examples=examples, deadline=None, derandomize=True)


def block(x0: float, y0: float, x1: float, y1: float) -> Polygon:
    """A building with walls along the axes."""
    return Polygon(points=((x0, y0), (x1, y0), (x1, y1), (x0, y1)), height_m=3.0)


def plaza() -> Scene:
    """Open ground with three places."""
    places = {"gate": (2.0, 2.0), "fountain": (10.0, 2.0), "stage": (6.0, 10.0)}
    return Scene(
        bounds=(0.0, 0.0, 12.0, 12.0),
        places=tuple(Place(name=name, position=where) for name, where in places.items()),
    )


def navigator(scene: Scene, *, threads: int = 1, tick_s: float = TICK_S, seed: int = 0):
    """A navigator whose threads end with the test run; one thread is gentlest."""
    return Navigator(scene, tick_s=tick_s, seed=seed, plan=PlanModel(threads=threads))


def along(*corners: Point, speed_mps: float = 1.2) -> Walk:
    """A person who walks from corner to corner and stays at the last; seconds -> (x, y)."""
    points = np.array(corners)
    lengths = np.hypot(*np.diff(points, axis=0).T)
    walked = np.concatenate([[0.0], np.cumsum(lengths)])

    def at(seconds: float) -> Point:
        way = speed_mps * seconds
        return (
            float(np.interp(way, walked, points[:, 0])),
            float(np.interp(way, walked, points[:, 1])),
        )

    return at


@dataclass
class Record:
    """A run: per actor positions (T, 2), heights (T,) and reasons; per person positions (T, 2)."""

    positions: dict[str, NDArray[np.float64]] = field(default_factory=dict)
    heights: dict[str, NDArray[np.float64]] = field(default_factory=dict)
    reasons: dict[str, list[Reason]] = field(default_factory=dict)
    people: dict[str, NDArray[np.float64]] = field(default_factory=dict)

    def arrival_s(self, actor: str) -> float:
        """The time at which an actor first said that it had arrived; inf if never."""
        if Reason.ARRIVED not in self.reasons[actor]:
            return math.inf
        return TICK_S * (1 + self.reasons[actor].index(Reason.ARRIVED))

    def sideways(self, actor: str, y: float) -> float:
        """Largest distance from a line along x, metres."""
        return float(np.abs(self.positions[actor][:, 1] - y).max())

    def nearest_person(self, actor: str) -> float:
        """Smallest distance of centres from anyone, metres."""
        ways = [np.hypot(*(self.positions[actor] - p).T) for p in self.people.values()]
        return float(np.min(ways))

    def nearest_actors(self) -> float:
        """Smallest distance of centres among actors, metres."""
        tracks = np.stack(list(self.positions.values()))
        away = np.hypot(*np.moveaxis(tracks[:, None] - tracks[None], -1, 0))
        return float(away[~np.eye(len(tracks), dtype=bool)].min())


def run(nav: Navigator, seconds: float, people: Mapping[str, Walk] | None = None) -> Record:
    """Run a zone and note everything down."""
    record = Record()
    positions: dict[str, list[Point]] = {}
    heights: dict[str, list[float]] = {}
    seen: dict[str, list[tuple[float, ...]]] = {name: [] for name in people or {}}
    for k in range(round(seconds / nav.tick_s)):
        now = {name: walk(k * nav.tick_s) for name, walk in (people or {}).items()}
        nav.observe(now)
        for name, where in now.items():
            seen[name].append(where[:2])
        for actor, state in nav.tick().items():
            positions.setdefault(str(actor), []).append(state.position)
            heights.setdefault(str(actor), []).append(state.z_m)
            record.reasons.setdefault(str(actor), []).append(state.reason)
    record.positions = {name: np.array(track) for name, track in positions.items()}
    record.heights = {name: np.array(levels) for name, levels in heights.items()}
    record.people = {name: np.array(track) for name, track in seen.items()}
    return record

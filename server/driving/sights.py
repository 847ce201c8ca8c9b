"""The view that a policy has of a served zone: its trip, and its actor's sight at a tick."""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from esplanade.actors import ActorParameters
from esplanade.planning.scene.heights import SAME_FLOOR_M
from esplanade.policies.errors import PolicyFaultError
from esplanade.policies.interface import Observation, Person, Task
from esplanade.server.driving.tracks import Tracks
from esplanade.server.world.routes import Point
from esplanade.server.world.zone import Zone

SEEN_M: Final = 15.0
"""As in episodes of `esplanade evaluate`."""
MOST_SEEN: Final = 24
"""So many others are told, the nearest ones: with their past they are a message of some 30 kB."""


class Sights:
    """Tells policies of a zone. Ask it between two ticks only."""

    def __init__(self, zone: Zone, every_s: float) -> None:
        """`every_s` is the time from one sight to the next, seconds."""
        self._zone = zone
        self._every_s = every_s
        self.tracks = Tracks(zone.state, every_s)

    def task(self, actor_id: str, goal: Point) -> Task:
        """The trip of an actor from where it is to a goal."""
        parameters = self._zone.parameters(actor_id)
        x, y, z_m = self.place(actor_id)
        x0, y0, x1, y1 = self._zone.grid.bounds
        return Task(
            tick_s=self._every_s,
            start=np.array([x, y]),
            goal=np.array(goal[:2]),
            goal_tolerance=parameters.goal_tolerance_m,
            radius=parameters.radius_m,
            preferred_speed=parameters.speed_mps,
            greatest_speed=parameters.max_speed_mps,
            greatest_acceleration=parameters.max_acceleration_mps2,
            walls=self._walls(z_m, parameters),
            bounds=(x0, y0, x1, y1),
        )

    def observation(self, actor_id: str, goal: Point, begun_tick: int) -> Observation:
        """The sight of an actor that set out to its goal in that tick; cost O(people near)."""
        zone, state = self._zone, self._zone.state
        own = state.slot(self._avatar(actor_id))
        here = state.positions[own]
        live = state.live()
        away = np.hypot(*(state.positions[live] - here).T)
        near = (away <= SEEN_M) & (live != own)
        near &= np.abs(state.heights[live] - state.heights[own]) < SAME_FLOOR_M
        nearest = live[near][np.argsort(away[near], kind="stable")[:MOST_SEEN]]
        track = self.tracks.of(own)
        waypoint = zone.waypoint(actor_id) or goal[:2]
        return Observation(
            (zone.tick - begun_tick) * zone.tick_s,
            here.copy(),
            _velocity(track, self._every_s),
            np.array(goal[:2]),
            np.array(waypoint[:2]),
            [self._person(slot) for slot in nearest.tolist()],
        )

    def is_there(self, actor_id: str) -> bool:
        """Whether an actor is in the world; one that comes is from the next tick on."""
        return self._zone.avatar_of(actor_id) is not None

    def goal(self, actor_id: str) -> Point | None:
        """The place to which an actor is on its way; None if it is on none."""
        return self._zone.goal_of(actor_id)

    def check_goal(self, goal: Point) -> None:
        """PolicyFaultError unless actors can be sent to a place."""
        x0, y0, x1, y1 = self._zone.grid.bounds
        if not (x0 <= goal[0] <= x1 and y0 <= goal[1] <= y1):
            raise PolicyFaultError(f"its goal ({goal[0]:g}, {goal[1]:g}) is outside of the scene")

    def place(self, actor_id: str) -> Point:
        """The place where an actor stands."""
        return self._zone.where(self._avatar(actor_id))

    def _person(self, slot: int) -> Person:
        state, track = self._zone.state, self.tracks.of(slot)
        velocity = _velocity(track, self._every_s)
        return Person(int(state.ids[slot]), track[-1], velocity, float(state.radii[slot]), track)

    def _avatar(self, actor_id: str) -> int:
        avatar = self._zone.avatar_of(actor_id)
        if avatar is None:
            raise KeyError(f"there is no actor {actor_id}")
        return avatar

    def _walls(self, z_m: float, parameters: ActorParameters) -> NDArray[np.float64]:
        """The barriers that stop an actor on a floor at that height, float64 (M, 2, 2)."""
        barriers = self._zone.grid.index.barriers
        step_m = parameters.body.step_on_m
        stops = (barriers["bottom_m"] < z_m + parameters.body.height_m) & (
            np.minimum(barriers["top_m"] - z_m, barriers["climb_m"]) > step_m
        )
        found = barriers[stops]
        ends = [found["x0"], found["y0"], found["x1"], found["y1"]]
        return np.stack(ends, axis=-1).reshape(-1, 2, 2)


def _velocity(track: NDArray[np.float64], tick_s: float) -> NDArray[np.float64]:
    return (track[-1] - track[-2]) / tick_s if len(track) > 1 else np.zeros(2)

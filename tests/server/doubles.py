"""A population whose actors do as a test says."""

from collections.abc import Hashable, Mapping
from typing import cast

import numpy as np

from esplanade.actors import ActorState, Explanation, Population, Reason

Place = tuple[float, float, int]


class ScriptedPopulation:
    """Actors that stand where they were put and move at the velocity they were given."""

    def __init__(self, tick_s: float = 0.05) -> None:
        self.tick_s = tick_s
        self.positions: dict[Hashable, tuple[float, float]] = {}
        self.velocities: dict[Hashable, tuple[float, float]] = {}
        self.pointing: dict[Hashable, tuple[float, float, float]] = {}
        self.doors_wanted: dict[str, bool] = {}
        self.observed: Mapping[Hashable, Place] = {}
        self.trips = 0
        self.failing = False
        self.found_anew = 0

    def put(
        self,
        actor_id: Hashable,
        position: tuple[float, float],
        velocity: tuple[float, float] = (0.0, 0.0),
    ) -> None:
        self.positions[actor_id] = position
        self.velocities[actor_id] = velocity

    def __len__(self) -> int:
        return len(self.positions)

    def tick(self, people: Mapping[Hashable, Place]) -> dict[Hashable, ActorState]:
        if self.failing:
            raise RuntimeError("told to fail")
        self.observed = people
        states = {}
        for actor_id, (x, y) in self.positions.items():
            vx, vy = self.velocities[actor_id]
            here = (x + vx * self.tick_s, y + vy * self.tick_s)
            self.positions[actor_id] = here
            states[actor_id] = ActorState(
                position=here,
                layer=0,
                z_m=0.0,
                velocity=(vx, vy),
                heading=float(np.arctan2(vy, vx)),
                reason=Reason.MOVING,
                goal=None,
                slice_s=0.4,
                way=np.array([(*here, 0.0)]),
                points_at=self.pointing.get(actor_id),
            )
        return states

    def ground_changed(self) -> None:
        self.found_anew += 1

    def explain(self, actor_id: Hashable) -> Explanation:
        x, y = self.positions[actor_id]
        path = np.array([[x, y, 0.0, 0.0], [x + 1.0, y, 0.0, 0.4]])
        people = [np.array([[px, py, pz, 0.5]]) for px, py, pz in self.observed.values()]
        return Explanation("patrol", Reason.MOVING, (x + 1.0, y, 0), path, people)

    def as_population(self) -> Population:
        return cast(Population, self)

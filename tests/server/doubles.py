"""A population whose actors do as a test says."""

from collections.abc import Hashable, Mapping
from types import SimpleNamespace
from typing import cast

import numpy as np
from numpy.typing import NDArray

from esplanade.actors import ActorParameters, Explanation, Population, Reason
from esplanade.actors.tours import Saying
from esplanade.planning import AgentTable

Place = tuple[float, float, float]


class ScriptedPopulation:
    """Actors that stand where they were put and move at the velocity they were given."""

    def __init__(self, tick_s: float = 0.05) -> None:
        self.tick_s = tick_s
        self.table = AgentTable(1)
        self.navigator = SimpleNamespace(plan=SimpleNamespace(slice_s=0.4))
        self.positions: dict[Hashable, tuple[float, float]] = {}
        self.velocities: dict[Hashable, tuple[float, float]] = {}
        self.pointed_at: dict[Hashable, Place] = {}
        self.doors_wanted: dict[str, bool] = {}
        self.said: list[tuple[Hashable, Saying]] = []
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
        if actor_id not in self.table:
            nothing = np.zeros(1, dtype=np.int64)
            self.table.add(
                [actor_id],
                np.array([(*position, 0.0)]),
                ActorParameters().row()[None],
                cells=nothing - 1,
                layers=nothing,
                headings=np.zeros(1),
            )

    def __len__(self) -> int:
        return len(self.positions)

    def advance(self, people: Mapping[Hashable, Place]) -> None:
        if self.failing:
            raise RuntimeError("told to fail")
        self.observed = people
        for actor_id, (x, y) in self.positions.items():
            vx, vy = self.velocities[actor_id]
            here = (x + vx * self.tick_s, y + vy * self.tick_s)
            self.positions[actor_id] = here
            row, agents = self.table.row(actor_id), self.table.agents
            agents.positions[row] = here
            agents.velocities[row] = vx, vy
            agents.headings[row] = np.arctan2(vy, vx)
            agents.reasons[row] = Reason.MOVING
            agents.planned[row] = (*here, 0.0)

    def facing(self) -> NDArray[np.float64]:
        return self.table.agents.headings

    def pointing(self) -> dict[Hashable, Place]:
        return self.pointed_at

    def ground_changed(self, *, renewed_outside: bool = False) -> None:
        self.found_anew += 1
        self.renewed_outside = renewed_outside

    def derive_outside(self) -> None:
        pass

    def outdated_potential(self) -> None:
        return None

    def explain(self, actor_id: Hashable) -> Explanation:
        x, y = self.positions[actor_id]
        path = np.array([[x, y, 0.0, 0.0], [x + 1.0, y, 0.0, 0.4]])
        people = [np.array([[px, py, pz, 0.5]]) for px, py, pz in self.observed.values()]
        return Explanation("patrol", Reason.MOVING, (x + 1.0, y, 0), path, people)

    def as_population(self) -> Population:
        return cast(Population, self)

"""Space-time A* among moving discs, the common part of the policies `discs` and `oracle`."""

from abc import abstractmethod
from typing import Final

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.policies import _space_time_kernels as kernels
from esplanade.evaluation.policies.policy import DebugInfo, Observation, Policy, Task

Floats = NDArray[np.float64]

STEP_S: Final = 0.4
STEPS: Final = 14
MAX_NODES: Final = 12_000
DIRECTIONS: Final = 16
WALL_M: Final = 0.27
"""The smallest allowed distance of the robot's centre to walls."""
UNLIMITED_MPS2: Final = 100.0
"""The limit of acceleration where the rules have none."""


class SpaceTimeSearch(Policy):
    """A policy that plans anew at every tick, with A* over positions and times."""

    margins_m: tuple[float, ...]
    """The distances kept to people beyond contact; each is tried if the one before finds no
    path."""
    margin_lost_mps: float
    """The margin shrinks by this much for each second ahead, down to zero."""

    def __init__(self) -> None:
        angles = np.arange(DIRECTIONS) * (2.0 * np.pi / DIRECTIONS)
        self._directions = np.column_stack([np.cos(angles), np.sin(angles)])
        self._nodes = kernels.Nodes(
            np.zeros((MAX_NODES, 4)),
            np.zeros(MAX_NODES),
            np.zeros(MAX_NODES, dtype=np.int64),
            np.zeros(MAX_NODES, dtype=np.int64),
            np.zeros((MAX_NODES, 2)),
            np.zeros(MAX_NODES),
            np.zeros(MAX_NODES, dtype=np.int64),
            np.zeros((4 * MAX_NODES, 2), dtype=np.int64),
        )

    def reset(self, task: Task) -> None:
        self._task = task
        self._path = np.zeros((0, 2))
        speed_mps = task.rules.speed_mps
        self._speeds = np.array([speed_mps, 0.5 * speed_mps])

    @abstractmethod
    def futures(self, observation: Observation) -> Floats:
        """The positions of P people now and at each step ahead, (P, STEPS + 1, 2), metres.

        They are nan where a person is absent.
        """

    def decide(self, observation: Observation) -> Floats:
        tracks = self.futures(observation)
        for margin_m in self.margins_m:
            node, _ = kernels.search(
                self._problem(observation, tracks, margin_m),
                self._directions,
                self._speeds,
                self._nodes,
            )
            if node > 0:
                return self._follow(node)
        self._path = np.stack([observation.position])
        return np.zeros(2)

    def debug_info(self) -> DebugInfo:
        return DebugInfo(path=self._path)

    def _problem(
        self, observation: Observation, tracks: Floats, margin_m: float
    ) -> kernels.Problem:
        rules = self._task.rules
        ahead_s = np.arange(STEPS + 1) * STEP_S
        margins_m = np.maximum(margin_m - self.margin_lost_mps * ahead_s, 0.0)
        return kernels.Problem(
            *_pair(observation.position),
            *_pair(observation.velocity),
            *_pair(observation.waypoint),
            0.8 * rules.goal_tolerance_m,
            rules.speed_mps,
            rules.max_acceleration_mps2 or UNLIMITED_MPS2,
            STEP_S,
            np.ascontiguousarray(tracks),
            rules.contact_m + margins_m,
            self._task.obstacles.outline,
            WALL_M,
        )

    def _follow(self, node: int) -> Floats:
        """The first velocity of the path to a node; the path is kept for drawing."""
        path = [node]
        while (parent := int(self._nodes.parents[path[-1]])) >= 0:
            path.append(parent)
        self._path = self._nodes.places[path[::-1], :2].copy()
        return np.array(self._nodes.wanted[path[-2]])


def _pair(values: Floats) -> tuple[float, float]:
    return float(values[0]), float(values[1])

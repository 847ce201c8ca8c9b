"""Search in space and time among moving discs: what `discs` and `clairvoyant` have in common."""

from abc import abstractmethod
from typing import Final

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.policies import _space_time_kernels as kernels
from esplanade.evaluation.policies.policy import Policy, Task, Thoughts, View

Floats = NDArray[np.float64]

STEP_S: Final = 0.4
STEPS: Final = 14
MAX_NODES: Final = 12_000
DIRECTIONS: Final = 16
WALL_M: Final = 0.27
UNLIMITED_MPS2: Final = 100.0


class SpaceTimeSearch(Policy):
    """A* over places and times with hard discs, anew at every tick."""

    margins_m: tuple[float, ...]
    """Room kept to people beyond contact; the next one is tried when there is no way at all."""
    margin_lost_mps: float
    """How fast that room shrinks to nothing for times ahead."""

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
    def futures(self, view: View) -> Floats:
        """Where people are now and at each step ahead, (P, STEPS + 1, 2); nan where absent."""

    def decide(self, view: View) -> Floats:
        tracks = self.futures(view)
        for margin_m in self.margins_m:
            node, _ = kernels.search(
                self._problem(view, tracks, margin_m), self._directions, self._speeds, self._nodes
            )
            if node > 0:
                return self._follow(node)
        self._path = np.stack([view.position])
        return np.zeros(2)

    def thoughts(self) -> Thoughts:
        return Thoughts(path=self._path)

    def _problem(self, view: View, tracks: Floats, margin_m: float) -> kernels.Problem:
        rules = self._task.rules
        ahead_s = np.arange(STEPS + 1) * STEP_S
        margins_m = np.maximum(margin_m - self.margin_lost_mps * ahead_s, 0.0)
        return kernels.Problem(
            *_pair(view.position),
            *_pair(view.velocity),
            *_pair(view.waypoint),
            0.8 * rules.goal_tolerance_m,
            rules.speed_mps,
            rules.max_acceleration_mps2 or UNLIMITED_MPS2,
            STEP_S,
            np.ascontiguousarray(tracks),
            rules.contact_m + margins_m,
            self._task.replay.obstacles.outline,
            WALL_M,
        )

    def _follow(self, node: int) -> Floats:
        """The first move of the way to a node; keeps the way for drawing."""
        way = [node]
        while (parent := int(self._nodes.parents[way[-1]])) >= 0:
            way.append(parent)
        self._path = self._nodes.places[way[::-1], :2].copy()
        return np.array(self._nodes.wanted[way[-2]])


def _pair(values: Floats) -> tuple[float, float]:
    return float(values[0]), float(values[1])

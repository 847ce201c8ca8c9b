"""Best-first search in CT-space, Lei & Li, fig. 5, with lists and dictionaries."""

from __future__ import annotations

import heapq
import math
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from esplanade.planning import LayeredGrid, Potential, RiskField, SearchStatus
from esplanade.planning.agents._branch_kernels import Moves
from esplanade.planning.agents._reservation_kernels import Reservations
from esplanade.planning.agents._task_kernels import Task, advance, risk_price, time_cost, wall_cost
from tests.naive.floors import SLACK_M
from tests.naive.geometry import Point
from tests.naive.reservations import conflict

MARGIN_M = 0.03
DEPTH_BONUS_S = 0.01
LIKELY_PART = 0.7
FINE_STEPS = 4


@dataclass(frozen=True)
class Ground:
    """Everything that a path is judged by, one question at a time."""

    grid: LayeredGrid
    field: RiskField
    potential: Potential
    reservations: Reservations
    task: Task
    step_s: float

    def cell(self, p: Point) -> tuple[int, int]:
        return int(p[1] / self.grid.cell_m), int(p[0] / self.grid.cell_m)

    def clearance(self, p: Point) -> float:
        return float(self.grid.clearance([p], [0.0])[0])

    def needed(self) -> float:
        here = max(0.0, self.clearance((self.task.x, self.task.y)))
        return min(self.task.radius_m - SLACK_M, here) - 1e-6

    def metres_left(self, p: Point) -> float:
        if self.task.hold:
            return math.dist(p, (self.task.goal_x, self.task.goal_y))
        return float(self.potential.distance([p], [0.0])[0])

    def seconds_left(self, p: Point, speed: float = math.inf) -> float:
        t = self.task
        if t.hold:
            return 0.0
        metres = self.metres_left(p)
        lacking = max(0.0, t.speed_mps - speed) if metres > t.speed_mps else 0.0
        accelerating = lacking**2 / (2.0 * t.max_acceleration_mps2 * t.speed_mps)
        return metres / t.speed_mps + accelerating + t.turn_weight * lacking

    def risk(self, k: int, p: Point, v: Point) -> float:
        return float(self.field.at(k, [p], [0.0], [v], self.task.closing_weight)[0])

    def meeting(self, k: int, a: Point, b: Point) -> tuple[bool, int]:
        return conflict(self.reservations, MARGIN_M, self.task.me, 0.0, k, a, b)

    def heading_home(self, p: Point) -> Point:
        if self.task.hold:
            away = (self.task.goal_x - p[0], self.task.goal_y - p[1])
            return away if math.hypot(*away) > 1e-9 else (1.0, 0.0)
        down = self.potential.direction([p], [0.0])[0]
        return (down[0], down[1]) if down.any() else (1.0, 0.0)


@dataclass(frozen=True)
class Node:
    step: int
    place: Point
    velocity: Point
    cost: float
    worth: float
    parent: int
    middle: Point


@dataclass(frozen=True)
class Known:
    """A path that has become illegal, the number of its steps that are legal, and what it costs."""

    path: NDArray[np.float64]
    legal_steps: int
    cost: float


def search(
    ground: Ground,
    moves: Moves,
    steps: int,
    accumulate: bool,
    bound: float = math.inf,
    known: Known | None = None,
) -> tuple[SearchStatus, NDArray[np.float64], int]:
    """Status, positions half a step apart, and how many nodes were expanded."""
    task = ground.task
    start = (task.x, task.y)
    nodes = [Node(0, start, (task.vx, task.vy), 0.0, 0.0, -1, start)]
    if math.isinf(ground.seconds_left(start)):
        return SearchStatus.NO_PATH, _trace(nodes, 0, steps), 0
    left = ground.seconds_left(start, math.hypot(task.vx, task.vy))
    queue = [(left, 0)]
    bonus = _bonus(left, steps, bound, known)
    best: dict[tuple[int, tuple[int, int]], float] = {}
    for n in range(1, known.legal_steps + 1 if known else 0):
        node = _known_node(ground, nodes[-1], n, known.path)
        best[n, ground.cell(node.place)] = node.worth
        heapq.heappush(queue, (node.worth - bonus * n, n))
        nodes.append(node)
    furthest = (0, math.inf, 0)
    expansions = 0
    while queue:
        key, n = heapq.heappop(queue)
        node = nodes[n]
        at = (node.step, ground.cell(node.place))
        if n and accumulate and best[at] < node.worth - 1e-12:
            continue
        furthest = min(furthest, (-node.step, key, n))
        home = ground.metres_left(node.place) <= task.goal_tolerance_m
        if node.step == steps or (home and not accumulate and not task.hold):
            return SearchStatus.FOUND, _trace(nodes, n, steps), expansions
        if expansions == task.max_expansions:
            return SearchStatus.PARTIAL, _trace(nodes, furthest[2], steps), expansions
        expansions += 1
        for wish in _wishes(ground, moves, node):
            made = _move(ground, node, n, wish, accumulate)
            if made is None:
                continue
            child, key = made
            if accumulate:
                key -= bonus * child.step
                if child.worth + bonus * (steps - child.step) >= bound:
                    continue
            at = (child.step, ground.cell(child.place))
            if at in best and (not accumulate or child.worth >= best[at] - 1e-12):
                continue
            best[at] = child.worth
            heapq.heappush(queue, (key, len(nodes)))
            nodes.append(child)
    status = SearchStatus.PARTIAL if furthest[0] < 0 else SearchStatus.NO_PATH
    return status, _trace(nodes, furthest[2], steps), expansions


def _bonus(left: float, steps: int, bound: float, known: Known | None) -> float:
    """Seconds that each step is expected to cost beyond its time."""
    if bound < math.inf:
        return max(DEPTH_BONUS_S, LIKELY_PART * (bound - left) / steps)
    if known is not None and math.isfinite(known.cost):
        return max(DEPTH_BONUS_S, (known.cost - left) / steps)
    return DEPTH_BONUS_S


def _wishes(ground: Ground, moves: Moves, node: Node) -> list[Point]:
    """Velocities to turn into: the moves, straight on no further than the goal, and staying.

    Far ahead there are only the coarse ones.
    """
    away = ground.metres_left(node.place)
    x, y = ground.heading_home(node.place) if moves.relative else (1.0, 0.0)
    ahead = math.atan2(y, x)
    wishes = []
    many = len(moves.speeds) if node.step < FINE_STEPS else moves.coarse
    for m, speed in enumerate(moves.speeds.tolist()[:many]):
        turn = math.atan2(moves.sines[m], moves.cosines[m])
        v = min(speed, away / ground.step_s) if m < moves.straight else speed
        wishes.append((v * math.cos(ahead + turn), v * math.sin(ahead + turn)))
    return [*wishes, (0.0, 0.0)]


def _move(
    ground: Ground, node: Node, n: int, wish: Point, accumulate: bool
) -> tuple[Node, float] | None:
    """The node after one step and its key; None when the move is not possible."""
    task, half = ground.task, ground.step_s / 2
    a_max = task.max_acceleration_mps2
    *middle, _, _ = advance(*node.place, *node.velocity, *wish, a_max, half)
    *end, ux, uy = advance(*node.place, *node.velocity, *wish, a_max, ground.step_s)
    room = min(ground.clearance(tuple(middle)), ground.clearance(tuple(end)))
    if room < ground.needed() or math.isinf(left := ground.seconds_left(tuple(end))):
        return None
    blocked, priced = _priced_step(ground, node, tuple(middle), tuple(end), accumulate)
    if blocked:
        return None
    made = (node.step + 1, tuple(end), (ux, uy))
    if not accumulate:
        return Node(*made, 0.0, 0.0, n, tuple(middle)), left + priced
    cost = node.cost + priced
    speed = math.dist(middle, end) / half
    worth = cost + ground.seconds_left(tuple(end), speed)
    return Node(*made, cost, worth, n, tuple(middle)), worth


def _priced_step(
    ground: Ground, node: Node, middle: Point, end: Point, accumulate: bool = True
) -> tuple[bool, float]:
    """Whether others forbid a step, and what it costs; only its risk with the printed key."""
    task, half, k = ground.task, ground.step_s / 2, 2 * node.step
    (bx, by), (vx, vy), (wx, wy) = _velocities(ground, node, middle, end)
    meetings = [
        ground.meeting(k, node.place, middle),
        ground.meeting(k + 1, middle, end),
    ]
    if any(blocked for blocked, _ in meetings):
        return True, math.inf
    minded = sum(soft for _, soft in meetings)
    minded += ground.risk(k + 1, middle, (vx, vy)) + ground.risk(k + 2, end, (wx, wy))
    left_m = ground.metres_left(node.place)
    priced = risk_price(task, node.step * ground.step_s, left_m) * half * minded
    if not accumulate:
        return False, priced
    room = min(ground.clearance(middle), ground.clearance(end))
    speed = math.dist(node.place, end) / ground.step_s
    turned = math.dist((bx, by), (vx, vy)) + math.dist((vx, vy), (wx, wy))
    seconds = time_cost(task, ground.metres_left(end), speed, ground.step_s)
    walls = wall_cost(task, room, ground.step_s)
    return False, seconds + priced + task.turn_weight * turned + walls


def _known_node(ground: Ground, node: Node, n: int, path: NDArray[np.float64]) -> Node:
    """The node after a legal step of a path; its velocity is the mean one of the second half."""
    middle, end = (tuple(place) for place in path[2 * n - 1 : 2 * n + 1])
    _, priced = _priced_step(ground, node, middle, end)
    velocity = tuple(np.subtract(end, middle) / (ground.step_s / 2))
    cost = node.cost + priced
    worth = cost + ground.seconds_left(end, math.hypot(*velocity))
    return Node(n, end, velocity, cost, worth, n - 1, middle)


def _velocities(ground: Ground, node: Node, middle: Point, end: Point) -> list[Point]:
    """Those before a step, in its first half, and in its second, as places tell them."""
    places = [node.middle, node.place, middle, end]
    found = [tuple(np.subtract(b, a) / (ground.step_s / 2)) for a, b in pairwise(places)]
    return found if node.step else [node.velocity, *found[1:]]


def _trace(nodes: list[Node], n: int, steps: int) -> NDArray[np.float64]:
    places: list[Point] = [nodes[n].place]
    while nodes[n].parent >= 0:
        places += [nodes[n].middle, nodes[nodes[n].parent].place]
        n = nodes[n].parent
    places.reverse()
    return np.array(places + places[-1:] * (2 * steps + 1 - len(places)))


def path_cost(ground: Ground, path: NDArray[np.float64]) -> tuple[float, float]:
    """Cost of a whole path as the search counts it, and its mean risk."""
    task, ds = ground.task, ground.step_s / 2
    velocities = [(task.vx, task.vy), *map(tuple, np.diff(path, axis=0) / ds)]
    cost, risks = 0.0, []
    for k, (a, b) in enumerate(pairwise(path)):
        risks.append(ground.risk(k + 1, tuple(b), velocities[k + 1]))
        soft = ground.meeting(k, tuple(a), tuple(b))[1]
        left_m = ground.metres_left(tuple(path[k - k % 2]))
        price = risk_price(task, (k // 2) * ground.step_s, left_m)
        cost += price * ds * (risks[-1] + soft)
        cost += task.turn_weight * math.dist(velocities[k], velocities[k + 1])
    for a, h, b in zip(path[::2], path[1::2], path[2::2], strict=False):
        room = min(ground.clearance(tuple(h)), ground.clearance(tuple(b)))
        cost += time_cost(task, ground.metres_left(tuple(b)), math.dist(a, b) / (2 * ds), 2 * ds)
        cost += wall_cost(task, room, 2 * ds)
    left = ground.seconds_left(tuple(path[-1]), math.hypot(*velocities[-1]))
    return cost + left, math.fsum(risks) / len(risks)


def update_path(
    ground: Ground,
    path: NDArray[np.float64],
    offsets: int,
    offset_m: float,
    least_risk: float,
) -> int:
    """Figs. 7 and 8 as the recursion that they are; bends the path up to its arrival in place."""

    def average_risk(p: NDArray[np.float64], left: int, right: int) -> float:
        ds = ground.step_s / 2
        risks = [ground.risk(k, tuple(p[k]), tuple((p[k] - p[k - 1]) / ds))
                 for k in range(left + 1, right + 1)]  # fmt: skip
        return math.fsum(risks) / len(risks)

    def legal(p: NDArray[np.float64], left: int, right: int) -> bool:
        most = ground.task.max_speed_mps * ground.step_s / 2 + 1e-9
        return all(
            math.dist(p[k], p[k + 1]) <= most
            and ground.clearance(tuple(p[k + 1])) >= ground.needed()
            and math.isfinite(ground.seconds_left(tuple(p[k + 1])))
            and not ground.meeting(k, tuple(p[k]), tuple(p[k + 1]))[0]
            for k in range(left, right)
        )

    def perturb(left: int, right: int) -> NDArray[np.float64] | None:
        risk = average_risk(path, left, right)
        chord = path[right] - path[left]
        if risk <= least_risk or math.hypot(*chord) < 1e-6:
            return None
        normal = np.array([-chord[1], chord[0]]) / math.hypot(*chord)
        middle = (left + right) // 2
        for n in range(1, offsets + 1):
            for side in (1.0, -1.0):
                bend = path.copy()
                tip = path[left] + 0.5 * chord + side * n * offset_m * normal
                bend[left : middle + 1] = np.linspace(path[left], tip, middle - left + 1)
                bend[middle : right + 1] = np.linspace(tip, path[right], right - middle + 1)
                if average_risk(bend, left, right) < risk - least_risk and legal(bend, left, right):
                    return bend
        return None

    def update(left: int, right: int) -> int:
        bend = perturb(left, right)
        if bend is not None:
            path[:] = bend
            return 1
        if right - left < 4:
            return 0
        middle = (left + right) // 2
        return update(left, middle) + update(middle, right)

    there = [k for k in range(1, len(path) - 1)
             if ground.metres_left(tuple(path[k])) <= ground.task.goal_tolerance_m]  # fmt: skip
    return update(0, there[0] if there and not ground.task.hold else len(path) - 1)

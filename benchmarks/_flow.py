"""Flow through a doorway: persons a second and metre of width, and waits against a fair order."""

from dataclasses import dataclass

import numpy as np
from benchmarks._swaps import Swap
from benchmarks._walks import Floats, Walks


@dataclass(frozen=True)
class Flow:
    """The figures of one doorway."""

    width_m: float
    both_ways: bool
    actors: int
    crossed: int
    flow: float | None
    """Persons a second and metre of width, of the middle eight tenths; None if too few cross."""
    last_s: float | None
    """Time at which the last one crosses; None if not all do."""
    longest_wait_s: float
    """The longest time by which anybody is later at the doorway than alone; of those who do not
    cross, until the end."""
    fair_wait_s: float
    """The same if all went through at the same rate in the order in which they could be there."""
    contacts: int

    @property
    def unfairness(self) -> float:
        """Ratio of the longest wait to that of the fair order."""
        return self.longest_wait_s / max(self.fair_wait_s, 1e-9)


def one_way(swap: Swap) -> Swap:
    """The same doorway for those alone who come from the left."""
    x0, _, x1, _ = swap.scene.bounds
    left = swap.starts[:, 0] < (x0 + x1) / 2.0
    return Swap(f"{swap.name}, one way", swap.scene, swap.starts[left], swap.goals[left])


def flow_of(swap: Swap, width_m: float, walks: Walks) -> Flow:
    """Judge how actors go through the doorway in the middle of a scene."""
    x0, y0, x1, y1 = swap.scene.bounds
    door = np.array([(x0 + x1) / 2.0, (y0 + y1) / 2.0])
    crossed_s = crossings_s(walks.positions, float(door[0]), walks.tick_s)
    alone_s = np.hypot(*(walks.positions[0] - door).T) / walks.speed_mps
    end_s = walks.tick_s * (len(walks.positions) - 1)
    there = np.isfinite(crossed_s)
    times = np.sort(crossed_s[there])
    first, last = len(times) // 10, len(times) - len(times) // 10 - 1
    rate = (last - first) / (times[last] - times[first]) if last > first else None
    waits = np.where(there, crossed_s, end_s) - alone_s
    starts_left = walks.positions[0, :, 0] < door[0]
    return Flow(
        width_m=width_m,
        both_ways=bool(starts_left.any() and not starts_left.all()),
        actors=len(alone_s),
        crossed=int(there.sum()),
        flow=None if rate is None else float(rate / width_m),
        last_s=float(times[-1]) if there.all() else None,
        longest_wait_s=float(waits.max()),
        fair_wait_s=0.0 if rate is None else fair_wait_s(alone_s, rate),
        contacts=int((walks.clearances_m < 0.0).sum()) // 2,
    )


def crossings_s(positions: Floats, door_x: float, tick_s: float) -> Floats:
    """Time (A,) at which each of A actors is first on the other side of a line; inf if never."""
    side = positions[:, :, 0] > door_x
    other = side != side[0]
    return np.where(other.any(axis=0), other.argmax(axis=0) * tick_s, np.inf)


def fair_wait_s(alone_s: Floats, rate: float) -> float:
    """The longest wait if actors (A,), who could be there then, go through at a rate in order."""
    free_s, longest_s = -np.inf, 0.0
    for there_s in np.sort(alone_s).tolist():
        crossed_s = max(there_s, free_s)
        longest_s = max(longest_s, crossed_s - there_s)
        free_s = crossed_s + 1.0 / rate
    return longest_s

"""Small crowds for the tests of reacting people."""

import numpy as np

from esplanade.pedestrians import ReactingCrowd

TICK_S = 0.1
STANDING_ACTOR = [0.0, 0.0, 0.0, 0.0, 0.25]


def straight(start: tuple[float, float], end: tuple[float, float], speed_mps: float = 1.3):
    """A path from start to end at constant speed, a place for each tick."""
    way = np.subtract(end, start)
    ticks = round(float(np.hypot(*way)) / speed_mps / TICK_S)
    return start + np.linspace(0.0, 1.0, ticks + 1)[:, None] * way


def crowded(seed: int = 1, people: int = 30) -> ReactingCrowd:
    """People on straight ways across a square of 16 m, who come in one after the other."""
    rng = np.random.default_rng(seed)
    ends = rng.uniform(-8, 8, (people, 2, 2))
    paths = [straight(tuple(a), tuple(b)) for a, b in ends]
    return ReactingCrowd(paths, rng.integers(0, 60, people).tolist(), TICK_S, seed=seed)

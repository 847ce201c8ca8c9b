"""The walk of a visitor of the load test: up and down, to and fro, the same for the same seed."""

import math
import random
from collections.abc import Iterator, Sequence
from typing import Final, NamedTuple

from esplanade.protocol.messages import Move, WalkTo

SPEED_MPS: Final = (0.6, 1.6)
TURN_RAD: Final = 0.7
"""Standard deviation of a change of direction."""

STEPS: Final = (5, 15)
"""A wanderer changes direction this often between two walks to a point."""

STEP_S: Final = (0.3, 1.5)
WALK_S: Final = (4.0, 12.0)
"""A walk to a point may take this long before the wanderer does something else."""


class Act(NamedTuple):
    """Send this, then wait so long."""

    message: Move | WalkTo
    pause_s: float


def wander(
    seed: int,
    index: int,
    bounds: tuple[float, float, float, float],
    max_speed_mps: float,
    floors_m: Sequence[float] = (0.0,),
) -> Iterator[Act]:
    """Endless acts of visitor number `index`.

    Parameters
    ----------
    seed, index : the same pair acts the same
    bounds : of the scene, x0, y0, x1, y1, metres
    max_speed_mps : what the server allows
    floors_m : heights of the floors that walks go to, metres
    """
    rng = random.Random(f"{seed}/{index}")
    x0, y0, x1, y1 = bounds
    sequence = 0
    direction = rng.uniform(-math.pi, math.pi)
    while True:
        sequence += 1
        x, y, z = rng.uniform(x0, x1), rng.uniform(y0, y1), rng.choice(floors_m)
        goal = WalkTo(seq=sequence, x=x, y=y, z=z)
        yield Act(goal, rng.uniform(*WALK_S))
        speed_mps = min(rng.uniform(*SPEED_MPS), max_speed_mps)
        for _ in range(rng.randint(*STEPS)):
            sequence += 1
            direction = math.remainder(direction + rng.gauss(0.0, TURN_RAD), math.tau)
            step = Move(seq=sequence, direction=direction, speed=speed_mps)
            yield Act(step, rng.uniform(*STEP_S))

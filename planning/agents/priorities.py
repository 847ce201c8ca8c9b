"""The order in which agents give way to each other, as kernels know it."""

from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class Turn(IntEnum):
    """Why an agent goes before those of a later turn, and what its key is, in metres."""

    LEAVES_PASSAGE = 0
    """It has come through a contested passage. Nobody can enter before the exit is free, so that
    the furthest goes first: the key is minus its distance from the passage."""
    ENTERS_PASSAGE = 1
    """It still has to come through one. The key is how near it has come to it, less for waiting."""
    LEAVES_JAM = 2
    """It is beyond the middle of a jam. The key is minus its distance from the middle."""
    ENTERS_JAM = 3
    """It still has to reach the middle. The key is its distance from the middle."""
    WALKS = 4
    """It is on its way. The key is the distance left to its goal: two agents do not change their
    order while one lets the other pass, since only the other gets nearer to its goal."""
    SETTLED = 5
    """It is about to arrive, waits, or has no goal. The key is 0."""


class Priorities(NamedTuple):
    """The priority of A agents: `turns` (A,) of `Turn`, and `keys_m` (A,) metres.

    An agent goes before another if its turn is less; of two with the same turn, if its key is less;
    and of two with the same key, if its `Agents.ranks` is less. No two have the same rank.
    """

    turns: NDArray[np.int64]
    keys_m: NDArray[np.float64]

"""The data that compiled code keeps from one call to the next."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.planning.compiled.handle import Handle, make_handle
from esplanade.planning.compiled.jit import kernel


class Pair(NamedTuple):
    numbers: NDArray[np.float64]
    factor: float


@kernel
def scale(held: Handle[Pair]) -> float:
    """Multiply in place; the sum."""
    pair = held.value
    pair.numbers[:] *= pair.factor
    return float(pair.numbers.sum())


def test_arrays_are_shared_and_may_be_handed_over_again_and_again() -> None:
    numbers = np.array([1.0, 2.0])
    held = make_handle(Pair(numbers, 3.0))
    assert scale(held) == 9.0
    assert numbers.tolist() == [3.0, 6.0]
    numbers[0] = 0.0
    assert scale(held) == 18.0
    assert scale(make_handle(Pair(numbers, 0.5))) == 9.0


def test_what_is_held_stays_when_nobody_else_has_it() -> None:
    held = make_handle(Pair(np.ones(1000), 2.0))
    junk = [np.zeros(1000) for _ in range(100)]
    assert scale(held) == 2000.0
    assert not np.any(junk)

"""What every format of recording comes down to."""

from typing import Final, NamedTuple

MAX_METRES: Final = 100_000.0
"""A coordinate farther out than this, either way, is taken for a fault of the file."""


class Sample(NamedTuple):
    """Pedestrian `id` is at (x, y) metres at `t` seconds; `line` of the file says so (from 1)."""

    line: int
    t: float
    id: str
    x: float
    y: float

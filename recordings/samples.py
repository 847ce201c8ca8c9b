"""Samples of a world that runs: where everybody is, as rows that files are written from."""

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

SAMPLE: Final = np.dtype(
    [
        ("frame", np.int64),
        ("id", np.int64),
        ("actor", np.bool_),
        ("t", np.float64),
        ("x", np.float64),
        ("y", np.float64),
        ("z", np.float64),
        ("vx", np.float64),
        ("vy", np.float64),
        ("heading", np.float64),
    ]
)
"""One body at one time. Frames are counted from 0 at time 0, at an even rate; `actor` says whether
the computer steers it. Seconds, metres, metres a second, radians from +x."""
UNITS: Final = {
    "frame": "1",
    "t": "s",
    "id": "1",
    "kind": "actor, person",
    "x": "m",
    "y": "m",
    "z": "m",
    "vx": "m/s",
    "vy": "m/s",
    "heading": "rad",
}
"""Units of the columns of tables, in their order."""
Samples = NDArray[np.void]
"""SAMPLE (N,)."""


class Note(NamedTuple):
    """Something that holds from a frame on and stands in no column, such as a parameter."""

    frame: int
    tick: int
    kind: str
    """`avatar`, `parameters`, `actors` or `end`."""
    text: str
    """JSON in one line."""


class Head(NamedTuple):
    """The head of a file: where it comes from, its rate, and the ground of its world."""

    provenance: dict[str, str]
    fps: float
    """Frames a second."""
    bounds: tuple[float, float, float, float]
    """x0, y0, x1, y1, metres."""
    area: str
    """Where one can walk on the lowest floor, as WKT."""

"""The measures by which policies and settings are compared, and their samples."""

from collections.abc import Callable, Sequence
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.evaluation.scores import Score
from esplanade.stats import Sample

Floats = NDArray[np.float64]

PIECE_S: Final = 40.0
"""Trips that begin in the same piece of a recording of so many seconds hang together."""


class Measure(NamedTuple):
    """One figure of an episode."""

    name: str
    """The key in JSON."""
    label: str
    """The heading in pictures."""
    short: str
    """The heading in tables."""
    digits: int
    """The digits after the decimal point."""
    goal: float
    """A mean over recordings that is good enough."""
    best: float
    """The best possible value."""
    of: Callable[[Score], float]
    """Gives the figure of an episode; nan if the episode has none."""


MEASURES: Final = (
    Measure("contacts_percent", "contacts, %", "touch %", 1, 1.0, 0.0, lambda s: 100.0 * s.touched),
    Measure("near_s", "within 0.2 m, s", "near s", 3, 0.08, 0.0, lambda s: s.near_s),
    Measure("time_ratio", "time / straight way", "time", 3, 1.09, 1.0, lambda s: s.time_ratio),
    Measure("turn_rms_radps", "turn rate, rad/s", "turn", 2, 0.6, 0.0, lambda s: s.turn_rms_radps),
    Measure(
        "missed_percent", "not arrived, %", "lost %", 1, 0.0, 0.0, lambda s: 100.0 * (not s.reached)
    ),
)


IMPOSED: Final = Measure(
    "displacement_m", "imposed on people, m", "imposed m", 2, 0.0, 0.0, lambda s: s.displacement_m
)
"""One more measure, which is compared where people react."""


def table(scores: Sequence[Score], measures: Sequence[Measure] = MEASURES) -> Floats:
    """The M measures of E episodes, float64 (E, M)."""
    return np.array([[measure.of(score) for measure in measures] for score in scores])


def pieces(scores: Sequence[Score]) -> list[int]:
    """The piece of the recording in which each episode begins: the cluster that it is in."""
    return [int(score.start_s // PIECE_S) for score in scores]


def sample(scores: Sequence[Score], measures: Sequence[Measure] = MEASURES) -> Sample:
    """The measures of the episodes of one recording, in pieces of it."""
    return Sample.of(table(scores, measures), pieces(scores))


def named(measures: Floats) -> dict[str, float]:
    """The measures (M,) by their names."""
    return {measure.name: value for measure, value in zip(MEASURES, measures.tolist(), strict=True)}

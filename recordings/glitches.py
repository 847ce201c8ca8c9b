"""Glitches of tracking: samples that nobody can have been at, found against the track's own pace.

A step is a break if it is faster than anyone runs, or much faster than this person otherwise goes
and than the steps beside it. Between breaks a track is sound; of its sound pieces the most samples
are kept that one person can have gone through, one after the other. A piece that is long, but can
not be reached, is somebody else: such a track is divided. Last, single samples are glitches that
lie far aside of the straight way between their neighbours.
"""

from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt

from esplanade.recordings.crowd import Floats

Mask = npt.NDArray[np.bool_]

FASTEST_MPS: Final = 12.5
"""Nobody runs faster."""
TIMES_OWN: Final = 4.0
"""A step so many times as fast as the person's own pace is suspicious."""
LEAST_SUSPICIOUS_MPS: Final = 4.0
LEAST_JUMP_MPS: Final = 2.5
GREATEST_ACCELERATION_MPS2: Final = 10.0
LEAST_SPIKE_M: Final = 0.3
TIMES_OWN_SPIKE: Final = 8.0
OWN_SAMPLES: Final = 5
"""A piece with so many samples may be another person's."""
_LOOK_BACK: Final = 60


class Sound(NamedTuple):
    """The sound part of a track: for each sample the number of its piece, -1 for a glitch."""

    pieces: npt.NDArray[np.int64]

    @property
    def glitches(self) -> int:
        """How many samples are glitches."""
        return int(np.count_nonzero(self.pieces < 0))


def own_pace(times: Floats, places: Floats) -> float:
    """The pace, m/s, that glitches hardly change: a quarter of the steps are slower."""
    return own_pace_of(_speeds(times, places))


def own_pace_of(speeds: Floats) -> float:
    """The same of speeds that are known; NaN without any."""
    if not len(speeds):
        return float("nan")
    slower = (len(speeds) - 1) // 4
    return float(np.partition(speeds, slower)[slower])


def suspicious_mps(own_mps: float, usual_mps: float) -> float:
    """Steps faster than this are suspicious, of somebody with this pace in such a crowd."""
    pace = max(own_mps, usual_mps) if own_mps == own_mps else usual_mps  # noqa: PLR0124 (NaN)
    return min(max(TIMES_OWN * pace, LEAST_SUSPICIOUS_MPS), FASTEST_MPS)


def sound_part(times: Floats, places: Floats, usual_mps: float, own_mps: float) -> Sound:
    """Find the glitches of a track in the order of time; paces are the crowd's and its own."""
    pieces = np.zeros(len(times), np.int64)
    if len(times) < 2:
        return Sound(pieces)
    speeds = _speeds(times, places)
    pace = max(own_mps, usual_mps)
    limit = suspicious_mps(own_mps, usual_mps)
    if speeds.max() > limit and (breaks := _breaks(speeds, pace, limit)).any():
        pieces = _pieces(times, places, breaks, limit)
    elif not _spikes(times, places).any():
        return Sound(pieces)
    for piece in range(pieces.max() + 1):
        own = np.flatnonzero(pieces == piece)
        pieces[own[_spikes(times[own], places[own])]] = -1
    return Sound(pieces)


def _speeds(times: Floats, places: Floats) -> Floats:
    steps = places[1:] - places[:-1]
    found: Floats = np.hypot(steps[:, 0], steps[:, 1]) / (times[1:] - times[:-1])
    return found


def _breaks(speeds: Floats, pace: float, limit: float) -> Mask:
    suspicious = speeds > limit
    calm = np.where(suspicious, 0.0, speeds)
    beside = np.maximum(np.append(0.0, calm[:-1]), np.append(calm[1:], 0.0))
    beside = np.maximum(beside, pace)
    jumps = speeds - beside > np.maximum(LEAST_JUMP_MPS, beside)
    found: Mask = (speeds > FASTEST_MPS) | (suspicious & jumps)
    return found


def _pieces(times: Floats, places: Floats, breaks: Mask, limit: float) -> npt.NDArray[np.int64]:
    """The number of each sample's piece; 0 for those that one person can have gone through."""
    starts = np.append(0, np.flatnonzero(breaks) + 1)
    ends = np.append(starts[1:], len(times))
    best = (ends - starts).astype(np.int64)
    before = np.full(len(starts), -1)
    for j in range(1, len(starts)):
        i = np.arange(max(0, j - _LOOK_BACK), j)
        last = ends[i] - 1
        away = np.hypot(*(places[starts[j]] - places[last]).T)
        reached = away <= limit * (times[starts[j]] - times[last])
        if reached.any():
            scores = np.where(reached, best[i], -1)
            at = int(np.argmax(scores))
            best[j] += scores[at]
            before[j] = i[at]
    pieces = np.full(len(times), -1, np.int64)
    j = int(np.argmax(best))
    while j >= 0:
        pieces[starts[j] : ends[j]] = 0
        j = int(before[j])
    others = 0
    for start, end in zip(starts, ends, strict=True):
        if pieces[start] < 0 and end - start >= OWN_SAMPLES:
            others += 1
            pieces[start:end] = others
    return pieces


def _spikes(times: Floats, places: Floats) -> Mask:
    """Samples that lie far aside, further than those before and after."""
    found = np.zeros(len(times), bool)
    if len(times) < 3:
        return found
    before, after = np.diff(times)[:-1], np.diff(times)[1:]
    share = (before / (before + after))[:, None]
    straight = places[:-2] + share * (places[2:] - places[:-2])
    aside = np.hypot(*(places[1:-1] - straight).T)
    least = np.maximum(LEAST_SPIKE_M, 0.5 * GREATEST_ACCELERATION_MPS2 * before * after)
    if not (aside > least).any():
        return found
    least = np.maximum(least, TIMES_OWN_SPIKE * np.median(aside))
    peak = (aside >= np.append(0.0, aside[:-1])) & (aside >= np.append(aside[1:], 0.0))
    found[1:-1] = (aside > least) & peak
    return found

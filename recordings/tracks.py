"""Tracks of samples that are in order: which of them are sound, how fast people are, all at once.

What is the same for all samples is computed for some tens of thousands of them together, so that it
stays near the processor. Only tracks in which something is suspicious are looked at one by one.
"""

from collections import Counter
from collections.abc import Iterator
from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt

from esplanade.recordings.crowd import Floats, Track
from esplanade.recordings.glitches import (
    GREATEST_ACCELERATION_MPS2,
    LEAST_SPIKE_M,
    own_pace_of,
    sound_part,
    suspicious_mps,
)
from esplanade.recordings.rows import Rows, Whole

_PIECE: Final = 32_768
_MANY_STEPS: Final = 1_000_000
_TICKS_A_SECOND: Final = 10_000
"""Times between samples are told apart to a tenth of a millisecond."""
_MOST_TICKS: Final = 1_000_000


class Found(NamedTuple):
    """The tracks of rows, and what was found out about them on the way."""

    tracks: list[Track]
    glitches: int
    divided: int
    first_glitch: int
    """The row of the first glitch; -1 without any."""
    sample_s: float
    median_mps: float
    """Of all steps of the tracks; NaN without any."""


class Steps:
    """The steps between neighbouring samples: their speeds, and what is suspicious about them."""

    def __init__(self, rows: Rows, places: Floats) -> None:
        self._times, self._places = rows.clock, places
        self.starts: Whole = np.append(0, np.flatnonzero(rows.who[1:] != rows.who[:-1]) + 1)
        self.ends: Whole = np.append(self.starts[1:], len(rows.who))
        self.fastest: Floats = np.zeros(len(self.starts))
        self.paces: Floats = np.empty(len(self.starts))
        self._gaps: Counter[int] = Counter()
        self._aside = np.zeros(len(self.starts), bool)
        self._speeds: list[Floats] = []
        self._each = max(1, len(rows.who) // _MANY_STEPS)
        self._seen = 0
        for first, last in self._pieces():
            self._take(first, last)

    def suspicious(self, track: int, usual_mps: float) -> bool:
        """Whether anything of a track has to be looked at."""
        limit = suspicious_mps(float(self.paces[track]), usual_mps)
        return bool(self._aside[track] or self.fastest[track] > limit)

    @property
    def sample_s(self) -> float:
        """The most common time between two samples of a person; 0 without any."""
        if not self._gaps:
            return 0.0
        most = max(self._gaps.values())
        return min(gap for gap, count in self._gaps.items() if count == most) / _TICKS_A_SECOND

    @property
    def median_mps(self) -> float:
        """The median speed, of every so many steps where there are millions; NaN without any."""
        steps = np.concatenate([np.empty(0), *self._speeds])
        return float(np.median(steps, overwrite_input=True)) if len(steps) else float("nan")

    def _pieces(self) -> Iterator[tuple[int, int]]:
        """Tracks in groups of about `_PIECE` samples: the first, and the one behind the last."""
        first = 0
        while first < len(self.starts):
            last = int(np.searchsorted(self.starts, self.starts[first] + _PIECE))
            last = max(last, first + 1)
            yield first, last
            first = last

    def _take(self, first: int, last: int) -> None:
        """Look at the steps of the tracks from `first` on."""
        begin, end = int(self.starts[first]), int(self.ends[last - 1])
        starts, lasts = self.starts[first:last] - begin, self.ends[first:last] - 1 - begin
        times, x, y = self._times[begin:end], *self._places[begin:end].T
        gaps, along_x, along_y = times[1:] - times[:-1], x[1:] - x[:-1], y[1:] - y[:-1]
        gaps[lasts[:-1]] = 1.0
        speeds = np.zeros(end - begin)
        # Places are bounded: squares neither overflow, nor do they lose what matters.
        speeds[:-1] = np.sqrt(along_x * along_x + along_y * along_y) / gaps
        speeds[lasts] = 0.0
        self.fastest[first:last] = np.maximum.reduceat(speeds, starts)
        self._take_paces(first, starts, lasts, speeds)
        own = np.ones(end - begin, bool)
        own[lasts] = False
        self._count(gaps[own[:-1]])
        if len(gaps) < 2:
            return
        before, after = gaps[:-1], gaps[1:]
        share = before / (before + after)
        aside_x = along_x[:-1] - share * (x[2:] - x[:-2])
        aside_y = along_y[:-1] - share * (y[2:] - y[:-2])
        aside = aside_x * aside_x + aside_y * aside_y
        found = np.flatnonzero((aside > LEAST_SPIKE_M**2) & own[:-2] & own[1:-1])
        least = 0.5 * GREATEST_ACCELERATION_MPS2 * before[found] * after[found]
        found = found[aside[found] > np.maximum(LEAST_SPIKE_M, least) ** 2]
        if len(found):
            # The sample in the middle of three tells whose they are.
            owners = np.searchsorted(self.starts, begin + found + 1, side="right") - 1
            self._aside[owners] = True

    def _take_paces(self, first: int, starts: Whole, lasts: Whole, speeds: Floats) -> None:
        """The own pace of each of these tracks; and of every so many steps the speed."""
        for number, (start, end) in enumerate(
            zip(starts.tolist(), lasts.tolist(), strict=True), first
        ):
            self.paces[number] = own_pace_of(speeds[start:end])
            skipped = -self._seen % self._each
            self._seen += end - start
            self._speeds.append(speeds[start + skipped : end : self._each].copy())

    def _count(self, gaps: Floats) -> None:
        ticks = np.rint(gaps * _TICKS_A_SECOND)
        if not len(ticks):
            return
        if ticks.max() < _MOST_TICKS:
            counts = np.bincount(ticks.astype(np.int64))
            there = np.flatnonzero(counts)
            self._gaps.update(dict(zip(there.tolist(), counts[there].tolist(), strict=True)))
        else:
            values, counts = np.unique(ticks, return_counts=True)
            self._gaps.update(dict(zip(values.tolist(), counts.tolist(), strict=True)))


def tracks_of(rows: Rows, places: Floats, steps: Steps, usual_mps: float) -> Found:
    """The tracks of rows in order, without glitches; those that jump for good are several."""
    found: list[tuple[float, int, Track]] = []
    glitches = divided = 0
    first_glitch = -1
    for number, (start, end) in enumerate(
        zip(steps.starts.tolist(), steps.ends.tolist(), strict=True)
    ):
        name = rows.ids[rows.who[start]]
        times, own = rows.clock[start:end], places[start:end]
        if not steps.suspicious(number, usual_mps):
            track = _track(name, times, own)
            # This is kept, so that a cached property does not find it out once more.
            track.__dict__["max_speed_mps"] = max(0.0, float(steps.fastest[number]))
            found.append((track.start_s, int(rows.lines[start:end].min()), track))
            continue
        pieces = sound_part(times, own, usual_mps, float(steps.paces[number])).pieces
        bad = pieces < 0
        if bad.any():
            glitches += int(np.count_nonzero(bad))
            first_glitch = start + int(np.argmax(bad)) if first_glitch < 0 else first_glitch
        for piece in range(int(pieces.max()) + 1):
            at = pieces == piece
            if at.any():
                divided += piece > 0
                track = _track(f"{name}#{piece + 1}" if piece else name, times[at], own[at])
                found.append((track.start_s, int(rows.lines[start:end][at].min()), track))
    found.sort(key=lambda each: each[:2])
    tracks = [track for _, _, track in found]
    if glitches or divided:
        sample_s, median_mps = measured(tracks)
    else:
        sample_s, median_mps = steps.sample_s, steps.median_mps
    return Found(tracks, glitches, divided, first_glitch, sample_s, median_mps)


def measured(tracks: list[Track]) -> tuple[float, float]:
    """The most common time of a sample, s, and the median speed over all steps, m/s."""
    gaps = [np.diff(track.times) for track in tracks if len(track.times) > 1]
    if not gaps:
        return 0.0, float("nan")
    every = np.concatenate(gaps)
    away = np.concatenate(
        [np.hypot(*np.diff(t.positions, axis=0).T) for t in tracks if len(t.times) > 1]
    )
    ticks, counts = np.unique(np.rint(every * _TICKS_A_SECOND), return_counts=True)
    return float(ticks[np.argmax(counts)]) / _TICKS_A_SECOND, float(np.median(away / every))


def _track(name: str, times: Floats, positions: npt.NDArray[np.float64]) -> Track:
    times.setflags(write=False)
    positions.setflags(write=False)
    return Track(name, times, positions)

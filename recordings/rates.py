"""Frames a second: from the file's header, else from what it shows, else from who reads it."""

from typing import Final, NamedTuple

import numpy as np

from esplanade.recordings.rows import Floats, Given, Rows, Whole

USUAL_SAMPLES_PER_S: Final = 2.5
"""ETH, UCY and TrajNet are sampled so."""
USUAL_RATES: Final = (5.0, 6.0, 7.5, 8.0, 10.0, 12.5, 15.0, 16.0, 20.0, 25.0, 30.0, 50.0, 60.0)
WALKING_MPS: Final = (0.3, 2.5)
"""The median speed of people in a recording lies between these."""

_GUESSED_MPS: Final = 0.6
"""Slower people may be a crowd, or people whose rate was guessed wrongly."""
_FEW_PAIRS: Final = 3
_LEAST_SPEED_MPS: Final = 0.2
_LEAST_RATE: Final = 0.5
_GREATEST_RATE: Final = 250.0
_SURE: Final = 0.01
_UNSURE: Final = 0.08
_SMOOTHED: Final = 0.05
_UNSURE_OF_SMOOTHED: Final = 0.15


class Rate(NamedTuple):
    """Frames a second, where they come from, and what is to be said of it.

    `fps` is None where nothing says it.
    """

    fps: float | None
    source: str
    remarks: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()


class Pairs(NamedTuple):
    """Neighbouring samples of the same people: indices into the rows, and the frames between."""

    first: Whole
    second: Whole
    frames: Floats


def pairs_of(rows: Rows) -> Pairs:
    """All pairs of neighbouring samples, in the order of time."""
    order = np.lexsort((rows.clock, rows.who))
    gaps = np.diff(rows.clock[order])
    chosen = (np.diff(rows.who[order]) == 0) & (gaps > 0.0)
    return Pairs(order[:-1][chosen], order[1:][chosen], gaps[chosen])


def common_step(frames: Floats) -> float:
    """The most common number of frames between two samples; 1 if there are none."""
    if not len(frames):
        return 1.0
    steps, counts = np.unique(frames, return_counts=True)
    place = int(np.argmax(counts))
    step = float(steps[place])
    if counts[place] > 0.6 * len(frames):
        return step
    # Samples at 2.5 a second of 29.97 frames lie 11, 12, 12, .. frames apart.
    near = np.abs(steps - step) <= max(1.0, 0.1 * step)
    return float(np.average(steps[near], weights=counts[near]))


def frame_rate(rows: Rows, given: Given, metres: float) -> Rate:
    """Find the frames a second; a unit of the file has so many `metres`."""
    pairs = pairs_of(rows)
    step = common_step(pairs.frames)
    remarks = _odd_frames(rows, step)
    if given.fps is not None:
        warnings: tuple[str, ...] = ()
        if rows.fps is not None and abs(rows.fps - given.fps) > 0.01 * rows.fps:
            warnings = (f"--fps {given.fps:g} is taken, but the file says {rows.fps:g}",)
        return Rate(given.fps, "--fps", remarks, warnings)
    if rows.fps is not None or rows.samples_per_s is not None:
        said = rows.fps or (rows.samples_per_s or 0.0) * step
        return Rate(said, "as the file says" if rows.fps else rows.usual_from, remarks)
    away = metres * np.hypot(*(v[pairs.second] - v[pairs.first] for v in (rows.x, rows.y)))
    shown = _shown_by_velocities(rows, pairs, away, step, metres)
    if shown is not None or rows.usual_fps is not None:
        source = rows.usual_from if shown is None else "as its velocities show"
        return Rate(rows.usual_fps if shown is None else shown, source, remarks)
    return _usual(step, away, pairs, remarks)


def _usual(step: float, away: Floats, pairs: Pairs, remarks: tuple[str, ...]) -> Rate:
    """The rate of ETH, UCY and TrajNet, unless every frame counts and nobody walks so."""
    usual = USUAL_SAMPLES_PER_S * step
    source = (
        f"taken for {1 / USUAL_SAMPLES_PER_S:g} s a sample, as in ETH, UCY and TrajNet; "
        "--fps says otherwise"
    )
    if not len(away):
        return Rate(usual, source, remarks)
    speed = float(np.median(away / pairs.frames)) * usual
    walking = WALKING_MPS[0] <= speed <= WALKING_MPS[1]
    if step <= 1.0 and not walking:
        return Rate(None, "", remarks)
    others = [
        f"--fps {rate:g} ({speed * rate / usual:.3g} m/s)" for rate in likely_rates(speed / usual)
    ]
    if not walking or speed >= _GUESSED_MPS or not others:
        return Rate(usual, source, remarks)
    doubt = (
        f"nothing says how many frames make a second: with {usual:g} people go at {speed:.3g} m/s, "
        f"as in dense crowds; else give {', '.join(others[:4])}"
    )
    if step <= 1.0:
        return Rate(usual, source, remarks, (doubt,))
    return Rate(usual, source, (*remarks, doubt))


def likely_rates(speed_per_frame: float) -> tuple[float, ...]:
    """The usual rates at which people who go so many metres a frame would walk."""
    return tuple(rate for rate in USUAL_RATES if 0.8 <= speed_per_frame * rate <= 1.7)


def _odd_frames(rows: Rows, step: float) -> tuple[str, ...]:
    frames = np.unique(rows.clock)
    if len(frames) < 3 or step <= 1.0 or step != np.round(step):
        return ()
    rests, counts = np.unique(np.mod(frames, step), return_counts=True)
    usual = rests[np.argmax(counts)]
    odd = np.flatnonzero(np.mod(frames, step) != usual)
    # Many of them are no fault: people may be sampled at frames of their own.
    if not len(odd) or len(odd) > 0.2 * len(frames):
        return ()
    line = int(rows.lines[np.argmax(rows.clock == frames[odd[0]])])
    count = f"{len(odd)} of {len(frames)} frame numbers"
    first = f"the first is {frames[odd[0]]:g} in line {line}"
    return (f"{count} are out of the step of {step:g}, {first}",)


def _shown_by_velocities(
    rows: Rows, pairs: Pairs, away: Floats, step: float, metres: float
) -> float | None:
    """The rate at which distances and velocities agree, made round if near a usual one.

    Velocities are in the unit of places or in metres: only one of these gives a rate of cameras.
    """
    if rows.velocities is None or not len(away):
        return None
    speeds = np.hypot(*rows.velocities.T)
    found = [_agreed(speeds * unit, pairs, away, step) for unit in dict.fromkeys((metres, 1.0))]
    likely = [rate for rate in found if rate is not None and _LEAST_RATE <= rate <= _GREATEST_RATE]
    usual = [rate for rate in likely if rate in USUAL_RATES]
    return next(iter((*usual, *likely, *(rate for rate in found if rate is not None))), None)


def _agreed(speeds: Floats, pairs: Pairs, away: Floats, step: float) -> float | None:
    ends = np.stack([speeds[pairs.first], speeds[pairs.second]])
    between = ends.mean(axis=0)
    steady = np.abs(ends[0] - ends[1]) < 0.5 * between
    moving = (between > _LEAST_SPEED_MPS) & (away > 0.0) & steady & (pairs.frames <= 2.0 * step)
    if not moving.any():
        return None
    found = pairs.frames[moving] * between[moving] / away[moving]
    rate = float(np.median(found))
    unsure = _UNSURE
    if len(found) >= _FEW_PAIRS:
        spread = 1.4826 * float(np.median(np.abs(found - rate))) / rate
        unsure = min(_UNSURE, max(_SURE, 3.0 * spread / np.sqrt(len(found))))
        if spread > _SMOOTHED:
            # Velocities that were smoothed are too low or too high by a share of their own.
            unsure = min(_UNSURE_OF_SMOOTHED, 1.5 * spread)
    for usual in (USUAL_SAMPLES_PER_S * step, *sorted(USUAL_RATES, key=lambda r: abs(r - rate))):
        if abs(usual - rate) <= unsure * rate:
            return usual
    return rate if np.isfinite(rate) and 0.0 < rate < 1e6 else None

"""Foot sliding: how far planted feet move when walking is drawn at 60 frames a second."""

from dataclasses import dataclass, fields
from itertools import pairwise
from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt
from benchmarks._step_log import Floats, Seen

from esplanade.actors.locomotion.body.sizes import BodySizes
from esplanade.actors.locomotion.motion.key_poses import Steps
from esplanade.actors.locomotion.reference.posing import Pose, pose
from esplanade.server.world.step_records import from_records

FRAMES_PER_SECOND: Final = 60
PHASE: Final = 0.37
"""Frames are offset from ticks by this part of a frame, since in a browser they do not coincide."""

FLAT_RAD: Final = 1e-3
"""A foot lies flat if its pitch is below this."""
EVEN: Final = 1.15
"""Walking counts as even if the speeds of six steps differ by at most this factor."""

Flags = npt.NDArray[np.bool_]
Rows = npt.NDArray[np.int64]


@dataclass(frozen=True)
class Findings:
    """Distances in metres, with one number for each observation."""

    slide: Floats
    """The motion of a planted foot's contact along the ground from one frame to the next."""
    drift: Floats
    """The greatest distance along the ground, while a foot is planted, of its contact from its
    position when the foot lay flat."""
    jump_feet: Floats
    """The distance between the ankles that two successive records draw at the same moment; it is
    that of the ankle with the greater distance."""
    jump_root: Floats
    """The same for the hips."""
    landing: Floats
    """The distance of the swing foot from its footprint at the end of its step."""
    step_m: Floats
    """The length of steps of even walking, which is half of the distance that a foot covers."""
    travel_m: Floats
    """Half of the distance that the body covered in that time according to snapshots."""
    off_body: Floats
    """The distance on the map of the drawn hips from the position in snapshots."""
    frames: Floats
    """The number of frames that each walker was drawn in."""


def judge(everyone: list[Seen], tick_rate: int) -> Findings:
    """Draw the whole footage of everybody and measure the feet."""
    parts = [_judge(seen, tick_rate) for seen in everyone]
    names = [field.name for field in fields(Findings)]
    return Findings(**{name: np.concatenate([getattr(p, name) for p in parts]) for name in names})


def _judge(seen: Seen, tick_rate: int) -> Findings:
    steps = from_records(seen.steps)
    frame = tick_rate / FRAMES_PER_SECOND
    ticks = np.arange(seen.heard[0] + PHASE * frame, seen.until, frame)
    rows = np.maximum(np.searchsorted(steps.start, ticks, side="right") - 1, 0)
    shares = _shares(steps, rows, ticks)
    drawn = _draw(steps, rows, shares, seen)
    feet = _planted(steps, rows, shares)
    anew = np.append(False, (np.diff(rows) > 0) & ~seen.goes_on[rows[1:]])
    jumps = _jumps(steps, seen)
    step_m, travel_m = _strides(steps, seen)
    away = drawn.root[:, :2] - seen.place_at(ticks)
    return Findings(
        slide=_slides(drawn, feet, anew),
        drift=_drifts(drawn, feet, anew),
        jump_feet=jumps[0],
        jump_root=jumps[1],
        landing=_landings(steps, seen),
        step_m=step_m,
        travel_m=travel_m,
        off_body=np.hypot(away[:, 0], away[:, 1]),
        frames=np.array([float(len(ticks))]),
    )


def _shares(steps: Steps, rows: Rows, ticks: Floats) -> Floats:
    lengths = steps.ticks[rows]
    gone = np.clip((ticks - steps.start[rows]) / np.maximum(lengths, 1), 0.0, 1.0)
    return np.where(lengths > 0, gone, 1.0)


def _draw(steps: Steps, rows: Rows, shares: Floats, seen: Seen) -> Pose:
    count = len(rows)
    sizes = BodySizes(np.full(count, seen.leg_m), np.full(count, seen.stature_m))
    return pose(steps.take(rows), shares, sizes)


# --- planted feet -----------------------------------------------------------------------------


class Planted(NamedTuple):
    """The feet that must not move in F frames, bool (F, 2) for left and right."""

    at_all: Flags
    """Whether the foot is planted."""
    on_toe: Flags
    """Whether it is planted and turns on the toe before it lifts."""


def _planted(steps: Steps, rows: Rows, shares: Floats) -> Planted:
    """Find the planted feet.

    The standing foot is planted until it pushes off for a flight. The swing foot is planted until
    its toe lifts, and again from the end of its step.
    """
    stands = np.arange(len(rows)), steps.on_right[rows].astype(np.int64)
    flight = steps.flight[rows]
    swings = np.arange(len(rows)), 1 - steps.on_right[rows].astype(np.int64)
    lift = steps.lift[rows]
    at_all = np.ones((len(rows), 2), dtype=np.bool_)
    on_toe = np.zeros((len(rows), 2), dtype=np.bool_)
    at_all[stands] = (flight <= 0.0) | (shares <= 1.0 - flight)
    on_toe[swings] = (lift > 0.0) & (shares <= lift)
    at_all[swings] = on_toe[swings] | (shares >= 1.0)
    return Planted(at_all, on_toe)


def _slides(drawn: Pose, feet: Planted, anew: Flags) -> Floats:
    """The motion of the contact between two frames in both of which a foot is planted."""
    heel = np.linalg.norm(np.diff(drawn.ankles[..., :2], axis=0), axis=2)
    toe = np.linalg.norm(np.diff(drawn.toes[..., :2], axis=0), axis=2)
    before, after = drawn.pitches[:-1], drawn.pitches[1:]
    on_heel = (before > FLAT_RAD) & (after > FLAT_RAD)
    on_toe = (before < -FLAT_RAD) & (after < -FLAT_RAD)
    turns = feet.on_toe[:-1] | feet.on_toe[1:]
    flat = (np.abs(before) <= FLAT_RAD) & (np.abs(after) <= FLAT_RAD)
    # While the foot rolls it turns about the heel until it lies flat, and then about the toe.
    moved = np.minimum(heel, toe)
    moved = np.where(on_heel, heel, np.where(on_toe, toe, moved))
    moved = np.where(turns, toe, np.where(flat, np.maximum(heel, toe), moved))
    both = feet.at_all[:-1] & feet.at_all[1:] & ~anew[1:, None]
    return np.asarray(moved[both])


def _drifts(drawn: Pose, feet: Planted, anew: Flags) -> Floats:
    """The drift of each foot for each time that it is planted; see `Findings.drift`."""
    furthest = []
    for foot in range(2):
        on = feet.at_all[:, foot]
        edges = np.flatnonzero(np.diff(np.concatenate([[False], on, [False]])) != 0)
        cuts = np.union1d(edges, np.flatnonzero(anew & on))
        for first, end in pairwise(cuts.tolist()):
            if on[first]:
                furthest.append(_drift(drawn, feet.on_toe, foot, slice(first, end)))
    return np.array([drift for drift in furthest if drift is not None])


def _drift(drawn: Pose, on_toe: Flags, foot: int, frames: slice) -> float | None:
    pitch = drawn.pitches[frames, foot]
    heels, toes = drawn.ankles[frames, foot, :2], drawn.toes[frames, foot, :2]
    flat = int(np.abs(pitch).argmin())
    if abs(pitch[flat]) > FLAT_RAD:
        return None
    heel = np.linalg.norm(heels - heels[flat], axis=1)
    toe = np.linalg.norm(toes - toes[flat], axis=1)
    return float(np.where((pitch < 0.0) | on_toe[frames, foot], toe, heel).max())


# --- from one record to the next --------------------------------------------------------------


def _jumps(steps: Steps, seen: Seen) -> tuple[Floats, Floats]:
    """The jumps of ankles and hips at the moments at which one record follows another."""
    rows = np.flatnonzero(seen.goes_on[1:])
    before = _draw(steps, rows, _shares(steps, rows, steps.start[rows + 1]), seen)
    after = _draw(steps, rows + 1, np.zeros(len(rows)), seen)
    feet = np.linalg.norm(after.ankles - before.ankles, axis=2).max(axis=1)
    return feet, np.linalg.norm(after.root - before.root, axis=1)


def _landings(steps: Steps, seen: Seen) -> Floats:
    """The distance of the swing foot from its footprint at the end of steps without re-aiming."""
    whole = np.append(steps.start[1:] >= (steps.start + steps.ticks)[:-1], True)
    rows = np.flatnonzero(whole & (steps.ticks > 0))
    ended = _draw(steps, rows, np.ones(len(rows)), seen)
    foot = 1 - steps.on_right[rows].astype(np.int64)
    here = np.arange(len(rows))
    landing = steps.landing[rows]
    along = np.stack([np.cos(landing[:, 3]), np.sin(landing[:, 3]), np.zeros(len(rows))], axis=1)
    foot_m = np.linalg.norm(ended.toes[here, foot] - ended.ankles[here, foot], axis=1)
    heel = np.linalg.norm(ended.ankles[here, foot] - landing[:, :3], axis=1)
    toe_place = landing[:, :3] + foot_m[:, None] * along
    toe = np.linalg.norm(ended.toes[here, foot] - toe_place, axis=1)
    return np.where(ended.pitches[here, foot] >= 0.0, heel, toe)


def _strides(steps: Steps, seen: Seen) -> tuple[Floats, Floats]:
    """The lengths of steps of even walking, drawn and travelled.

    Each is half of a stride, which is the distance that one foot covers during two steps. Steps
    during which the body speeds up or slows down are left out, because the feet then run ahead
    of the body or fall behind.
    """
    starts = np.flatnonzero(~steps.re_aimed)
    lasts = np.append(starts[1:], len(steps.start)) - 1
    begin, end = steps.start[starts], (steps.start + steps.ticks)[lasts]
    walks_on = (begin[1:] == end[:-1]) & (steps.on_right[starts[1:]] != steps.on_right[starts[:-1]])
    travel = seen.place_at(end.astype(float)) - seen.place_at(begin.astype(float))
    speed = np.hypot(travel[:, 0], travel[:, 1]) / np.maximum(end - begin, 1)
    pairs = np.arange(3, len(starts) - 2)
    around = np.stack([speed[pairs + k] for k in range(-3, 3)])
    even = around.max(axis=0) <= EVEN * around.min(axis=0)
    even &= np.all([walks_on[pairs + k] for k in range(-3, 2)], axis=0)
    pairs = pairs[even]
    covered = steps.landing[lasts[pairs + 1], :2] - steps.standing[lasts[pairs], :2]
    travelled = travel[pairs] + travel[pairs + 1]
    return np.hypot(*covered.T) / 2.0, np.hypot(*travelled.T) / 2.0

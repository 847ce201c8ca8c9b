"""Steps as the wire carries them, with the joints they stand for, for the web client's tests.

`python -m tests.actors.locomotion.step_vectors` writes them anew.
"""

import json
from pathlib import Path
from typing import Any, Final

import numpy as np

from esplanade.actors.locomotion.body import skeleton
from esplanade.actors.locomotion.body.sizes import STATURE, BodySizes
from esplanade.actors.locomotion.motion import key_poses as motion
from esplanade.actors.locomotion.motion.leg_poses import REACH
from esplanade.actors.locomotion.reference import posing
from esplanade.actors.locomotion.reference.rotations import (
    from_euler,
    normalise,
    to_forward_left_up,
)
from esplanade.server.world.step_records import from_records, to_records

FIXTURE: Final = Path(__file__).parents[3] / "client_web" / "tests" / "fixtures" / "steps.json"

SHARES: Final = (0.0, 0.07, 0.2, 0.31, 0.5, 0.68, 0.8, 0.93, 1.0)
DIGITS: Final = 10


def vectors() -> dict[str, Any]:
    """All values of the fixture, as JSON has them."""
    steps, sizes = sample_steps()
    ids = np.arange(len(steps.on_right)) + 7
    records = to_records(steps, ids)
    known = from_records(records)
    return {
        "skeleton": {
            "THIGH": skeleton.THIGH,
            "SHIN": skeleton.SHIN,
            "FOOT": skeleton.FOOT,
            "TRACK_HALF_WIDTH": skeleton.TRACK_HALF_WIDTH,
            "HIP_DEPTH": skeleton.HIP_DEPTH,
            "HEAD_TOP": skeleton.HEAD_TOP,
            "REACH": REACH,
            "STATURE": STATURE,
            "SHOULDER_UP": skeleton.HANGING_ARMS.shoulder_height,
            "SHOULDER_ASIDE": skeleton.HANGING_ARMS.shoulder_aside,
            "UPPER_ARM": skeleton.HANGING_ARMS.upper_arm,
            "FOREARM": skeleton.HANGING_ARMS.forearm,
            "ARMS_OUT": skeleton.ARMS_OUT_RAD,
        },
        "settle": motion.SETTLE,
        "cases": [
            {
                "record": records[row].tobytes().hex(),
                "leg_m": float(sizes.leg_m[row]),
                "stature_m": float(sizes.stature_m[row]),
                "lift": float(known.lift[row]),
                "ticks": int(known.ticks[row]),
                "poses": [_pose(known, sizes, row, share) for share in SHARES],
            }
            for row in range(len(ids))
        ],
    }


def text() -> str:
    """The fixture as it is stored, a case a line."""
    return json.dumps(vectors()).replace('{"record"', '\n{"record"') + "\n"


def _pose(steps: motion.Steps, sizes: BodySizes, row: int, share: float) -> dict[str, Any]:
    rows = np.array([row])
    one = BodySizes(sizes.leg_m[rows], sizes.stature_m[rows])
    joints = posing.pose(steps.take(rows), np.array([share]), one)
    named = {name: np.round(values[0], DIGITS) for name, values in joints._asdict().items()}
    return {"u": share, **{name: values.tolist() for name, values in named.items()}}


def sample_steps() -> tuple[motion.Steps, BodySizes]:
    """Steps of every kind: along, aside, back, up, down, flown, with bent knees, standing."""
    random = np.random.default_rng(3)
    count = 12
    steps = motion.no_steps(count)
    sizes = BodySizes(random.uniform(0.75, 1.0, count), random.uniform(1.5, 1.9, count))
    heading = random.uniform(-7.0, 7.0, count)
    heading[0] = 0.0
    steps.on_right[:] = np.arange(count) % 2 == 0
    steps.re_aimed[:] = np.arange(count) % 5 == 4
    steps.start[:] = random.integers(0, 2**31, count)
    steps.ticks[:] = random.integers(5, 20, count)
    steps.ticks[-1] = 0
    steps.lift[:] = np.where(np.arange(count) % 3 == 0, 0.0, random.uniform(0.05, 0.4, count))
    steps.flight[:] = np.where(np.arange(count) % 4 == 2, 0.3, 0.0)
    steps.standing[:, :3] = random.uniform(-40.0, 40.0, (count, 3))
    steps.standing[:, 3] = heading
    side = np.where(steps.on_right, 1.0, -1.0)
    ahead = random.uniform(-0.4, 0.75, count)
    aside = side * random.uniform(0.1, 0.35, count)
    rise = np.where(np.arange(count) % 4 == 1, random.uniform(-0.19, 0.19, count), 0.0)
    forward = np.stack([np.cos(heading), np.sin(heading), np.zeros(count)], axis=1)
    left = np.stack([-np.sin(heading), np.cos(heading), np.zeros(count)], axis=1)
    up = np.array([0.0, 0.0, 1.0])
    reach = ahead[:, None] * forward + aside[:, None] * left + rise[:, None] * up
    steps.landing[:, :3] = steps.standing[:, :3] + reach
    steps.landing[:, 3] = heading + random.uniform(-0.5, 0.5, count)
    shares = np.linspace(0.0, 1.0, motion.KEYS)
    for row in range(count):
        size = sizes.leg_m[row]
        height = size * random.uniform(0.92, 1.02) + 0.02 * np.sin(6.0 * shares)
        middle = 0.5 * reach[row] * (2.0 * shares[:, None] - 1.0) + 0.5 * aside[row] * left[row]
        steps.keys[row, :, motion.ROOT] = middle + height[:, None] * up
        turns = 0.1 * random.normal(size=(motion.KEYS, 3))
        turns[:, 0] += heading[row]
        # Euler angles are about up, left, forward here: the axes Y, X, Z of the gait's maths.
        steps.keys[row, :, motion.PELVIS] = to_forward_left_up(from_euler(turns))
        bump = np.sin(np.pi * shares)[:, None] * 0.15 * up
        steps.keys[row, :, motion.ANKLE] = bump - 1.8 * (1.0 - shares)[:, None] * reach[row]
        steps.keys[row, :, motion.SWING_PITCH] = np.linspace(-0.5, 0.2, motion.KEYS)
        steps.keys[row, :, motion.STANDING_PITCH] = [0.2, 0.0, 0.0, -0.05, -0.2, -0.6]
        steps.keys[row, :, motion.SWING_HEADING] = np.linspace(0.3, 0.0, motion.KEYS)
        small = 0.1 * random.normal(size=(motion.KEYS, 4)) + np.array([1.0, 0.0, 0.0, 0.0])
        steps.keys[row, :, motion.CHEST] = normalise(small)
        steps.keys[row, :, motion.ARMS] = random.uniform(-0.5, 1.0, (motion.KEYS, 4))
    steps.keys[-1] = steps.keys[-1, :1]
    return steps, sizes


if __name__ == "__main__":
    FIXTURE.parent.mkdir(parents=True, exist_ok=True)
    FIXTURE.write_text(text(), encoding="utf-8")

"""A body drawn as `docs/protocol.md` says, and by nothing else: one step at one moment."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]

THIGH, SHIN, FOOT, HIP = 0.466, 0.534, 0.2, 0.1
SPINE, NECK, CROWN, SHOULDER, UPPER_ARM, FOREARM = 0.178, 0.35, 0.674, 0.215, 0.345, 0.27
REACH, STEEPEST_RAD, SPREAD_RAD = 0.9995, -1.3, 0.12


@dataclass
class Key:
    """Six numbers of one kind each, or at a moment one of each."""

    root: Vector
    pelvis: Vector
    ankle: Vector
    swing_pitch: float
    standing_pitch: float
    swing_heading: float
    chest: Vector
    arms: Vector


@dataclass
class Step:
    right_stands: bool
    standing: Vector
    standing_heading: float
    landing: Vector
    landing_heading: float
    lift: float
    flight: float
    keys: list[Key]


@dataclass
class Joints:
    """Left, right where there are two."""

    root: Vector
    hips: list[Vector]
    knees: list[Vector]
    ankles: list[Vector]
    pitches: list[float]
    neck: Vector
    crown: Vector
    shoulders: list[Vector]
    elbows: list[Vector]
    wrists: list[Vector]


def smooth(s: float) -> float:
    s = min(max(s, 0.0), 1.0)
    return s * s * (3.0 - 2.0 * s)


def curve(values: list[Vector], u: float, *, ends_level: bool = False) -> Vector:
    v = [np.asarray(value, dtype=np.float64) for value in values]
    slopes = [(-3.0 * v[0] + 4.0 * v[1] - v[2]) / 2.0]
    slopes += [(v[k + 1] - v[k - 1]) / 2.0 for k in range(1, 5)]
    slopes.append((v[3] - 4.0 * v[4] + 3.0 * v[5]) / 2.0 * (not ends_level))
    k = min(int(5.0 * u), 4)
    s = 5.0 * u - k
    after = smooth(s)
    return np.asarray(
        (1.0 - after) * v[k]
        + after * v[k + 1]
        + s * (1.0 - s) ** 2 * slopes[k]
        - s * s * (1.0 - s) * slopes[k + 1]
    )


def turned(quaternions: list[Vector], u: float) -> Vector:
    near = [quaternions[0]]
    for one in quaternions[1:]:
        near.append(one if one @ near[-1] >= 0.0 else -one)
    found = curve(near, u)
    return np.asarray(found / np.linalg.norm(found))


def at(keys: list[Key], u: float) -> Key:
    def of(name: str, *, ends_level: bool = False) -> Vector:
        return curve([getattr(key, name) for key in keys], u, ends_level=ends_level)

    return Key(
        of("root"),
        turned([key.pelvis for key in keys], u),
        of("ankle", ends_level=True),
        float(of("swing_pitch", ends_level=True)),
        float(of("standing_pitch")),
        float(of("swing_heading", ends_level=True)),
        turned([key.chest for key in keys], u),
        of("arms"),
    )


def drawn(step: Step, u: float, leg_m: float, stature_m: float) -> Joints:
    key = at(step.keys, u)
    foot_m = FOOT * leg_m

    def ankle_from_toe(pitch: float, heading: float) -> Vector:
        level = foot_m * math.cos(pitch)
        return np.array(
            [-level * math.cos(heading), -level * math.sin(heading), -foot_m * math.sin(pitch)]
        )

    heading, pitch = step.standing_heading, key.standing_pitch
    ankle = step.standing.copy()
    if pitch < 0.0:
        ankle += ankle_from_toe(pitch, heading) - ankle_from_toe(0.0, heading)
    ankle += towed(step, u)
    stands = ankle, pitch, heading, smooth(-pitch / 0.1)

    heading, pitch = step.landing_heading + key.swing_heading, key.swing_pitch
    ankle, degree = step.landing + key.ankle, 0.0
    if step.lift > 0.0:
        degree = 1.0 - smooth((u - step.lift) / 0.1)
        first, then = at(step.keys, 0.0), at(step.keys, min(u, step.lift))
        toe = first.ankle - ankle_from_toe(
            first.swing_pitch, step.landing_heading + first.swing_heading
        )
        there = ankle_from_toe(then.swing_pitch, step.landing_heading + then.swing_heading)
        ankle = ankle + degree * (toe + there - then.ankle)
    swings = ankle, pitch, heading, degree * smooth(-pitch / 0.1)

    feet = [swings, stands] if step.right_stands else [stands, swings]
    return with_joints(step, key, feet, leg_m, (stature_m - leg_m) / 0.852, ankle_from_toe)


def towed(step: Step, u: float) -> Vector:
    f = step.flight
    if f <= 0.0 or u <= 1.0 - f:
        return np.zeros(3)
    w = (u - 1.0 + f) / f
    way = (step.keys[5].root - step.keys[0].root)[:2]
    return np.array([*(0.5 * f * w * w * way), 0.45 * f * w * w * math.hypot(*way)])


def with_joints(step, key, feet, leg_m, trunk_m, ankle_from_toe) -> Joints:
    root = step.standing + key.root
    reach = REACH * leg_m
    hips = [root + rotated(key.pelvis, [0.0, side * HIP * leg_m, 0.0]) for side in (1.0, -1.0)]
    ankles, pitches = [], []
    for hip, foot in zip(hips, feet, strict=True):
        ankle, pitch, heading, degree = foot
        toe = ankle - ankle_from_toe(pitch, heading)
        if degree > 0.0 and np.linalg.norm(hip - ankle) > reach:
            foot_m = FOOT * leg_m
            offset = hip - toe
            a = offset[0] * math.cos(heading) + offset[1] * math.sin(heading)
            z = offset[2]
            c = (reach**2 - offset @ offset - foot_m**2) / (2.0 * foot_m * math.hypot(a, z))
            steeper = math.atan2(z, a) - math.acos(min(max(c, -1.0), 1.0))
            pitch = pitch + degree * (min(max(steeper, STEEPEST_RAD), pitch) - pitch)
            ankle = toe + ankle_from_toe(pitch, heading)
        ankles.append(ankle)
        pitches.append(pitch)
    drop_m = 0.0
    for hip, ankle in zip(hips, ankles, strict=True):
        r = min(math.hypot(*(hip - ankle)[:2]), reach)
        drop_m = max(drop_m, (hip - ankle)[2] - math.sqrt(reach**2 - r**2))
    root = root - [0.0, 0.0, drop_m]
    hips = [hip - [0.0, 0.0, drop_m] for hip in hips]
    forward = rotated(key.pelvis, [1.0, 0.0, 0.0])
    g = math.atan2(forward[1], forward[0])
    knees = [
        knee(hip, ankle, g, heading, leg_m)
        for hip, ankle, (_, _, heading, _) in zip(hips, ankles, feet, strict=True)
    ]
    spine = root + rotated(key.pelvis, [0.0, 0.0, SPINE * trunk_m])
    chest = product(key.pelvis, key.chest)
    shoulders, elbows, wrists = [], [], []
    for side, shoulder_rad, elbow_rad in (
        (1.0, key.arms[0], key.arms[2]),
        (-1.0, key.arms[1], key.arms[3]),
    ):
        place = spine + rotated(chest, [0.0, side * SHOULDER * trunk_m, NECK * trunk_m])
        shoulders.append(place)
        for flexion, length, kept in (
            (shoulder_rad, UPPER_ARM, elbows),
            (shoulder_rad + elbow_rad, FOREARM, wrists),
        ):
            along = [
                math.sin(flexion),
                side * math.sin(SPREAD_RAD) * math.cos(flexion),
                -math.cos(SPREAD_RAD) * math.cos(flexion),
            ]
            place = place + length * trunk_m * rotated(chest, along)
            kept.append(place)
    return Joints(
        root,
        hips,
        knees,
        ankles,
        pitches,
        spine + rotated(chest, [0.0, 0.0, NECK * trunk_m]),
        spine + rotated(chest, [0.0, 0.0, CROWN * trunk_m]),
        shoulders,
        elbows,
        wrists,
    )


def knee(hip: Vector, ankle: Vector, g: float, h: float, leg_m: float) -> Vector:
    line = ankle - hip
    way = line / np.linalg.norm(line)
    d = min(float(np.linalg.norm(line)), REACH * leg_m)
    m = (d * d + (THIGH**2 - SHIN**2) * leg_m**2) / (2.0 * d)
    aside = math.sqrt(max(0.0, (THIGH * leg_m) ** 2 - m * m))
    ahead = np.array([math.cos(g) + math.cos(h), math.sin(g) + math.sin(h), 0.0])
    ahead -= (ahead @ way) * way
    return np.asarray(hip + m * way + aside * ahead / np.linalg.norm(ahead))


def product(a: Vector, b: Vector) -> Vector:
    return np.array(
        [
            a[0] * b[0] - a[1:] @ b[1:],
            *(a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:])),
        ]
    )


def rotated(q: Vector, vector: list[float]) -> Vector:
    v = np.asarray(vector, dtype=np.float64)
    twice = 2.0 * np.cross(q[1:], v)
    return np.asarray(v + q[0] * twice + np.cross(q[1:], twice))

"""Steps drawn and begun, whole arrays at a time; tests hold the kernels to them."""

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.locomotion.body.sizes import BodySizes
from esplanade.actors.locomotion.body.skeleton import TRACK_HALF_WIDTH
from esplanade.actors.locomotion.gait.curves import smooth
from esplanade.actors.locomotion.motion._current_pose_kernels import CurrentPose
from esplanade.actors.locomotion.motion._leg_pose_kernels import EASE_RAD, KEY_REACH, STEEPEST_RAD
from esplanade.actors.locomotion.motion.key_poses import (
    ANKLE,
    CHEST,
    ELBOWS,
    KEYS,
    PELVIS,
    ROOT,
    SETTLE,
    SHOULDERS,
    STANDING_PITCH,
    SWING_HEADING,
    SWING_PITCH,
    WIDTH,
    Steps,
    heel_from_toe,
    standing_ankles,
)
from esplanade.actors.locomotion.motion.leg_poses import REACH, LegPoses
from esplanade.actors.locomotion.planted.footprints import StepFootprints
from esplanade.actors.locomotion.planted.targets import Targets
from esplanade.actors.locomotion.reference.posing import left_and_right
from esplanade.actors.locomotion.reference.rotations import about, multiply, normalise, rotate
from esplanade.planning.compiled.arrays import Floats
from tests.naive.headings import wrap_angle
from tests.naive.planted.flight import flown, towed

LANDING = [7, 8, 9, 10, 12]


def _tangents() -> Floats:
    """Slopes at the keys as weights of the keys, (KEYS, KEYS), per interval.

    Catmull-Rom inside; at the ends that of the parabola through three keys.
    """
    slopes = np.zeros((KEYS, KEYS))
    for k in range(1, KEYS - 1):
        slopes[k, k + 1], slopes[k, k - 1] = 0.5, -0.5
    slopes[0, :3] = -1.5, 2.0, -0.5
    slopes[-1, -3:] = 0.5, -2.0, 1.5
    return slopes


_TANGENTS = _tangents()
_VALUES = np.eye(KEYS)


def weights(u: Floats) -> Floats:
    """The weight of each key at shares u (N,) of a step: (N, KEYS); cubic Hermite curves."""
    place = np.clip(u, 0.0, 1.0) * (KEYS - 1)
    k = np.minimum(place.astype(np.int64), KEYS - 2)
    s = (place - k)[:, None]
    after = s * s * (3.0 - 2.0 * s)
    return np.asarray(
        (1.0 - after) * _VALUES[k]
        + after * _VALUES[k + 1]
        + s * (1.0 - s) ** 2 * _TANGENTS[k]
        - s * s * (1.0 - s) * _TANGENTS[k + 1]
    )


def interpolate(keys: Floats, u: Floats) -> Floats:
    """Keys (N, KEYS, WIDTH) at shares u (N,): (N, WIDTH).

    Quaternions follow the same curves, component by component, and are made unit again: keys of
    one step are some degrees apart, where that is as good as going along great circles. Neighbours
    among the keys must have the same sign (`align`). The swing foot comes to rest at the end, so
    there its curves are level.
    """
    out = np.einsum("nk,nkd->nd", weights(u), keys)
    s = np.clip(u * (KEYS - 1) - (KEYS - 2), 0.0, 1.0)
    slopes = np.einsum("k,nkd->nd", _TANGENTS[-1, -3:], keys[:, -3:, LANDING])
    out[:, LANDING] += (s * s * (1.0 - s))[:, None] * slopes
    for part in (PELVIS, CHEST):
        out[:, part] /= np.linalg.norm(out[:, part], axis=1, keepdims=True)
    return np.asarray(out)


def sample_keys(steps: Steps, u: Floats, foot_m: Floats) -> Floats:
    """The keys (N, WIDTH) by which steps are drawn at shares u (N,).

    Until toe-off the swing foot turns about its toe, which stays where key 0 has it; after that the
    difference to its curve fades.
    """
    out = interpolate(steps.keys, u)
    pinned = steps.lift > 0.0
    if not pinned.any():
        return out
    first = steps.keys[pinned, 0]
    lift, foot_m, heading = steps.lift[pinned], foot_m[pinned], steps.landing[pinned, 3]
    toe = first[:, ANKLE] - heel_from_toe(
        first[:, SWING_PITCH], first[:, SWING_HEADING] + heading, foot_m
    )
    here = np.minimum(u[pinned], lift)
    at = interpolate(steps.keys[pinned], here)
    ankle = toe + heel_from_toe(at[:, SWING_PITCH], at[:, SWING_HEADING] + heading, foot_m)
    fade = 1.0 - smooth((u[pinned] - lift) / SETTLE)
    out[pinned, ANKLE] += fade[:, None] * (ankle - at[:, ANKLE])
    return out


def leg_poses(
    steps: Steps, u: Floats, key: Floats, sizes: BodySizes, reach_share: float = REACH
) -> LegPoses:
    """Legs of N steps at shares u (N,), where `sample_keys` has given keys (N, WIDTH)."""
    root = steps.standing[:, :3] + key[:, ROOT]
    ankles, pitches, headings, raised = _feet(steps, u, key, sizes)
    hips = root[:, None] + rotate(
        key[:, None, PELVIS],
        left_and_right(TRACK_HALF_WIDTH * sizes.leg_m, np.zeros_like(sizes.leg_m)),
    )
    reach = reach_share * sizes.leg_m[:, None]
    _raise_heels(hips, ankles, pitches, headings, raised, sizes, reach)
    root, hips = _lower(root, hips, ankles, reach)
    return LegPoses(root, hips, ankles, pitches, headings)


def _feet(
    steps: Steps, u: Floats, key: Floats, sizes: BodySizes
) -> tuple[Floats, Floats, Floats, Floats]:
    """Ankles (N, 2, 3), pitches, headings (N, 2), and how far each stands on its toe (N, 2)."""
    standing = standing_ankles(steps.standing, key[:, STANDING_PITCH], sizes.foot_m)
    travel = steps.keys[:, -1, :2] - steps.keys[:, 0, :2]
    standing = standing + flown(u, steps.flight)[:, None] ** 2 * towed(travel, steps.flight)
    swing = steps.landing[:, :3] + key[:, ANKLE]
    right = steps.on_right.astype(np.int64)
    rows = np.arange(len(right))
    ankles = np.empty((len(right), 2, 3))
    ankles[rows, right], ankles[rows, 1 - right] = standing, swing
    pitches, headings, raised = (np.empty((len(right), 2)) for _ in range(3))
    pitches[rows, right], pitches[rows, 1 - right] = key[:, STANDING_PITCH], key[:, SWING_PITCH]
    headings[rows, right] = steps.standing[:, 3]
    headings[rows, 1 - right] = steps.landing[:, 3] + key[:, SWING_HEADING]
    raised[rows, right] = smooth(-key[:, STANDING_PITCH] / EASE_RAD)
    on_toe = np.where(steps.lift > 0.0, 1.0 - smooth((u - steps.lift) / SETTLE), 0.0)
    raised[rows, 1 - right] = on_toe * smooth(-key[:, SWING_PITCH] / EASE_RAD)
    return ankles, pitches, headings, raised


def _raise_heels(
    hips: Floats,
    ankles: Floats,
    pitches: Floats,
    headings: Floats,
    raised: Floats,
    sizes: BodySizes,
    reach: Floats,
) -> None:
    """Turn feet on their toes about the toe where the leg is too short for them; in place."""
    short = (np.linalg.norm(ankles - hips, axis=2) > reach) & (raised > 0.0)
    if not short.any():
        return
    foot = np.broadcast_to(sizes.foot_m[:, None], short.shape)[short]
    reach = np.broadcast_to(reach, short.shape)[short]
    pitch, heading = pitches[short], headings[short]
    toe = ankles[short] - heel_from_toe(pitch, heading, foot)
    hip = hips[short] - toe
    along = hip[:, 0] * np.cos(heading) + hip[:, 1] * np.sin(heading)
    # The heel is at -foot (cos p, sin p): as far from the hip as the leg reaches.
    cosine = (reach**2 - np.einsum("nd,nd->n", hip, hip) - foot**2) / (
        2.0 * foot * np.hypot(along, hip[:, 2])
    )
    steeper = np.arctan2(hip[:, 2], along) - np.arccos(np.clip(cosine, -1.0, 1.0))
    steeper = np.minimum(np.maximum(steeper, STEEPEST_RAD), pitch)
    pitch = pitch + raised[short] * (steeper - pitch)
    pitches[short] = pitch
    ankles[short] = toe + heel_from_toe(pitch, heading, foot)


def _lower(root: Floats, hips: Floats, ankles: Floats, reach: Floats) -> tuple[Floats, Floats]:
    """Bring the hips down until both legs reach their feet."""
    legs = hips - ankles
    level2 = np.minimum(legs[..., 0] ** 2 + legs[..., 1] ** 2, reach**2)
    drop = np.maximum(legs[..., 2] - np.sqrt(reach**2 - level2), 0.0).max(axis=1)
    down = np.zeros_like(root)
    down[:, 2] = -drop
    return root + down, hips + down[:, None]


def inertialise(
    keys: Floats,
    now: CurrentPose,
    re_aimed: NDArray[np.bool_],
    from_air: NDArray[np.bool_],
    ticks: NDArray[np.int64],
    aside: Floats,
) -> Floats:
    """Keys that begin with the current pose, in value and speed, and end aside."""
    keys, first, speed = keys.copy(), now.key.copy(), now.speed.copy()
    for part in (PELVIS, CHEST):
        other = np.einsum("nd,nd->n", first[:, part], keys[:, 0, part]) < 0.0
        first[other, part] *= -1.0
        speed[other, part] *= -1.0
    missing = first - keys[:, 0]
    missing[:, SWING_HEADING] = wrap_angle(missing[:, SWING_HEADING])
    share = smooth(np.linspace(0.0, 1.0, KEYS))
    keys += (1.0 - share)[None, :, None] * missing[:, None]
    keys[..., :2] += share[None, :, None] * aside[:, None]
    slope = speed * ticks[:, None]
    second = (2.0 * slope / (KEYS - 1) + 3.0 * keys[:, 0] + keys[:, 2]) / 4.0
    body = np.ones(WIDTH, dtype=np.bool_)
    body[ANKLE] = False
    body[[SWING_PITCH, STANDING_PITCH, SWING_HEADING]] = False
    swing = np.zeros(WIDTH, dtype=np.bool_)
    swing[ANKLE] = swing[SWING_PITCH] = True
    free = body | re_aimed[:, None] | from_air[:, None] & swing
    keys[:, 1] = np.where(free, second, keys[:, 1])
    for part in (PELVIS, CHEST):
        keys[..., part] = normalise(keys[..., part])
    return keys


def keys_of(targets: Targets, footprints: StepFootprints) -> Floats:
    """Keys (N, K, WIDTH) of targets."""
    keys = np.empty((*targets.yaw.shape, WIDTH))
    keys[..., ROOT] = targets.root - footprints.standing[:, None, :3]
    forward, left, up = np.eye(3)
    pelvis = multiply(about(up, targets.yaw), about(left, targets.lean))
    keys[..., PELVIS] = multiply(pelvis, about(forward, targets.roll))
    keys[..., ANKLE] = targets.swing_ankle - footprints.landing[:, None, :3]
    keys[..., SWING_PITCH] = targets.swing_pitch
    keys[..., STANDING_PITCH] = targets.standing_pitch
    heading = targets.swing_heading - footprints.landing[:, None, 3]
    turns = np.round(heading[:, -1:] / (2.0 * np.pi))
    keys[..., SWING_HEADING] = heading - 2.0 * np.pi * turns
    keys[..., CHEST] = multiply(about(forward, -targets.roll), about(up, targets.torsion))
    keys[..., SHOULDERS] = targets.shoulders
    keys[..., ELBOWS] = targets.elbows
    return keys


def let_legs_reach(steps: Steps, sizes: BodySizes) -> None:
    """Bring the last keys of N steps to what is drawn of them; in place."""
    legs = leg_poses(steps, np.ones(len(steps.lift)), steps.keys[:, -1], sizes, KEY_REACH)
    rows, stands = np.arange(len(steps.lift)), steps.on_right.astype(np.int64)
    last = steps.keys[:, -1]
    last[:, ROOT] = legs.root - steps.standing[:, :3]
    last[:, ANKLE] = legs.ankles[rows, 1 - stands] - steps.landing[:, :3]
    last[:, STANDING_PITCH] = legs.pitches[rows, stands]
    last[:, SWING_PITCH] = legs.pitches[rows, 1 - stands]


def align(keys: Floats) -> None:
    """Give quaternions of keys (N, KEYS, WIDTH) the sign nearest to the key before; in place."""
    for part in (PELVIS, CHEST):
        for k in range(1, KEYS):
            dots = np.einsum("nd,nd->n", keys[:, k, part], keys[:, k - 1, part])
            keys[dots < 0.0, k, part] *= -1.0

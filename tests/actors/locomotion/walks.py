"""Ways to walk, and what is seen of them: joints solved from targets, feet put back by them."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.locomotion.body.skeleton import FOOT, TRACK_HALF_WIDTH
from esplanade.actors.locomotion.planted.footprints import StepFootprints
from esplanade.actors.locomotion.planted.step import step_targets
from esplanade.actors.locomotion.planted.targets import Targets
from esplanade.actors.locomotion.reference.limbs import LegAngles, leg_ends, leg_ik

Floats = NDArray[np.float64]


def step_footprints(prints, *, right_lifts=True, leg_m=1.0) -> StepFootprints:
    """Steps through footprints (x, y, z, heading) of alternating feet; the first one lifts."""
    prints = np.array(prints, dtype=float)
    count = len(prints) - 2
    right = np.arange(count) % 2 == (1 if right_lifts else 0)
    return StepFootprints(right, prints[:-2], prints[1:-1], prints[2:], np.full(count, leg_m))


def aside(k: int) -> float:
    """The distance of foot number k to the left of a straight way; foot 0 is a right one."""
    return -TRACK_HALF_WIDTH if k % 2 == 0 else TRACK_HALF_WIDTH


def straight(lengths) -> StepFootprints:
    """Steps along +x of given lengths, from standing."""
    ahead = np.concatenate([[0.0, 0.0], np.cumsum(lengths)])
    return step_footprints([(x, aside(k), 0.0, 0.0) for k, x in enumerate(ahead)])


def arc(radius: float, length: float, steps: int) -> StepFootprints:
    """Steps round a bend to the left, steady from the first step."""
    prints = []
    for k in range(steps + 2):
        turned = k * length / radius
        out = radius - aside(k)
        prints.append((out * np.sin(turned), radius - out * np.cos(turned), 0.0, turned))
    return step_footprints(prints)


def staircase(rise: float, tread: float, steps: int) -> StepFootprints:
    """One tread a step; downstairs when the rise is negative."""
    return step_footprints([(k * tread, aside(k), k * rise, 0.0) for k in range(steps + 2)])


def backward(length: float, steps: int) -> StepFootprints:
    return step_footprints([(-k * length, aside(k), 0.0, 0.0) for k in range(steps + 2)])


def sideways(length: float, steps: int) -> StepFootprints:
    """Steps to the left: the left foot goes, the right one closes."""
    prints = [(0.0, TRACK_HALF_WIDTH, 0.0, 0.0), (0.0, -TRACK_HALF_WIDTH, 0.0, 0.0)]
    for k in range(steps):
        place = length * (k // 2 + 1)
        prints.append((0.0, place + (TRACK_HALF_WIDTH if k % 2 == 0 else -TRACK_HALF_WIDTH), 0, 0))
    return step_footprints(prints, right_lifts=False)


def on_the_spot(degrees: float, steps: int) -> StepFootprints:
    """Turning to the left: the left foot goes, the right one follows."""
    prints = [(0.0, TRACK_HALF_WIDTH, 0.0, 0.0), (0.0, -TRACK_HALF_WIDTH, 0.0, 0.0)]
    for k in range(steps):
        turned = np.radians(degrees) * (k // 2 + 1)
        out = TRACK_HALF_WIDTH if k % 2 == 0 else -TRACK_HALF_WIDTH
        prints.append((-out * np.sin(turned), out * np.cos(turned), 0.0, turned))
    return step_footprints(prints, right_lifts=False)


class Walked(NamedTuple):
    """LegPoses of N steps at K shares; of a pair the standing leg comes first."""

    footprints: StepFootprints
    targets: Targets
    joints: Floats
    """(N, K, 2, 5): hip yaw, abduction, flexion, knee, ankle; radians."""
    missed: Floats
    """(N, K, 2): metres by which targets are out of reach."""
    heels: Floats
    """(N, K, 2, 3): metres, world; by forward kinematics from the joints."""
    toes: Floats
    """(N, K, 2, 3)."""


def walk(footprints: StepFootprints, samples: int = 2000) -> Walked:
    """Solve both legs at so many shares of each step, and put the feet where the angles say."""
    targets = step_targets(footprints, np.linspace(0.0, 1.0, samples + 1))
    leg_m = footprints.leg_m[:, None]
    pelvis = _pelvis(targets.yaw, targets.lean, targets.roll)
    standing = _standing_ankle(footprints, targets)
    heading = np.broadcast_to(footprints.standing[:, 3, None], targets.yaw.shape)
    feet = (
        (1.0, standing, targets.standing_pitch, heading),
        (-1.0, targets.swing_ankle, targets.swing_pitch, targets.swing_heading),
    )
    first = np.where(footprints.on_right, -1.0, 1.0)[:, None]
    seen = [_leg(targets, pelvis, first * which, leg_m, *foot) for which, *foot in feet]
    return Walked(
        footprints, targets, *(np.stack(part, axis=2) for part in zip(*seen, strict=True))
    )


def _pelvis(yaw: Floats, lean: Floats, roll: Floats) -> Floats:
    """Rz(yaw) Ry(lean) Rx(roll), (N, K, 3, 3)."""
    (cy, sy), (cl, sl), (cr, sr) = ((np.cos(a), np.sin(a)) for a in (yaw, lean, roll))
    zero, one = np.zeros_like(yaw), np.ones_like(yaw)
    turned = np.array([[cy, -sy, zero], [sy, cy, zero], [zero, zero, one]])
    bowed = np.array([[cl, zero, sl], [zero, one, zero], [-sl, zero, cl]])
    rolled = np.array([[one, zero, zero], [zero, cr, -sr], [zero, sr, cr]])
    return np.einsum("ijnk,jlnk,lmnk->nkim", turned, bowed, rolled)


def _standing_ankle(footprints: StepFootprints, targets: Targets) -> Floats:
    """The ankle: the foot is on its heel while the toe is up, else it turns about its toe."""
    pitch = np.minimum(targets.standing_pitch, 0.0)
    heading = footprints.standing[:, 3, None]
    foot = FOOT * footprints.leg_m[:, None]
    heel_forward = foot * (1.0 - np.cos(pitch))
    moved = np.stack(
        [heel_forward * np.cos(heading), heel_forward * np.sin(heading), -foot * np.sin(pitch)], -1
    )
    return footprints.standing[:, None, :3] + moved


def _leg(targets, pelvis, side, leg_m, ankle, pitch, heading):
    """Joints, misses, heels and toes of one leg; side (N, 1) is 1 for the left one."""
    joint = np.einsum("nkij,j->nki", pelvis, (0.0, TRACK_HALF_WIDTH, 0.0))
    hip = targets.root + (side * leg_m)[..., None] * joint
    local = np.einsum("nkji,nkj->nki", pelvis, ankle - hip) / leg_m[..., None]
    ahead = np.stack([np.cos(heading), np.sin(heading), np.zeros_like(heading)], axis=-1)
    ahead = np.einsum("nkji,nkj->nki", pelvis, ahead)
    angles, missed = leg_ik(local, np.arctan2(ahead[..., 1], ahead[..., 0]))
    reached = np.einsum("nkij,nkj->nki", pelvis, leg_ends(LegAngles(*angles))[1])
    heel = hip + leg_m[..., None] * reached
    toward = np.stack(
        [np.cos(pitch) * np.cos(heading), np.cos(pitch) * np.sin(heading), np.sin(pitch)], axis=-1
    )
    joints = np.stack([*angles, pitch - angles.flexion + angles.knee], axis=-1)
    return joints, missed * leg_m, heel, heel + FOOT * leg_m[..., None] * toward


def slide(walked: Walked) -> float:
    """The greatest movement, in metres, of any point that should rest on the ground."""
    pitch = walked.targets.standing_pitch
    footprint = walked.footprints.standing
    toe = footprint[:, :3] + FOOT * walked.footprints.leg_m[:, None] * np.stack(
        [np.cos(footprint[:, 3]), np.sin(footprint[:, 3]), np.zeros(len(footprint))], axis=1
    )
    on_heel = np.linalg.norm(walked.heels[:, :, 0] - footprint[:, None, :3], axis=2)
    on_toe = np.linalg.norm(walked.toes[:, :, 0] - toe[:, None], axis=2)
    u = np.linspace(0.0, 1.0, pitch.shape[1])
    trailing = np.linalg.norm(walked.toes[:, :, 1] - walked.toes[:, :1, 1], axis=2)
    return max(
        np.where(pitch > 0.0, on_heel, on_toe).max(),
        np.where(u < walked.targets.lift[:, None], trailing, 0.0).max(),
    )


def landing_error(walked: Walked) -> float:
    """Metres between where feet come down and their footprints."""
    return np.abs(walked.heels[:, -1, 1] - walked.footprints.landing[:, :3]).max()


def gaps(walked: Walked) -> tuple[float, float]:
    """Largest jump of a joint, and of its speed (radians a step), from a step to the next."""
    end, start = walked.joints[:-1, :, ::-1], walked.joints[1:]
    count = walked.joints.shape[1] - 1
    end_speed = (3.0 * end[:, -1] - 4.0 * end[:, -2] + end[:, -3]) * count / 2.0
    start_speed = (-3.0 * start[:, 0] + 4.0 * start[:, 1] - start[:, 2]) * count / 2.0
    return np.abs(end[:, -1] - start[:, 0]).max(), np.abs(end_speed - start_speed).max()


def top_speed(walked: Walked) -> float:
    """The greatest speed of hip flexion and knee, radians a step."""
    count = walked.joints.shape[1] - 1
    return np.abs(np.diff(walked.joints[..., 2:4], axis=1)).max() * count


def depth(walked: Walked, ground=lambda place: np.zeros(place.shape[:-1])) -> float:
    """The greatest depth of a heel or toe in the ground, metres; negative when all stay above."""
    return max((ground(point) - point[..., 2]).max() for point in (walked.heels, walked.toes))

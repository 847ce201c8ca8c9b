"""A body made of rounded parts, from its joints."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from esplanade.actors.locomotion.reference.posing import Pose
from esplanade.actors.locomotion.reference.rotations import rotate
from esplanade.planning.compiled.arrays import Floats

SKIN: Final = "#e3b08a"
HAIR: Final = "#4a3222"
SHIRT: Final = "#c8573b"
TROUSERS: Final = ("#3f5f82", "#2c4059")
"""Colours of the left and the right leg, which differ so that they are told apart."""
SLEEVES: Final = ("#d2694a", "#a8452d")
SHOES: Final = ("#4a3a2e", "#332820")

_HEAD_M: Final = 0.105


class Part(NamedTuple):
    """A part of a body: the convex hull of some balls."""

    centres: Floats
    """(K, 3), metres."""
    radii_m: Floats
    """(K,)"""
    colour: str


def parts_of(poses: Pose, frame: int) -> list[Part]:
    """The parts of a body in one frame."""
    joints = Pose._make(values[frame] for values in poses)
    up = rotate(joints.chest, [0.0, 0.0, 1.0])
    forward = rotate(joints.chest, [1.0, 0.0, 0.0])
    head = joints.head - _HEAD_M * up
    chest = joints.shoulders - 0.05 * up
    made = [
        _part(SHIRT, *((point, 0.075) for point in chest), (joints.lumbar, 0.11)),
        _part(SHIRT, (joints.lumbar, 0.115), *((hip, 0.085) for hip in joints.hips)),
        _part(SKIN, (joints.neck, 0.05), (head - 0.06 * up, 0.05)),
        _part(SKIN, (head + 0.01 * forward, 0.09), (head + 0.035 * forward - 0.07 * up, 0.055)),
        _part(SKIN, (head + 0.105 * forward - 0.015 * up, 0.02)),
        _part(HAIR, (head - 0.035 * forward + 0.02 * up, 0.08), (head + 0.048 * up, 0.066)),
    ]
    for side in range(2):
        made += _leg(joints, side) + _arm(joints, side)
    return made


def _leg(joints: Pose, side: int) -> list[Part]:
    heel, toe = joints.ankles[side], joints.toes[side]
    along = (toe - heel) / np.linalg.norm(toe - heel)
    sole = np.array([0.0, 0.0, 0.035])
    ankle = heel + np.array([0.0, 0.0, 0.085])
    return [
        _part(TROUSERS[side], (joints.hips[side], 0.088), (joints.knees[side], 0.06)),
        _part(TROUSERS[side], (joints.knees[side], 0.058), (ankle, 0.042)),
        _part(
            SHOES[side],
            (heel + sole + 0.005 * along, 0.036),
            (ankle, 0.04),
            (toe + sole * 0.8, 0.028),
            (toe + sole * 0.75 + 0.05 * along, 0.025),
        ),
    ]


def _arm(joints: Pose, side: int) -> list[Part]:
    shoulder, elbow, hand = joints.shoulders[side], joints.elbows[side], joints.hands[side]
    reach = hand + 0.07 * (hand - elbow) / np.linalg.norm(hand - elbow)
    return [
        _part(SLEEVES[side], (shoulder, 0.06), (elbow, 0.045)),
        _part(SLEEVES[side], (elbow, 0.044), (hand, 0.033)),
        _part(SKIN, (hand, 0.033), (reach, 0.03)),
    ]


def _part(colour: str, *balls: tuple[Floats, float]) -> Part:
    return Part(
        np.array([centre for centre, _ in balls]), np.array([radius for _, radius in balls]), colour
    )

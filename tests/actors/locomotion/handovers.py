"""One step after the other as clients receive them: where the first ends and the next begins."""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from esplanade.actors.locomotion.body.sizes import BodySizes
from esplanade.actors.locomotion.reference.posing import pose
from esplanade.planning.compiled.arrays import Floats
from esplanade.protocol.steps import (
    RE_AIMED,
    STANDS_ON_RIGHT,
    StepRecords,
    landing_footprints,
)
from esplanade.server.world.step_records import from_records

PELVIS = ("yaw", "lean", "roll")


@dataclass(frozen=True)
class Handovers:
    """N moments at which a record takes the place of another one of the same avatar.

    Differences are those of numbers in the records, unless a unit is given.
    """

    re_aimed: NDArray[np.bool_]
    """(N,): whether the first step was still under way."""
    root: NDArray[np.int64]
    """(N, 3): of the root's place in the world at the last key and the first one."""
    pelvis: NDArray[np.int64]
    """(N, 3): of the yaw, lean and roll of the pelvis."""
    pitches: NDArray[np.int64]
    """(N, 2): of the pitches of the foot that stands next, and of the one that swings next."""
    footprint: NDArray[np.int64]
    """(N, 4): of the footprint of the foot that stands next."""
    upper_body: NDArray[np.int64]
    """(N, 5): of the twist of the chest and the bends of the arms."""
    drawn_root_m: Floats
    """(N,): distance of the hips from record to record, as they are drawn."""
    drawn_ankles_m: Floats
    """(N,): the same of the ankle that moves further."""
    drawn_headings_rad: Floats
    """(N,): the same of the foot that turns further."""


def handovers(pairs: Iterable[tuple[StepRecords, StepRecords]], sizes: BodySizes) -> Handovers:
    """Of pairs of records (1,) of one avatar, in the order in which a client receives them."""
    first, second = (np.concatenate(side) for side in zip(*pairs, strict=True))
    swapped = (first["flags"] ^ second["flags"]) & STANDS_ON_RIGHT != 0
    last, begin = first["last"], second["first"]

    def whole(column: NDArray[np.generic]) -> NDArray[np.int64]:
        return column.astype(np.int64)

    stands_next = np.where(swapped, last["swing_pitch"], last["standing_pitch"])
    swings_next = np.where(swapped, last["standing_pitch"], last["swing_pitch"])
    before = np.where(swapped, landing_footprints(first), first["standing"])
    footprint = whole(second["standing"]["position"]) - whole(before["position"])
    turned = whole(second["standing"]["heading"]) - whole(before["heading"])
    old, new = from_records(first), from_records(second)
    ends = pose(old, np.clip((new.start - old.start) / np.maximum(old.ticks, 1), 0.0, 1.0), sizes)
    begins = pose(new, np.zeros(len(second)), sizes)
    headings = begins.headings - ends.headings
    return Handovers(
        second["flags"] & RE_AIMED != 0,
        whole(second["standing"]["position"])
        + whole(begin["root"])
        - whole(first["standing"]["position"])
        - whole(last["root"]),
        whole(np.stack([begin[name] for name in PELVIS], axis=1))
        - whole(np.stack([last[name] for name in PELVIS], axis=1)),
        np.stack(
            [
                whole(begin["standing_pitch"]) - whole(stands_next),
                whole(begin["swing_pitch"]) - whole(swings_next),
            ],
            axis=1,
        ),
        np.column_stack([footprint, turned]),
        np.column_stack(
            [
                whole(begin["twist"]) - whole(last["twist"]),
                whole(begin["arms"]) - whole(last["arms"]),
            ]
        ),
        np.linalg.norm(begins.root - ends.root, axis=1),
        np.linalg.norm(begins.ankles - ends.ankles, axis=2).max(axis=1),
        np.abs((headings + np.pi) % (2.0 * np.pi) - np.pi).max(axis=1),
    )

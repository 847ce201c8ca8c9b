"""The cycle of figures that are far away: eight keys of a walking body, shared by all of them.

Browsers get no steps of figures that are far away. They mix these keys by the distance that a
figure has gone. Lengths are shares of the leg's, from a point on the ground that moves along at a
steady pace.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any, Final

import numpy as np

from esplanade.actors.locomotion.gait.curves import smooth
from esplanade.actors.locomotion.gait.durations import step_duration_s
from esplanade.actors.locomotion.reference.keyframes import (
    CHEST,
    ELBOWS,
    PELVIS,
    SHOULDERS,
    exact,
    feet_of,
    key_phases,
)
from esplanade.planning.compiled.arrays import Floats

STEP: Final = 0.55
"""Length of a step of the cycle, leg lengths."""

_DIGITS: Final = 4
_ON_TOE_RAD: Final = 0.1
"""A foot stands on its toe alone from this pitch on."""
_ON_GROUND: Final = 1e-6


def cycle(step_length: float = STEP) -> dict[str, Any]:
    """The cycle as clients need it, in values that JSON has.

    The length of its steps is in leg lengths.
    """
    phases = key_phases(step_length)
    keys = [
        {"phase": _rounded(phase), **posture}
        for phase, posture in zip(phases, _postures(step_length, phases), strict=True)
    ]
    return {
        "step": step_length,
        "timing": _rounded(step_length * float(step_duration_s(step_length))),
        "stand": next(_postures(0.0, np.zeros(1))),
        "keys": keys,
    }


def as_text(value: object, indent: int = 0) -> str:
    """JSON with an entry on each line, and the numbers of a row side by side."""
    inner = " " * (indent + 2)
    if isinstance(value, dict):
        entries = [f"{inner}{json.dumps(k)}: {as_text(v, indent + 2)}" for k, v in value.items()]
        return "{\n" + ",\n".join(entries) + f"\n{' ' * indent}}}"
    if isinstance(value, list) and value and isinstance(value[0], dict):
        entries = [inner + as_text(entry, indent + 2) for entry in value]
        return "[\n" + ",\n".join(entries) + f"\n{' ' * indent}]"
    return json.dumps(value)


def _postures(step_length: float, phases: Floats) -> Iterator[dict[str, Any]]:
    """The body at phases (N,) of the cycle."""
    frames = exact(step_length, phases)
    legs = feet_of(frames)
    on_ground = np.abs(legs.toes[..., 2]) < _ON_GROUND
    raised = np.where(on_ground, smooth(-legs.pitches / _ON_TOE_RAD), 0.0)
    arms = {
        name: -2.0 * np.arctan2(frames.joints[:, part, 2], frames.joints[:, part, 0])
        for name, part in (("shoulder", SHOULDERS), ("elbow", ELBOWS))
    }
    for n in range(len(phases)):
        posture: dict[str, Any] = {
            "root": _rounded(frames.root[n]),
            "pelvis": _rounded(frames.joints[n, PELVIS]),
            "chest": _rounded(frames.joints[n, CHEST]),
        }
        for side, name in enumerate(("left", "right")):
            posture[name] = {
                "heel": _rounded(legs.ankles[n, side]),
                "pitch": _rounded(legs.pitches[n, side]),
                "raised": _rounded(raised[n, side]),
            }
        for side, name in enumerate(("leftArm", "rightArm")):
            posture[name] = {part: _rounded(angles[n, side]) for part, angles in arms.items()}
        yield posture


def _rounded(values: Floats | float) -> Any:
    """Values as numbers of Python, without a minus before zero."""
    return (np.round(values, _DIGITS) + 0.0).tolist()

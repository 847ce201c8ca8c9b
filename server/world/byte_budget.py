"""The bytes that a viewer may be sent, so that a crowd costs it no more than a few near by.

Every tick adds to a viewer's credit. Avatars that come into view or go out of it are told of at
once, and charged. Its own record and step are always sent; the rest goes to steps of the nearest
first, and then to records. Where credit falls short, what waits is sent in a later tick, and steps
are sent of fewer avatars from then on: clients draw the others by the gait that is common to all.
"""

from typing import Final

from esplanade.protocol import encode_snapshot, encode_steps
from esplanade.protocol.snapshot import RECORD
from esplanade.protocol.steps import STEP
from esplanade.server.world.compiled._snapshot_kernels import Budget
from esplanade.server.world.rules import Rules

NEAR: Final = 8
"""This many avatars in view, the viewer itself among them, are near: told of in every tick."""
FAR_S: Final = 0.2
"""Time between two records of one of the others."""
STEPPING_S: Final = 1.0
"""Time between two records of an avatar that walks by steps which the viewer has."""
BURST_S: Final = 0.2
"""Credit that was not used lasts for this time."""
CALM_S: Final = 2.0
"""After this time without shortage, steps of more avatars are tried."""
SETTLING_S: Final = 0.5
"""After this time steps are sent of fewer for certain, and most of what waited is sent."""
FIRST_REACH: Final = 16
"""Steps are sent to a newcomer of this many avatars, itself among them, until more are tried."""

_WEBSOCKET_HEAD: Final = 4
"""Bytes before a payload of 126 bytes to 64 KiB."""
_BLOCK_HEAD: Final = 1
"""A block of 256 bytes or more says its length in one byte more than an empty one."""


def byte_budget(rules: Rules) -> Budget:
    """The budget of each viewer."""
    rate = rules.tick_rate
    refill = rules.viewer_bytes // rate
    head = _WEBSOCKET_HEAD + _BLOCK_HEAD
    return Budget(
        refill=refill,
        most=refill + round(BURST_S * rules.viewer_bytes),
        record=RECORD.itemsize,
        step=STEP.itemsize,
        snapshot_head=head + len(encode_snapshot(0, 0, b"")),
        steps_head=head + len(encode_steps(0, b"")),
        near=NEAR,
        far_ticks=max(1, round(FAR_S * rate)),
        stepping_ticks=max(1, round(STEPPING_S * rate)),
        calm_ticks=max(1, round(CALM_S * rate)),
        settling_ticks=max(1, round(SETTLING_S * rate)),
    )

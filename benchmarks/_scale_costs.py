"""The costs of a second of a simulated world, by the measured constants."""

from typing import NamedTuple

import numpy as np
from benchmarks._scale_constants import Constants
from benchmarks._scale_world import Second


class Costs(NamedTuple):
    """Cores, and bytes and transactions a second."""

    zone_cores: float
    gateway_cores: float
    broker_cores: float
    """Of all brokers together."""
    inside_bytes: float
    """Between hosts and gateways, through the broker once."""
    out_bytes: float
    """From gateways to people."""
    commits: float
    checkpoint_bytes: float


def costs_of(second: Second, constants: Constants) -> Costs:
    """The costs of a second."""
    one, people = constants, float(second.in_zone.sum())
    zones, used = len(second.in_zone), float((second.in_zone > 0).sum())
    ticks = one.tick_hz
    frames = second.frames
    gateways = len(second.at_gateway)
    made = one.frame_make_us * people + one.message_us * used
    tick = (one.host_tick_us + one.zone_tick_us) * zones + one.zone_person_us * people
    read = one.frame_read_us * second.frame_people + one.message_us * frames
    # A batch of inputs goes up wherever a frame comes down.
    batches = one.message_us * frames
    carried = used + 2.0 * frames
    shown = one.gateway_tick_us * gateways + one.gateway_zone_us * frames
    others = (second.in_zone - 1).clip(min=0)
    seen = np.minimum(one.seen_part * others, one.most_seen)
    viewer_bytes = np.minimum(
        one.lone_viewer_bytes_s + one.seen_avatar_bytes_s * seen, one.viewer_bytes_s
    )
    frame_bytes = one.frame_head_bytes * frames + one.frame_avatar_bytes * second.frame_people
    upward = one.inputs_s * one.input_bytes * people
    return Costs(
        zone_cores=1e-6 * ticks * (tick + made + batches),
        gateway_cores=1e-6 * ticks * (shown + read + batches + one.viewer_us * people),
        broker_cores=1e-6 * ticks * one.broker_message_us * carried,
        inside_bytes=ticks * frame_bytes + upward,
        out_bytes=float((viewer_bytes * second.in_zone).sum()),
        commits=2.0 * used / one.renew_s + one.hop_commits * second.hops + second.moves,
        checkpoint_bytes=one.checkpoint_person_bytes * people / one.renew_s,
    )

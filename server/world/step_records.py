"""Steps of feet as records of the wire, and back."""

from typing import Final

from esplanade.actors.locomotion.motion import key_poses as motion
from esplanade.protocol import steps as wire
from esplanade.protocol.steps import StepRecords
from esplanade.server.world.compiled._step_record_kernels import (
    Layout,
    read_records,
    write_records,
)
from esplanade.server.world.state import Slots

_LAYOUT: Final = Layout(
    wire.STANDS_ON_RIGHT,
    wire.RE_AIMED,
    wire.FLIGHT_SHIFT,
    wire.MOST_FLIGHT,
    wire.FLIGHT,
    wire.MAX_TICKS,
    wire.FOOTPRINT_M,
    wire.FOOTPRINT_RAD,
    wire.KEY_M,
    wire.FOOT_RAD,
    wire.TRUNK_RAD,
    wire.ARM_RAD,
)


def to_records(steps: motion.Steps, ids: Slots) -> StepRecords:
    """Quantise N steps of the avatars with these ids (N,)."""
    records = wire.new_step_records(len(ids))
    write_records(steps, ids, _LAYOUT, records, wire.differences(records))
    return records


def from_records(records: StepRecords) -> motion.Steps:
    """The steps as readers of these records know them."""
    steps = motion.no_steps(len(records))
    read_records(records, wire.differences(records), _LAYOUT, steps)
    return steps

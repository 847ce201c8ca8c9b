import numpy as np
import pytest

from esplanade.protocol import decode_server
from esplanade.protocol.messages import Snapshot, StepBlock
from esplanade.server.net.packing import Packing
from esplanade.server.world.audience import RECORD_BYTES, STEP_BYTES, Snapshots
from tests.server.net.test_frames import payloads_of


@pytest.mark.parametrize("most", [3, 12, 60])
def test_frames_that_are_packed_at_once_are_what_the_protocol_says(most: int) -> None:
    """Records up to 3 make short frames, more make long ones; both kinds stand side by side."""
    random = np.random.default_rng(most)
    records = random.integers(0, most + 1, 30)
    steps = random.integers(0, most + 1, 30) * random.integers(0, 2, 30)
    snapshots = Snapshots(
        tick=70_000,
        places=np.arange(30),
        viewers=list(range(30)),
        acks=random.integers(0, 2**32, 30),
        record_ends=records.cumsum(),
        step_ends=steps.cumsum(),
        records=random.integers(0, 256, (records.sum(), RECORD_BYTES), dtype=np.uint8),
        steps=random.integers(0, 256, (steps.sum(), STEP_BYTES), dtype=np.uint8),
    )
    packed, ends = Packing().pack(snapshots)
    assert len(packed) == ends[-1]
    for i, end in enumerate(ends):
        heard = [
            decode_server(p) for p in payloads_of(packed[ends[i - 1] if i else 0 : end].tobytes())
        ]
        first, last = snapshots.record_ends[i] - records[i], snapshots.record_ends[i]
        block = snapshots.records[first:last].tobytes()
        ack = int(snapshots.acks[i])
        assert heard.pop() == Snapshot(tick=70_000, ack=ack, block=block)
        first, last = snapshots.step_ends[i] - steps[i], snapshots.step_ends[i]
        block = snapshots.steps[first:last].tobytes()
        assert heard == ([StepBlock(tick=70_000, block=block)] if steps[i] else [])


def test_a_tick_without_viewers_is_nothing() -> None:
    nobody = np.zeros(0, dtype=np.int64)
    empty = np.zeros((0, RECORD_BYTES), dtype=np.uint8)
    steps = np.zeros((0, STEP_BYTES), dtype=np.uint8)
    snapshots = Snapshots(1, nobody, [], nobody, nobody, nobody, empty, steps)
    packed, ends = Packing().pack(snapshots)
    assert (len(packed), len(ends)) == (0, 0)

"""The newest step of everyone, as it goes over the wire."""

import numpy as np

from esplanade.protocol.steps import StepRecords, new_step_records
from esplanade.server.world.state import Slots


class LatestSteps:
    """The newest step of everyone, by slot; a step stays here when it is over.

    `records` is STEP (capacity,), `begun` int32 the tick in which each was written, 0 for none.
    """

    def __init__(self, capacity: int) -> None:
        self.records: StepRecords = new_step_records(capacity)
        self.begun = np.zeros(capacity, dtype=np.int32)

    def begin(self, slots: Slots, records: StepRecords, tick: int) -> None:
        """Write the steps, STEP (N,), that the avatars in these slots, (N,), begin."""
        self.records[slots] = records
        self.begun[slots] = tick

    def begun_in(self, tick: int, slots: Slots) -> StepRecords:
        """The steps that avatars in these slots began in a tick, STEP (N,)."""
        steps: StepRecords = self.records[slots[self.begun[slots] == tick]]
        return steps

"""The newest step of everyone, as it goes over the wire."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from esplanade.protocol.steps import StepRecords, new_step_records
from esplanade.server.world.record_rows import put_rows, record_rows
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
        put_rows(self.records, slots, records)
        self.begun[slots] = tick

    def save(self, slots: Slots) -> dict[str, Any]:
        """The newest steps of these slots (N,), as copies of arrays."""
        return {"records": record_rows(self.records, slots), "begun": self.begun[slots]}

    def load(self, slots: Slots, saved: Mapping[str, Any]) -> None:
        """Know the steps of these slots (N,) that were saved, and no others.

        Raises
        ------
        ValueError, KeyError, TypeError
            It is not what `save` gives.
        """
        self.begun[:] = 0
        self.records[slots] = np.asarray(saved["records"], dtype=self.records.dtype)
        self.begun[slots] = saved["begun"]

    def begun_in(self, tick: int, slots: Slots) -> StepRecords:
        """The steps that avatars in these slots began in a tick, STEP (N,)."""
        steps: StepRecords = record_rows(self.records, slots[self.begun[slots] == tick])
        return steps

"""Step interest: each viewer is shown the steps of the walkers in view that are near."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from esplanade.protocol.steps import STEP, StepRecords, new_step_records
from esplanade.server.world.interest import LEAVE_RATIO, Interest
from esplanade.server.world.rules import Rules
from esplanade.server.world.state import Slots, State

STEP_BYTES = STEP.itemsize


class LatestSteps:
    """The newest step of everyone, by slot; a step stays here when it is over.

    `records` is STEP (capacity + 1,), `begun` int32 the tick in which each was written, 0 for
    none; the last row belongs to nobody and stays as it is.
    """

    def __init__(self, capacity: int) -> None:
        self.records: StepRecords = new_step_records(capacity + 1)
        self.begun = np.zeros(capacity + 1, dtype=np.int32)

    def begin(self, slots: Slots, records: StepRecords, tick: int) -> None:
        """Write the steps, STEP (N,), that the avatars in these slots, (N,), begin."""
        self.records[slots] = records
        self.begun[slots] = tick


@dataclass(frozen=True)
class StepBlocks:
    """One tick's steps for some viewers, packed one after the other.

    The i-th of them is to get `data[ends[i-1]:ends[i]]` (from 0 for the first).
    """

    ends: list[int]
    data: memoryview


class StepInterest:
    """Keeps, for every viewer, the walkers whose steps it is shown, and since when.

    `since[viewer, slot]` is the tick at which that walker came near, 0 if it is not near. A viewer
    is always near to itself; of the others in view, the nearest `steps_limit` within
    `steps_radius_m` are near.
    """

    def __init__(self, state: State, rules: Rules) -> None:
        self._state = state
        self._nobody = state.capacity
        self._near_m = rules.steps_radius_m
        self._leave_m = rules.steps_radius_m * LEAVE_RATIO
        self._leave_rank = rules.steps_limit + 1
        self._near_rank = self._leave_rank - rules.steps_limit // 8
        self.since = np.zeros((state.capacity, state.capacity + 1), dtype=np.int32)

    @property
    def shown(self) -> int:
        """Number of walkers that are shown, summed over all viewers."""
        return int(np.count_nonzero(self.since))

    def attach(self, slot: int) -> None:
        """Let this avatar look; it has been shown nothing so far."""
        self.since[slot] = 0

    def detach(self, slot: int) -> None:
        """Let this avatar look no more."""
        self.since[slot] = 0

    def remove(self, slot: int) -> None:
        """Take an avatar that left the world out of every row."""
        self.detach(slot)
        self.since[:, slot] = 0

    def update(self, interest: Interest, places_cm: Slots, tick: int) -> None:
        """Look again for those whose view was looked at in this tick."""
        due = interest.looked
        viewer = due[:, None]
        rows = interest.rows[due]
        known = self.since[viewer, rows]
        distances2 = self._distances2(due, rows, places_cm)
        rank = np.cumsum(rows != self._nobody, axis=1)
        near = (distances2 <= (100.0 * self._near_m) ** 2) & (rank <= self._near_rank)
        near |= (
            (known > 0) & (distances2 <= (100.0 * self._leave_m) ** 2) & (rank <= self._leave_rank)
        )
        near &= rows != self._nobody
        near |= rows == viewer
        self.since[due] = 0
        row, column = np.nonzero(near)
        stamps = np.where(known > 0, known, tick)
        self.since[due[row], rows[row, column]] = stamps[row, column]

    def encode(
        self,
        interest: Interest,
        steps: LatestSteps,
        viewers: Slots,
        written: npt.NDArray[np.int32],
    ) -> StepBlocks:
        """Steps that these viewers, (V,), have not been sent by the ticks `written`, (V,).

        That is the latest of each walker who began one since, or came near since.
        """
        rows = interest.rows[viewers]
        since = self.since[viewers[:, None], rows]
        begun = steps.begun.take(rows)
        wanted = np.maximum(begun, since) > written[:, None]
        wanted &= (since > 0) & (begun > 0)
        ends = np.cumsum(np.count_nonzero(wanted, axis=1)) * STEP_BYTES
        slots = rows.ravel().take(np.flatnonzero(wanted))
        # Gathering rows of bytes is faster than gathering structured records.
        data = steps.records.view(np.uint8).reshape(-1, STEP_BYTES).take(slots, axis=0).tobytes()
        return StepBlocks(ends.tolist(), memoryview(data))

    def _distances2(self, viewers: Slots, rows: Slots, places_cm: Slots) -> Slots:
        """Squared distances (V, C), cm2, to those in each row; unused places hold any number."""
        apart = places_cm.take(rows, axis=0, mode="clip") - places_cm[viewers][:, None]
        squares: Slots = (apart**2).sum(axis=-1)
        return squares

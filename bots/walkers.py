"""The cost of steps of avatars near by to one client: bytes, and for how long avatars walked."""

from typing import Final

from esplanade.bots.tally import Tally
from esplanade.protocol.codec import STEPS_HEAD_BYTES
from esplanade.protocol.steps import step_records

WALKS_ON_S: Final = 2.0
"""An avatar that begins no other step for this long stands, and no longer counts as walking."""
MAX_REMEMBERED: Final = 1024


class Walkers:
    """Counts the steps that one client is sent into a tally."""

    def __init__(self, tally: Tally, tick_rate: int) -> None:
        self._tally = tally
        self._tick_rate = tick_rate
        self._begun: dict[int, int] = {}

    def take(self, frame: bytes) -> None:
        """Count a frame of steps."""
        records = step_records(frame[STEPS_HEAD_BYTES:])
        self._tally.step_bytes += len(frame)
        self._tally.steps += len(records)
        for avatar_id, tick in zip(records["id"].tolist(), records["tick"].tolist(), strict=True):
            before = self._begun.pop(avatar_id, None)
            self._begun[avatar_id] = tick
            if before is not None:
                since_s = (tick - before) / self._tick_rate
                self._tally.walker_seconds += since_s if 0.0 < since_s <= WALKS_ON_S else 0.0
        while len(self._begun) > MAX_REMEMBERED:
            del self._begun[next(iter(self._begun))]

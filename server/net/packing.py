"""All snapshots and steps of a tick as WebSocket frames, packed at once and cut for each viewer."""

from typing import Final

import numpy as np
import numpy.typing as npt

from esplanade.protocol import encode_snapshot, encode_steps
from esplanade.server.net.compiled._frame_kernels import measure, pack
from esplanade.server.world.audience import RECORD_BYTES, STEP_BYTES, Snapshots

_ACK_MARK: Final = 0x01020304


class Packing:
    """Packs the frames of a tick. The place of the ack is found in the protocol's own encoding."""

    def __init__(self) -> None:
        self._ack_at = encode_snapshot(0, _ACK_MARK, b"").index(_ACK_MARK.to_bytes(4))
        self._room = np.empty(0, dtype=np.uint8)

    def pack(self, snapshots: Snapshots) -> tuple[npt.NDArray[np.uint8], npt.NDArray[np.int64]]:
        """The frames of all viewers one after the other, and where those of each end.

        A viewer with steps gets two frames, that of the steps first; the others one. The frames are
        good until the next ones are packed.
        """
        news = snapshots
        snapshot_head = _bytes(encode_snapshot(news.tick, 0, b""))
        steps_head = _bytes(encode_steps(news.tick, b""))
        ends = np.empty(len(news.viewers), dtype=np.int64)
        measure(
            news.record_ends,
            news.step_ends,
            RECORD_BYTES,
            STEP_BYTES,
            len(snapshot_head),
            len(steps_head),
            ends,
        )
        size = int(ends[-1]) if len(ends) else 0
        if size > len(self._room):
            self._room = np.empty(2 * size, dtype=np.uint8)
        pack(
            news.record_ends,
            news.step_ends,
            news.records.ravel(),
            news.steps.ravel(),
            RECORD_BYTES,
            STEP_BYTES,
            news.acks,
            snapshot_head,
            steps_head,
            self._ack_at,
            self._room,
        )
        return self._room[:size], ends


def _bytes(head: bytes) -> npt.NDArray[np.uint8]:
    return np.frombuffer(head, dtype=np.uint8).copy()

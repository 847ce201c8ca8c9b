"""The snapshots of a tick for many clients are sent in one kernel."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from esplanade.server.net.compiled._socket_kernels import send_all
from esplanade.server.net.sockets.system import NONE

Bytes = NDArray[np.uint8]
Ints = NDArray[np.int64]


def send_to_all(
    descriptors: Sequence[int], block: Bytes, begins: Ints, ends: Ints, first: Sequence[bytes]
) -> dict[int, bytes]:
    """Send to each descriptor what is in `first` for it, and then its part of the block.

    The sockets are open and plain, and nothing waits in their transports. The result is what the
    system has not taken, by place; all of it where a call failed, so that the transport finds out
    why in its turn.
    """
    head_sizes = np.fromiter(map(len, first), dtype=np.int64, count=len(first))
    head_ends = head_sizes.cumsum()
    sent = np.full(len(descriptors), NONE, dtype=np.int64)
    send_all(
        np.array(descriptors, dtype=np.int64),
        block,
        begins,
        ends,
        np.frombuffer(bytearray().join(first), dtype=np.uint8),
        head_ends - head_sizes,
        head_ends,
        sent,
    )
    sent = np.maximum(sent, 0)
    return {
        k: (first[k] + block[begins[k] : ends[k]].tobytes())[sent[k] :]
        for k in np.flatnonzero(sent < head_sizes + ends - begins).tolist()
    }

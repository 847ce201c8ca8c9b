"""The snapshots of a tick for many clients are sent in one kernel."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from esplanade.server.net.compiled._socket_kernels import send_all
from esplanade.server.net.sockets.system import NONE

Bytes = NDArray[np.uint8]
Ints = NDArray[np.int64]


def send_to_all(
    descriptors: Ints,
    block: Bytes,
    begins: Ints,
    ends: Ints,
    first: Mapping[int, bytes],
) -> tuple[int, dict[int, bytes]]:
    """Send to each descriptor what is in `first` for it, by place, and then its part of the block.

    The sockets are open and plain, and nothing waits in their transports. Returns the number of
    all bytes, and what the system has not taken of them, by place; all of it where a call failed,
    so that the transport finds out why in its turn.
    """
    head_sizes = np.zeros(len(descriptors), dtype=np.int64)
    places = sorted(first)
    head_sizes[places] = [len(first[k]) for k in places]
    head_ends = head_sizes.cumsum()
    sent = np.full(len(descriptors), NONE, dtype=np.int64)
    send_all(
        descriptors,
        block,
        begins,
        ends,
        np.frombuffer(bytearray().join(first[k] for k in places), dtype=np.uint8),
        head_ends - head_sizes,
        head_ends,
        sent,
    )
    sent = np.maximum(sent, 0)
    sizes = head_sizes + ends - begins
    return int(sizes.sum()), {
        k: (first.get(k, b"") + block[begins[k] : ends[k]].tobytes())[sent[k] :]
        for k in np.flatnonzero(sent < sizes).tolist()
    }

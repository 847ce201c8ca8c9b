"""Arrays with room for rows to come, whose memory is taken only when a row is written.

Growing an array means to copy it, which took three quarters of a second for 300 MB: longer than
fifteen ticks. Address space costs nothing, so room for many rows is there from the start.
"""

import mmap
import sys
from typing import Final

import numpy as np
from numpy.typing import NDArray

ADDRESS_BYTES: Final = 1 << 34
"""Of address space for one array, 16 GiB: a thousand goals on a million cells."""
MOST_ROWS: Final = 1 << 14
_NO_RESERVE: Final = 0x4000
"""Linux's MAP_NORESERVE, which Python has no name for before 3.12."""


def rows_to_come(rows: int, row_shape: tuple[int, ...]) -> NDArray[np.float32]:
    """Return an array float32 (R, *row_shape) of zeros with R >= `rows`.

    Where the system has no such memory, or allows no more address space, R is `rows`.
    """
    row_bytes = 4 * int(np.prod(row_shape))
    wanted = min(MOST_ROWS, ADDRESS_BYTES // max(1, row_bytes))
    if sys.platform == "linux" and row_bytes and wanted > rows:
        flags = mmap.MAP_PRIVATE | mmap.MAP_ANONYMOUS | _NO_RESERVE
        try:
            space = mmap.mmap(-1, wanted * row_bytes, flags=flags)
        except OSError:
            return np.zeros((rows, *row_shape), dtype=np.float32)
        return np.frombuffer(space, dtype=np.float32).reshape(wanted, *row_shape)
    return np.zeros((rows, *row_shape), dtype=np.float32)

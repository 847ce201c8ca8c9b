"""Chosen rows of tables of records, copied fast."""

from typing import Any

import numpy as np

from esplanade.server.world.state import Slots

Records = np.ndarray[Any, np.dtype[np.void]]


def record_rows(records: Records, slots: Slots) -> Records:
    """Copies of the records, (N,), that lie in these slots, (N,), of a table of them.

    The library copies records field by field, which takes five times as long as their bytes.
    """
    bytes_of_rows = records.view(np.uint8).reshape(len(records), records.dtype.itemsize)
    return bytes_of_rows[slots].view(records.dtype)[:, 0]

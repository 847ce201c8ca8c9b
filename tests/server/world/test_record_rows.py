"""Rows of records that are copied as bytes are those that the library copies field by field."""

import numpy as np

from esplanade.protocol.steps import STEP
from esplanade.server.world.record_rows import put_rows, record_rows


def test_rows_are_read_and_written_as_by_the_library() -> None:
    random = np.random.default_rng(5)
    table, news = (random.bytes(count * STEP.itemsize) for count in (40, 7))
    records, others = np.frombuffer(table, STEP).copy(), np.frombuffer(news, STEP)
    slots = random.permutation(40)[:7]
    assert record_rows(records, slots).tobytes() == records[slots].tobytes()
    expected = records.copy()
    expected[slots] = others
    put_rows(records, slots, others)
    assert records.tobytes() == expected.tobytes()
    none = slots[:0]
    assert len(record_rows(records, none)) == 0
    put_rows(records, none, others[:0])
    assert records.tobytes() == expected.tobytes()

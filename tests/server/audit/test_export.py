"""Rows as CSV: every column, and nothing that a spreadsheet would compute."""

import csv
import io

from esplanade.server.audit.entries import Entry
from esplanade.server.audit.export import COLUMNS, moment, write_csv
from esplanade.server.audit.log import AuditLog, Filter
from esplanade.server.store.sql_store import SqlStore
from tests.server.stores import Clock


async def test_rows_come_back_from_csv(store: SqlStore) -> None:
    clock = Clock()
    log = AuditLog(store, "server", clock)
    note = 'two "words",\nand a line'
    await log.record(Entry(command="kick", tick=5, person="=1+1", note=note, body={"a": 1}))
    file = io.StringIO(newline="")
    assert await write_csv(log.rows(Filter()), file) == 1
    file.seek(0)
    (row,) = csv.DictReader(file)
    assert tuple(row) == COLUMNS
    assert row["time"] == moment(clock.now_us) == "2027-01-15T08:00:00.000Z"
    assert (row["person"], row["note"], row["body"]) == ("'=1+1", note, '{"a":1}')
    assert (row["account"], row["tick"], row["seq"]) == ("", "5", "1")

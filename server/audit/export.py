"""Rows of the audit as CSV, for spreadsheets."""

import csv
from collections.abc import AsyncIterable, Mapping
from datetime import UTC, datetime
from typing import Final, TextIO

from esplanade.server.audit.chain import as_json
from esplanade.server.audit.entries import Row

COLUMNS: Final = (
    *("time", "tick", "writer", "seq", "command", "account", "role", "address", "target"),
    *("outcome", "refers_to", "person", "note", "body", "detail", "hash"),
)
_FORMULA: Final = ("=", "+", "-", "@", "\t", "\r")


async def write_csv(rows: AsyncIterable[Row], file: TextIO) -> int:
    """Write rows with a line of headings; returns how many there were."""
    writer = csv.writer(file)
    writer.writerow(COLUMNS)
    count = 0
    async for row in rows:
        values = (moment(row.at_us), *(getattr(row, name) for name in COLUMNS[1:]))
        writer.writerow([_cell(value) for value in values])
        count += 1
    return count


def moment(at_us: int) -> str:
    """A moment in UTC, as ISO 8601 with milliseconds."""
    at = datetime.fromtimestamp(at_us / 1e6, UTC)
    return at.isoformat(timespec="milliseconds").replace("+00:00", "Z")


def _cell(value: object) -> object:
    """A value as a cell; text that a spreadsheet would compute gets an apostrophe before it."""
    if isinstance(value, Mapping):
        return as_json(value)
    if isinstance(value, str) and value.startswith(_FORMULA):
        return f"'{value}"
    return "" if value is None else value

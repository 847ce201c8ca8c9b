"""`esplanade op audit`: shows the audit, writes it out, and checks it."""

import json
import sys
from argparse import Namespace
from collections.abc import AsyncIterator
from dataclasses import asdict
from typing import Final

from rich.table import Table
from rich.text import Text

from esplanade.commandline import exit_codes
from esplanade.commandline.output import console
from esplanade.server.audit.entries import Row
from esplanade.server.audit.export import moment, write_csv
from esplanade.server.audit.log import AuditLog, Filter, now_us
from esplanade.server.audit.verifying import verify
from esplanade.server.operating.opening import WRITER, in_store
from esplanade.server.store.sql_store import SqlStore

ROWS_OF_A_TABLE: Final = 100


def run(options: Namespace) -> int:
    """Show rows of the audit, or check all of them."""
    if options.verify:
        return in_store(options, _verify)
    if options.csv:
        in_store(options, lambda store: write_csv(_rows(store, options), sys.stdout))
    elif options.json:
        in_store(options, lambda store: _write_json(_rows(store, options)))
    else:
        in_store(options, lambda store: _show(_rows(store, options, ROWS_OF_A_TABLE)))
    return exit_codes.OK


async def _rows(
    store: SqlStore, options: Namespace, limit: int | None = None
) -> AsyncIterator[Row]:
    now = now_us()
    wanted = Filter(
        since_us=None if options.since is None else now - int(options.since * 1e6),
        until_us=None if options.until is None else now - int(options.until * 1e6),
        account=options.account,
        command=options.name,
        target=options.actor,
        person=options.person,
    )
    left = options.limit or limit
    async for row in AuditLog(store, WRITER).rows(wanted):
        yield row
        if left is not None:
            left -= 1
            if not left:
                return


async def _write_json(rows: AsyncIterator[Row]) -> None:
    async for row in rows:
        print(json.dumps({"time": moment(row.at_us), **asdict(row)}))


async def _show(rows: AsyncIterator[Row]) -> None:
    table = Table("time", "tick", "account", "command", "about", "outcome", "note", "body")
    async for row in rows:
        cells = (
            moment(row.at_us),
            "" if row.tick is None else str(row.tick),
            row.account or "",
            row.command,
            row.target or row.person or "",
            row.outcome,
            row.note or "",
            json.dumps(dict(row.body), ensure_ascii=False),
        )
        table.add_row(*map(_cell, cells))
    console().print(table)


def _cell(text: str) -> Text:
    """Text as it is, but for what would steer the terminal."""
    return Text(
        "".join(each if each.isprintable() else "\N{REPLACEMENT CHARACTER}" for each in text)
    )


async def _verify(store: SqlStore) -> int:
    chains = await verify(store)
    table = Table("writer", "rows that hold", "forgotten in part", "hash of the last")
    for chain in chains:
        table.add_row(chain.writer, str(chain.rows), str(chain.forgotten), chain.head)
    console().print(table)
    faults = [chain.fault for chain in chains if chain.fault is not None]
    for fault in faults:
        print(f"esplanade op audit: {fault}", file=sys.stderr)
    return exit_codes.FAILED if faults else exit_codes.OK

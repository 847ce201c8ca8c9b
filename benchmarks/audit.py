"""Measures the time of a page of a long audit, and of a row.

python -m benchmarks.audit --rows 1000000
python -m benchmarks.audit --store postgresql://esplanade@localhost/empty

The audit has many commands of few accounts, as one that was kept for years. Each kind of filter
is asked for its first page, for one in the middle, and for what is not there. Times are of this
machine; beside them is their ratio to the bound, 50 ms for a page of a million rows.
"""

import argparse
import asyncio
import random
import tempfile
import time
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Any, Final

import numpy as np
from sqlalchemy import Connection, insert

from esplanade.server.audit.chain import Link, linked
from esplanade.server.audit.entries import Entry
from esplanade.server.audit.log import AuditLog, Filter
from esplanade.server.audit.verifying import verify
from esplanade.server.store.location import Location
from esplanade.server.store.sql_store import SqlStore, open_store
from esplanade.server.store.tables import AUDIT, AUDIT_HEADS

BOUND_MS: Final = 50.0
BEGIN_US: Final = 1_700_000_000_000_000
EVERY_US: Final = 60 * 10**6
PAGES: Final = 40
COMMANDS: Final = ("set_parameters", "move_door", "kick", "pace", "send_actor")


def rows(count: int) -> Iterator[dict[str, Any]]:
    """A chain of so many rows, one a minute: rare accounts, commands and actors are among them."""
    chance, last = random.Random(1), Link()
    for number in range(count):
        entry = Entry(
            command="ban" if number % 50_000 == 7 else chance.choice(COMMANDS),
            account="olga" if chance.random() < 0.9 else chance.choice(("ann", "bob", "eve")),
            role="director",
            address="192.0.2.7",
            target="world" if chance.random() < 0.5 else f"actor-{chance.randrange(500)}",
            tick=number * 1200,
            body={"values": {"risk_weight": round(chance.uniform(1, 20), 3)}, "revision": number},
            note="queue at the café",
        )
        row = linked(last, "main", "server", BEGIN_US + number * EVERY_US, entry)
        last = Link(row["seq"], row["at_us"], row["hash"])
        yield row


async def fill(store: SqlStore, count: int) -> None:
    source = rows(count)
    last: dict[str, Any] = {}
    while chunk := list(islice(source, 20_000)):
        await store.write(lambda connection, chunk=chunk: _insert(connection, chunk))  # type: ignore[misc]
        last = chunk[-1]
    head = {name: last[name] for name in ("zone", "writer", "seq", "at_us", "hash")}
    await store.write(lambda connection: _note(connection, head))


def _insert(connection: Connection, chunk: list[dict[str, Any]]) -> None:
    connection.execute(insert(AUDIT), chunk)


def _note(connection: Connection, head: dict[str, Any]) -> None:
    connection.execute(insert(AUDIT_HEADS).values(head))


def filters(count: int) -> dict[str, Filter]:
    middle = BEGIN_US + count // 2 * EVERY_US
    return {
        "all": Filter(),
        "before the middle": Filter(until_us=middle),
        "an hour in the middle": Filter(since_us=middle, until_us=middle + 3600 * 10**6),
        "a busy account": Filter(account="olga"),
        "a rare command": Filter(command="ban"),
        "a busy account's rare command": Filter(account="olga", command="ban"),
        "an actor": Filter(target="actor-77"),
        "an actor, a command": Filter(target="actor-77", command="pace"),
        "an actor, an account": Filter(target="actor-77", account="ann"),
        "all three": Filter(target="world", account="olga", command="ban"),
        "all three, before the middle": Filter(
            target="world", account="olga", command="pace", until_us=middle
        ),
        "nobody's": Filter(account="nobody", until_us=middle),
        "a person's": Filter(person="Eve"),
    }


async def measure(store: SqlStore, count: int) -> None:
    log = AuditLog(store, "server")
    print(f"{'a page of 100 rows':32} {'rows':>5} {'p50 ms':>8} {'p99 ms':>8} {'p99 / bound':>12}")
    for name, wanted in filters(count).items():
        taken, page = [], await log.page(wanted)
        after = page.next
        for number in range(PAGES):
            begun = time.perf_counter()
            found = await log.page(wanted, after=after if number % 2 else None)
            taken.append(1e3 * (time.perf_counter() - begun))
            after = found.next or after
        p50, p99 = np.percentile(taken, (50, 99))
        print(f"{name:32} {len(page.rows):5} {p50:8.2f} {p99:8.2f} {p99 / BOUND_MS:12.3f}")
    for together in (1, 16):
        taken = []
        for _ in range(200):
            begun = time.perf_counter()
            entries = (log.record(Entry(command="mark")) for _ in range(together))
            await asyncio.gather(*entries)
            taken.append(1e3 * (time.perf_counter() - begun) / together)
        p50, p99 = np.percentile(taken, (50, 99))
        print(f"{f'a row, {together} at once':32} {'':5} {p50:8.2f} {p99:8.2f}")
    begun = time.perf_counter()
    (chain,) = await verify(store)
    seconds = time.perf_counter() - begun
    print(f"checking all {chain.rows} rows: {seconds:.1f} s, fault: {chain.fault}")


async def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--rows", type=int, default=1_000_000)
    parser.add_argument("--store", default="", help="an empty PostgreSQL database")
    parser.add_argument("--durable", action="store_true", help="outlive a loss of power too")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="esplanade-audit-") as folder:
        location = Location.of(Path(folder), options.store)
        async with open_store(location, durable=options.durable, upgrading=True) as store:
            begun = time.perf_counter()
            await fill(store, options.rows)
            print(f"{options.rows} rows were made in {time.perf_counter() - begun:.0f} s")
            if location.file is not None:
                print(f"the file has {location.file.stat().st_size / 1e6:.0f} MB")
            await measure(store, options.rows)


if __name__ == "__main__":
    asyncio.run(main())

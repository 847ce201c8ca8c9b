"""A row is there from its commit on: the process dies between it and the tick."""

import asyncio
import os
import signal
import subprocess
import sys
from pathlib import Path

from esplanade.server.audit.log import AuditLog, Filter
from esplanade.server.audit.verifying import verify
from esplanade.server.store.location import Location
from esplanade.server.store.sql_store import open_store

SERVER = """
import asyncio, os, signal, sys
from pathlib import Path
from esplanade.server.audit.entries import Entry
from esplanade.server.audit.log import AuditLog
from esplanade.server.store.location import Location
from esplanade.server.store.sql_store import open_store

async def main():
    data, store = sys.argv[1:]
    async with open_store(Location.of(Path(data), store)) as opened:
        log = AuditLog(opened, "server")
        rows = (log.record(Entry(command="pace", body={"count": count})) for count in range(50))
        for number in await asyncio.gather(*rows):
            print(number)
        await log.record(Entry(command="set_parameters", account="olga", tick=7))
        sys.stdout.flush()
        os.kill(os.getpid(), signal.SIGKILL)  # the command was about to enter its tick
        print("ticked")

asyncio.run(main())
"""


async def test_a_row_outlives_the_process_that_wrote_it(location: Location, tmp_path: Path) -> None:
    store = "" if location.is_sqlite else location.url.render_as_string(hide_password=False)
    async with open_store(location, upgrading=True):
        pass
    done = await asyncio.to_thread(
        subprocess.run,
        [sys.executable, "-c", SERVER, str(tmp_path / "data"), store],
        check=False,
        capture_output=True,
        text=True,
        env=os.environ,
    )
    assert done.returncode == -signal.SIGKILL, done.stderr
    assert done.stdout.split() == [str(number) for number in range(1, 51)]
    async with open_store(location) as again:
        page = await AuditLog(again, "server").page(Filter(), limit=10)
        assert (page.rows[0].command, page.rows[0].account, page.rows[0].tick) == (
            "set_parameters",
            "olga",
            7,
        )
        (chain,) = await verify(again)
        assert (chain.rows, chain.fault) == (51, None)
        assert await AuditLog(again, "server").record(page.rows[0]) == 52

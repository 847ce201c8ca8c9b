"""The server as a process of its own: signals and what it prints."""

import asyncio
import json
import os
import signal
import sys
from asyncio.subprocess import Process
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

from esplanade.commandline import exit_codes
from esplanade.protocol import CloseCode
from tests.patience import COMPILING_PATIENCE_S, PATIENCE_S
from tests.server.client import joined


@asynccontextmanager
async def started(room_file: Path, **environment: str) -> AsyncIterator[Process]:
    """A server's process; killed at the end if it still runs."""
    process = await asyncio.create_subprocess_exec(
        sys.executable,
        *("-m", "esplanade", "serve"),
        *("--scene", str(room_file), "--host", "127.0.0.1", "--port", "0", "--private-port", "0"),
        *("--actors", "1", "--log-format", "json"),
        stderr=asyncio.subprocess.PIPE,
        preexec_fn=_hear_interrupts,
        env={**os.environ, **environment},
    )
    try:
        async with asyncio.timeout(COMPILING_PATIENCE_S):
            yield process
    finally:
        if process.returncode is None:
            process.kill()
            await process.wait()


def _hear_interrupts() -> None:
    """Tests that run in the background of a shell ignore SIGINT, and so would their children."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


async def test_ctrl_c_ends_a_start_at_once(room_file: Path, tmp_path: Path) -> None:
    # In an empty home there are no kernels yet: this start would compile for a long time.
    async with started(room_file, HOME=str(tmp_path)) as process:
        assert process.stderr is not None
        assert b"nothing is kept" in await process.stderr.readline()
        assert b"compiling" in await process.stderr.readline()
        process.send_signal(signal.SIGINT)
        # All kernels would take longer than this.
        async with asyncio.timeout(PATIENCE_S):
            assert await process.stderr.read() == b""
            assert await process.wait() == exit_codes.INTERRUPTED


async def test_a_signal_ends_the_process_in_good_order(room_file: Path) -> None:
    async with started(room_file) as process:
        assert process.stderr is not None
        lines: list[dict[str, Any]] = []
        while not lines or lines[-1]["event"] != "open":
            lines.append(json.loads(await process.stderr.readline()))
        port = int(lines[-1]["url"].rsplit(":", 1)[1])
        async with joined(port) as client:
            process.send_signal(signal.SIGTERM)
            _, code = await client.last_words()
        assert code == CloseCode.GOING_AWAY
        rest = (await process.stderr.read()).decode()
        assert await process.wait() == 0
    summary = json.loads(rest.splitlines()[-1])
    assert summary["event"] == "summary"
    assert summary["people_seen"] == 1
    assert client.welcome is not None
    assert client.welcome.resume not in rest

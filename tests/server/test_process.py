"""A server's process under hardship: nobody reads its log, or it may open few files."""

import asyncio
import fcntl
import json
import os
import resource
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

from websockets.asyncio.client import connect

from esplanade.protocol.messages import Travel, Welcome
from tests.patience import COMPILING_PATIENCE_S, PATIENCE_S
from tests.server.certificates import make_pair
from tests.server.client import Client, joined
from tests.server.http import get
from tests.server.zones import YARD, write_town

JOINS = 330
AT_ONCE = 30
PIPE_BYTES = 4096


class Server:
    """A process that serves, and its log up to the line that says that it is open."""

    def __init__(self, process: "subprocess.Popen[bytes]", log: IO[bytes]) -> None:
        self.process = process
        self.log = log
        self.lines: list[dict[str, Any]] = []
        late = threading.Timer(COMPILING_PATIENCE_S, process.kill)
        late.start()
        while not self.lines or self.lines[-1]["event"] != "open":
            line = log.readline()
            assert line, self.lines
            self.lines.append(json.loads(line))
        late.cancel()
        self.url: str = self.lines[-1]["url"]
        self.port = int(self.url.split("//")[1].split("/")[0].rsplit(":", 1)[1])
        self.private_port = int(self.lines[-1]["private"].rsplit(":", 1)[1])

    def stop(self) -> int:
        """Tell it to end, and wait for that; its exit code."""
        self.process.send_signal(signal.SIGTERM)
        return self.process.wait(PATIENCE_S)


@contextmanager
def served(
    file: Path,
    *options: str,
    prepare: Callable[[], None] | None = None,
    option: str = "--scene",
) -> Iterator[Server]:
    """A server of its own with a small pipe for its log."""
    reader, writer = os.pipe()
    fcntl.fcntl(writer, fcntl.F_SETPIPE_SZ, PIPE_BYTES)
    places = ("--host", "127.0.0.1", "--port", "0", "--private-port", "0")
    process = subprocess.Popen(
        [
            *(sys.executable, "-m", "esplanade", "serve", option, str(file), *places),
            *("--actors", "1", "--log-format", "json", *options),
        ],
        stderr=writer,
        preexec_fn=prepare,  # noqa: PLW1509 (it only sets a limit)
    )
    os.close(writer)
    # Without a buffer of its own, so that nothing is read that no test asks for.
    with os.fdopen(reader, "rb", buffering=0) as log:
        try:
            yield Server(process, log)
        finally:
            process.kill()
            process.wait()


async def test_a_log_that_nobody_reads_stops_nobody(room_file: Path) -> None:
    with served(room_file) as server:
        async with joined(server.port, "Canary") as canary:
            for _ in range(JOINS // AT_ONCE):
                await asyncio.gather(*(_visit(server.port) for _ in range(AT_ONCE)))
            await canary.ticks(5)
        metrics = (await get(server.private_port, "/metrics")).body
        assert f"esplanade_people_seen_total {JOINS + 1}.0".encode() in metrics
        assert b"esplanade_log_lines_dropped_total 0.0" in metrics
        # Nobody reads now either: it ends all the same, within a bounded time.
        assert server.stop() == 0


async def test_a_signal_has_a_changed_scene_read_anew(tmp_path: Path) -> None:
    world = write_town(tmp_path, actors=0)
    with served(world, option="--world") as server:
        async with joined(server.port, "Ann") as ann:
            (tmp_path / "yard.json").write_text(json.dumps({**YARD, "name": "Another yard"}))
            server.process.send_signal(signal.SIGUSR1)
            assert (await ann.until(Travel)).zone == "yard"
            assert (await ann.until(Welcome)).scene["name"] == "Another yard"
            told: dict[str, Any] = {"event": ""}
            while told["event"] != "read the world anew":
                told = json.loads(server.log.readline())
            assert told["changed"] == "yard"
        assert server.stop() == 0
        lines = [json.loads(line) for line in server.log.read().splitlines()]
    assert [line["zone"] for line in lines if line["event"] == "summary"] == ["yard", "hall"]


async def test_a_log_that_is_read_late_is_whole(room_file: Path) -> None:
    with served(room_file) as server:
        for _ in range(JOINS // AT_ONCE):
            await asyncio.gather(*(_visit(server.port) for _ in range(AT_ONCE)))
        rest: list[bytes] = []
        reading = threading.Thread(target=lambda: rest.append(server.log.read()))
        reading.start()
        assert server.stop() == 0
        reading.join(PATIENCE_S)
    events = [json.loads(line)["event"] for line in rest[0].splitlines()]
    assert events.count("person here") == events.count("person gone") == JOINS
    assert events[-1] == "summary"


async def test_health_is_told_when_people_have_all_files_that_may_be_open(room_file: Path) -> None:
    def few() -> None:
        resource.setrlimit(resource.RLIMIT_NOFILE, (256, 256))

    with served(room_file, prepare=few) as server:
        (warning,) = [line for line in server.lines if line["level"] == "warning"]
        assert "raise the limit of open files" in warning["event"]
        assert (warning["limit"], warning["wanted"]) == (256, 1512)
        silent = [await asyncio.open_connection("127.0.0.1", server.port) for _ in range(400)]
        for _ in range(3):
            assert (await get(server.private_port, "/healthz")).status == 200
            assert (await get(server.private_port, "/readyz")).status == 200
        metrics = (await get(server.private_port, "/metrics")).body
        assert f"esplanade_sockets {warning['connections']}.0".encode() in metrics
        for _, writer in silent:
            writer.close()
        async with asyncio.timeout(PATIENCE_S):
            while b"esplanade_sockets 0.0" not in metrics:
                metrics = (await get(server.private_port, "/metrics")).body
        async with joined(server.port) as client:
            await client.ticks(3)
        assert server.stop() == 0


async def test_the_limit_of_open_files_is_raised_as_far_as_is_needed(room_file: Path) -> None:
    def few_at_first() -> None:
        resource.setrlimit(resource.RLIMIT_NOFILE, (256, 4096))

    with served(room_file, prepare=few_at_first) as server:
        assert not [line for line in server.lines if line["level"] == "warning"]
        limits = resource.prlimit(server.process.pid, resource.RLIMIT_NOFILE)
        assert 1512 < limits[0] < limits[1] == 4096


def test_too_few_open_files_are_refused_before_the_scene_is_read(room_file: Path) -> None:
    room_file.write_text("this is no scene")
    places = ("--host", "127.0.0.1", "--port", "0", "--private-port", "0")
    done = subprocess.run(
        [sys.executable, "-m", "esplanade", "serve", "--scene", str(room_file), *places],
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_NOFILE, (100, 100)),
        capture_output=True,
        timeout=COMPILING_PATIENCE_S,
        check=False,
    )
    assert done.returncode == 1
    assert b"this process may have 100 open files and needs " in done.stderr


async def test_a_process_serves_by_tls_and_says_so(room_file: Path, tmp_path: Path) -> None:
    pair = make_pair(tmp_path, "here")
    files = ("--tls-cert", str(pair.cert), "--tls-key", str(pair.key))
    with served(room_file, *files, "--root-path", "/world") as server:
        assert server.url == f"https://127.0.0.1:{server.port}/world/"
        url = server.url.replace("https", "wss") + "ws"
        for _ in range(20):
            _, writer = await asyncio.open_connection("127.0.0.1", server.port)
            writer.write(b"\x16\x03\x01 this is no handshake\r\n\r\n")
            writer.close()
        async with connect(url, ssl=pair.trusting(), proxy=None) as connection:
            assert Client(connection).welcome is None
        assert server.stop() == 0


async def _visit(port: int) -> None:
    """Come in, see the world, and go."""
    async with joined(port, "Guest"):
        pass

"""Try an installed Esplanade from the folder one stands in: `installed_check.py DOCUMENT`.

It knows nothing of the clone: import every module, run the document's first Python example, start
a server, fetch its page, let a bot walk and a group of bots wander, and judge an actor among
recorded people. It ends with an AssertionError or another exception where something is wrong.
"""

import asyncio
import contextlib
import math
import pkgutil
import re
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from importlib import import_module, metadata
from pathlib import Path
from typing import Final

import esplanade
from esplanade import bots

READY_LIMIT_S: Final = 900.0
"""A server compiles before it is ready: some minutes, where the machine is busy."""
WALK_LIMIT_S: Final = 20.0
NOT_IMPORTED: Final = {"esplanade.__main__"}
EXTRAS: Final = {
    "DracoPy",
    "ezdxf",
    "ifcopenshell",
    "jupedsim",
    "matplotlib",
    "meshoptimizer",
    "PIL",
    "shapely",
    "yaml",
}
"""Packages that a plain install does not bring."""


def main(document: Path) -> None:
    """Run all checks, each with a line that says how long it took."""
    assert Path(esplanade.__file__).is_relative_to(sys.prefix), esplanade.__file__
    started = time.monotonic()

    def done(what: str) -> None:
        print(f"  {time.monotonic() - started:6.1f} s  {what}", flush=True)

    done(f"Python {sys.version.split()[0]}, numba {metadata.version('numba')}")
    done(f"{import_everything()} modules are imported")
    for command in ("serve", "bots", "demo", "evaluate", "scene", "gait"):
        command_line(command, "--help")
    done("every command has its help")
    run_example(document)
    done(f"the example of {document.name} runs")
    with server() as port:
        done("a server is ready")
        check_page(port)
        done("it serves the page and the licences")
        done(f"a bot has walked {asyncio.run(walk(port)):.1f} m")
        command_line("bots", "--url", f"ws://127.0.0.1:{port}", "--count", "5", "--duration", "5")
        done("five bots have wandered")
    recording = record_crowd(Path("crowd.csv"))
    command_line("evaluate", str(recording), "--policy", "esplanade", "straight", "--episodes", "1")
    done("an actor has been judged")


def import_everything() -> int:
    """Import every module that a plain install can; returns how many."""
    count = 0
    for module in pkgutil.walk_packages(esplanade.__path__, "esplanade."):
        if module.name in NOT_IMPORTED:
            continue
        try:
            import_module(module.name)
        except ModuleNotFoundError as error:
            if error.name is None or error.name.partition(".")[0] not in EXTRAS:
                raise
        count += 1
    assert count > 200, count
    return count


def command_line(*arguments: str) -> None:
    """Run `python -m esplanade` in the folder one stands in."""
    done = subprocess.run(
        [sys.executable, "-m", "esplanade", *arguments],
        check=False,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    assert done.returncode == 0, f"esplanade {' '.join(arguments)}: {done.stdout}"


def run_example(document: Path) -> None:
    """Run the document's first block of Python as a program of its own."""
    block = re.search(
        r"^```python\n(.*?)^```", document.read_text("utf-8"), re.MULTILINE | re.DOTALL
    )
    assert block, f"{document} has no example"
    Path("example.py").write_text(block[1], encoding="utf-8")
    subprocess.run([sys.executable, "example.py"], check=True)


@contextlib.contextmanager
def server() -> Iterator[int]:
    """A server in a process of its own, ready; the value is its port."""
    port, private = free_port(), free_port()
    options = ["--host", "127.0.0.1", "--port", str(port), "--private-port", str(private)]
    process = subprocess.Popen(
        [sys.executable, "-m", "esplanade", "serve", *options, "--actors", "5"]
    )
    try:
        wait_until_ready(process, f"http://127.0.0.1:{private}/readyz")
        yield port
    finally:
        process.terminate()
        status = process.wait(timeout=60.0)
    assert status == 0, f"the server ended with status {status}"


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
        return port


def wait_until_ready(process: "subprocess.Popen[bytes]", address: str) -> None:
    """Ask until the answer is 200; AssertionError when the server ends or takes too long."""
    limit = time.monotonic() + READY_LIMIT_S
    while time.monotonic() < limit:
        assert process.poll() is None, "the server ended before it was ready"
        with contextlib.suppress(urllib.error.URLError, OSError):
            if fetch(address):
                return
        time.sleep(0.5)
    raise AssertionError(f"the server is not ready after {READY_LIMIT_S:.0f} s")


def fetch(address: str) -> str:
    with urllib.request.urlopen(address, timeout=10.0) as answer:
        body: bytes = answer.read()
    return body.decode()


def check_page(port: int) -> None:
    """The page is the built one, and its licences are those of the libraries in it."""
    page = fetch(f"http://127.0.0.1:{port}/")
    assert 'href="./licences.txt"' in page
    licences = fetch(f"http://127.0.0.1:{port}/licences.txt")
    assert "three.js authors" in licences
    assert "MessagePack" in licences


async def walk(port: int) -> float:
    """Let a bot walk to places around it until it has moved; returns how far it came, in metres."""
    async with bots.connect(f"ws://127.0.0.1:{port}", name="Checker") as bot:
        begin = bot.position
        # It may not get to every one of these: one of them may be in a wall.
        for x, y in ((4.0, 0.0), (-4.0, 0.0), (0.0, 4.0), (0.0, -4.0)):
            await bot.walk_to(begin[0] + x, begin[1] + y, begin[2])
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(WALK_LIMIT_S):
                    async for _ in bot.events():
                        moved = math.dist(begin, bot.position)
                        if moved > 1.0:
                            return moved
    raise AssertionError("the bot has not moved")


def record_crowd(path: Path) -> Path:
    """Write a recording: one person crosses an open place, two others go on long after that."""
    lines = ["t,id,x,y"]
    for tick in range(401):
        seconds = tick / 10.0
        if seconds <= 8.0:
            lines.append(f"{seconds},1,{1.2 * seconds - 5.0},0.0")
        lines += [f"{seconds},{k},{0.5 * seconds - 8.0},{3.0 * k}" for k in (2, 3)]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


if __name__ == "__main__":
    main(Path(sys.argv[1]))

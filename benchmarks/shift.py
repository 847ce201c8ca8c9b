"""Many people and some consoles at once, for minutes, in processes of their own as in real life.

    python -m benchmarks.shift                          200 bots, five consoles, five minutes
    python -m benchmarks.shift --bots 50 --seconds 60

Each console has the map ten times a second, events, changes, figures and one actor, as the
page has. `tick` is what the server says of its own ticks, second by second; `lost` is whatever it
dropped.
"""

import argparse
import asyncio
import http
import http.client
import json
import os
import re
import socket
import sys
import time
from collections.abc import AsyncIterator, Mapping
from contextlib import asynccontextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Final

import numpy as np
from websockets.asyncio.client import connect

READY_S: Final = 300.0
SETTLING_S: Final = 15.0
LOST: Final = re.compile(
    r"^esplanade_(\w*(?:dropped|lost|too_slow|refused|failed)\w*(?:\{[^}]*\})?) ([0-9.e+]+)$",
    re.MULTILINE,
)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--bots", type=int, default=200)
    parser.add_argument("--consoles", type=int, default=5)
    parser.add_argument("--actors", type=int, default=30)
    parser.add_argument("--seconds", type=float, default=300.0)
    options = parser.parse_args()
    with TemporaryDirectory() as folder:
        asyncio.run(_shift(options, Path(folder)))


async def _shift(options: argparse.Namespace, folder: Path) -> None:
    port, private = _free_port(), _free_port()
    data = ["--data", str(folder / "world")]
    serve = ["serve", *data, "--port", f"{port}", "--private-port", f"{private}"]
    async with _process(*serve, "--actors", f"{options.actors}"):
        await _ready(private)
        token = await _token(data)
        crowd = ["bots", "--count", f"{options.bots}", "--duration", f"{options.seconds + 120:g}"]
        async with _process(*crowd, "--url", f"ws://127.0.0.1:{port}"):
            await asyncio.sleep(SETTLING_S)
            before = _lost(private)
            begun = time.time()
            looking = [
                asyncio.create_task(_look(private, token, options.seconds))
                for _ in range(options.consoles)
            ]
            seen = await asyncio.gather(*looking)
            ticks = await asyncio.to_thread(_ticks, private, token, begun)
            _print(options, seen, ticks, before, _lost(private))


def _print(
    options: argparse.Namespace,
    seen: list[dict[str, float]],
    ticks: dict[str, Any],
    before: dict[str, float],
    after: dict[str, float],
) -> None:
    names = "tick_p50_ms", "tick_p99_ms", "people"
    median, high, people = (np.array(ticks[name]) for name in names)
    print(f"{int(people.min())} to {int(people.max())} people, {options.actors} actors")
    print(
        f"tick p50 {np.median(median):.1f} ms; p99 of a second: median {np.median(high):.1f} ms, "
        f"p95 {np.percentile(high, 95):.1f} ms, most {high.max():.1f} ms"
    )
    for number, one in enumerate(seen, 1):
        print(
            f"console {number}: {one['bytes'] / options.seconds / 1e3:.1f} kB/s, "
            f"{one['frames'] / options.seconds:.1f} blocks of the map a second, "
            f"longest silence {one['silence_s']:.2f} s"
        )
    lost = {name: after[name] - before.get(name, 0.0) for name in after}
    told = ", ".join(f"{name} {value:g}" for name, value in lost.items() if value > 0)
    print(f"lost: {told or 'nothing'}")


async def _look(private: int, token: str, seconds: float) -> dict[str, float]:
    """Read all that a page would be sent, for a time."""
    url = f"ws://127.0.0.1:{private}/api/v1/live"
    headers = {"Authorization": f"Bearer {token}"}
    found = {"bytes": 0.0, "frames": 0.0, "silence_s": 0.0}
    async with connect(url, additional_headers=headers, max_size=None, proxy=None) as console:
        for channel, more in (
            ("map", {"hz": 10}),
            ("actor:actor-1", {"hz": 10}),
            *((name, {}) for name in ("events", "changes", "series")),
        ):
            await console.send(json.dumps({"subscribe": channel, **more}))
        begun = last = time.monotonic()
        while (now := time.monotonic()) - begun < seconds:
            message = await console.recv()
            found["bytes"] += len(message)
            found["frames"] += isinstance(message, bytes)
            found["silence_s"] = max(found["silence_s"], now - last)
            last = now
    return found


def _ticks(private: int, token: str, since: float) -> dict[str, Any]:
    """The server's own figures about its ticks, second by second."""
    path = "/api/v1/series?names=tick_p50_ms,tick_p99_ms,people&step_s=1"
    bearer = {"Authorization": f"Bearer {token}"}
    told = json.loads(_get(private, f"{path}&from_us={since * 1e6:.0f}", bearer))
    return {
        name: [value for value in values if value is not None]
        for name, values in told["values"].items()
    }


def _lost(private: int) -> dict[str, float]:
    text = _get(private, "/metrics").decode()
    return {name: float(value) for name, value in LOST.findall(text)}


async def _ready(private: int) -> None:
    async with asyncio.timeout(READY_S):
        while True:
            try:
                await asyncio.to_thread(_get, private, "/readyz")
            except OSError:
                await asyncio.sleep(0.5)
            else:
                return


def _get(private: int, path: str, headers: Mapping[str, str] | None = None) -> bytes:
    """The answer of the private port; OSError if it refuses."""
    connection = http.client.HTTPConnection("127.0.0.1", private, timeout=60)
    try:
        connection.request("GET", path, headers=dict(headers or {}))
        answer = connection.getresponse()
        body = answer.read()
    finally:
        connection.close()
    if answer.status != http.HTTPStatus.OK:
        raise OSError(f"{path}: {answer.status} {body[:200]!r}")
    return body


async def _token(data: list[str]) -> str:
    add = ["op", "user", "add", "watcher", "--role", "tuner", *data, "--token"]
    made = await asyncio.create_subprocess_exec(
        sys.executable, "-m", "esplanade", *add, stdout=asyncio.subprocess.PIPE
    )
    told, _ = await made.communicate()
    return told.decode().strip()


@asynccontextmanager
async def _process(*command: str) -> AsyncIterator[None]:
    """A command of ours while it is needed."""
    environment = {**os.environ, "ESPLANADE_LOG_LEVEL": "warning"}
    started = await asyncio.create_subprocess_exec(
        sys.executable,
        "-m",
        "esplanade",
        *command,
        env=environment,
        stdout=asyncio.subprocess.DEVNULL,
    )
    try:
        yield
    finally:
        if started.returncode is None:
            started.terminate()
            await started.wait()


def _free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
        return port


if __name__ == "__main__":
    main()

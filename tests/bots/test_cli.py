"""`esplanade bots` as people call it: a process, its output, its exit code."""

import asyncio
import json
import signal
import sys
from pathlib import Path

import pytest

from esplanade.bots.options import parser
from esplanade.cli import main
from esplanade.protocol import ErrorCode
from esplanade.protocol.messages import Error
from tests.bots.scripted import scripted_server, until
from tests.patience import PATIENCE_S

PROJECT = Path(__file__).resolve().parents[2]
RECORDING = "t,id,x,y\n" + "".join(
    f"{t / 10:.1f},ann,{t / 10:.2f},0\n{t / 10:.1f},bob,5,{-t / 20:.2f}\n" for t in range(0, 21, 4)
)


def run(arguments: list[str]) -> object:
    """The exit code, whether the parser refuses or the command."""
    try:
        return main(["bots", *arguments])
    except SystemExit as end:
        return end.code


async def start(*arguments: str) -> asyncio.subprocess.Process:
    return await asyncio.create_subprocess_exec(
        sys.executable,
        "-m",
        "esplanade",
        "bots",
        *arguments,
        cwd=PROJECT,
        stdout=asyncio.subprocess.PIPE,
        stderr=asyncio.subprocess.PIPE,
        preexec_fn=_hear_interrupts,
    )


def _hear_interrupts() -> None:
    """Tests that run in the background of a shell ignore SIGINT, and so would their children."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


async def finish(process: asyncio.subprocess.Process) -> tuple[int | None, str, str]:
    out, err = await asyncio.wait_for(process.communicate(), PATIENCE_S)
    return process.returncode, out.decode(), err.decode()


async def test_a_load_test_reports_and_ends_well(tmp_path: Path) -> None:
    target = tmp_path / "load.json"
    async with scripted_server() as server:
        process = await start(
            *("--url", server.url, "--count", "4", "--duration", "1", "--processes", "2"),
            *("--json", str(target)),
        )
        code, out, err = await finish(process)
    assert code == 0, err
    assert "4 of 4" in out
    assert "age of snapshots" in out
    result = json.loads(target.read_text())
    assert result["clients"]["left"] == 4
    assert result["settings"]["count"] == 4
    assert result["round_trip_ms"]["p50"] > 0.0
    assert result["errors"] == {}


async def test_a_replay_reports_deviations_and_skips_single_samples(tmp_path: Path) -> None:
    recording, target = tmp_path / "two.csv", tmp_path / "replay.json"
    recording.write_text(RECORDING + "1.0,cat,0,0\n")
    async with scripted_server() as server:
        process = await start(
            "--url", server.url, "--replay", str(recording), "--json", str(target)
        )
        code, out, err = await finish(process)
    assert code == 0, err
    assert "2 of 2" in out
    assert "within 0.1 m" in out
    result = json.loads(target.read_text())
    assert result["replay"]["skipped"] == 1
    assert result["replay"]["deviation_m"]["count"] > 30


async def test_a_speed_limit_is_explained(tmp_path: Path) -> None:
    recording = tmp_path / "two.csv"
    recording.write_text(RECORDING)
    async with scripted_server(max_speed=2.0) as server:
        process = await start(
            "--url", server.url, "--replay", str(recording), "--speedup", "4", "--limit", "1"
        )
        code, out, err = await finish(process)
    assert code == 0
    assert "1 of 1" in out
    assert "--person-max-speed-mps 4.0 or lower --speedup" in err


async def test_people_off_their_way_are_explained(tmp_path: Path) -> None:
    recording = tmp_path / "two.csv"
    recording.write_text(RECORDING)
    async with scripted_server() as server:
        server._apply = lambda: None  # type: ignore[method-assign]
        process = await start("--url", server.url, "--replay", str(recording))
        code, _, err = await finish(process)
    assert code == 0
    assert f"esplanade serve --crowd {recording}" in err


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
async def test_a_signal_sends_everyone_home_and_reports(number: int) -> None:
    async with scripted_server() as server:
        process = await start("--url", server.url, "--count", "3", "--duration", "0")
        await until(lambda: len(server.people) == 3)
        process.send_signal(number)
        code, out, err = await finish(process)
        await until(lambda: not server.people)
    assert code == 0, err
    assert "3 of 3" in out


async def test_bots_end_with_the_process_that_sent_them() -> None:
    async with scripted_server() as server:
        process = await start("--url", server.url, "--count", "3", "--duration", "0")
        await until(lambda: len(server.people) == 3)
        process.kill()
        await process.communicate()
        await until(lambda: not server.people)
    assert [person.socket.close_code for person in server.all_people] == [1000] * 3


async def test_refused_bots_are_a_failure() -> None:
    async with scripted_server() as server:
        server.on_hello = lambda hello: Error(error=ErrorCode.SERVER_FULL, text="full")
        process = await start("--url", server.url, "--count", "2", "--duration", "0.1")
        code, out, _ = await finish(process)
    assert code == 1
    assert "server_full" in out


@pytest.mark.parametrize(
    ("arguments", "fault"),
    [
        (["--count", "none"], "--count: 'none' is no whole number from 1 to 10000"),
        (["--url", "ftp://x"], "--url: url 'ftp://x': unknown scheme"),
        (["--limit", "3"], "limit: belongs to a replay"),
        (["--replay", "absent.csv"], "absent.csv: cannot be read: No such file"),
        (["--json", "absent/folder/x.json"], "--json: there is no folder absent/folder"),
    ],
)
def test_wrong_usage_is_told(
    arguments: list[str], fault: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(arguments) == 2
    assert fault in capsys.readouterr().err


def test_a_server_that_is_not_there_is_told_at_once(
    unused_tcp_port: int, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["--url", f"ws://127.0.0.1:{unused_tcp_port}", "--count", "500"]) == 1
    err = capsys.readouterr().err
    assert f"nobody answers at ws://127.0.0.1:{unused_tcp_port}: Connection refused" in err


def test_a_recording_of_single_samples_has_nobody_to_send(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    recording = tmp_path / "one.csv"
    recording.write_text("t,id,x,y\n0,a,1,2\n")
    assert run(["--replay", str(recording)]) == 2
    assert "nobody in it has a way" in capsys.readouterr().err


def test_unknown_options_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["--visitors", "3"]) == 2
    assert "--visitors" in capsys.readouterr().err


def test_help_explains_every_option() -> None:
    text = parser().format_help()
    for option in (
        *("--url", "--count", "--duration", "--seed", "--processes", "--join-rate"),
        *("--replay", "--speedup", "--limit", "--linger", "--json"),
    ):
        assert option in text

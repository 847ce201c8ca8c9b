"""The way in as documented, with a real process: serve, an account with its token, requests."""

import asyncio
import json
import os
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

from tests.patience import PATIENCE_S
from tests.server.http import get
from tests.server.test_process import served


def _esplanade(*words: str, **variables: str) -> "subprocess.CompletedProcess[str]":
    return subprocess.run(
        [sys.executable, "-m", "esplanade", *words],
        env={**os.environ, **variables},
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
        check=False,
    )


def _told(*words: str, **variables: str) -> str:
    done = _esplanade(*words, **variables)
    assert done.returncode == 0, done.stderr
    return done.stdout


async def test_an_operator_tunes_a_world_while_it_runs(room_file: Path, tmp_path: Path) -> None:
    data = str(tmp_path / "world")
    with served(room_file, "--data", data) as server:
        port = server.private_port
        assert (await get(port, "/readyz")).status == 200
        token = _told("op", "user", "add", "olga", "--role", "tuner", "--data", data, "--token")
        bearer = {"Authorization": f"Bearer {token.strip()}"}
        answer = await get(port, "/api/v1/actors", bearer)
        (actor,) = json.loads(answer.body)["actors"]
        assert actor["id"] == "main/actor-1"
        command = (
            b'{"op": "set_parameters", "scope": "world", "values": {"risk_weight": 12}, '
            b'"note": "try"}'
        )
        sent = {**bearer, "X-Esplanade": "1", "Content-Type": "application/json"}
        answer = await get(port, "/api/v1/commands", sent, "POST", command)
        assert answer.status == 200, answer.body
        change = json.loads(answer.body)["command"]

        here = {
            "ESPLANADE_URL": f"http://localhost:{port}".replace("localhost", "127.0.0.1"),
            "ESPLANADE_TOKEN": token.strip(),
        }
        shown = await asyncio.to_thread(_told, "op", "get", "actor-1", **here)
        assert _row(shown, "risk_weight") == ["12", "world"]
        assert _row(shown, "speed_mps")[1] == "own"
        assert _row(shown, "foresight_s") == ["3", "default"]
        undone = await asyncio.to_thread(_told, "op", "undo", **here)
        assert "world risk_weight: 12.0 -> not set" in undone
        shown = await asyncio.to_thread(_told, "op", "get", "actor-1", **here)
        assert _row(shown, "risk_weight") == ["9.5", "default"]
        told = await asyncio.to_thread(
            _told, "op", "set", "risk_weight=3", "--actor", "actor-1", "--note", "again", **here
        )
        assert "actor:main/actor-1 risk_weight: not set -> 3.0" in told
        shown = await asyncio.to_thread(_told, "op", "diff", **here)
        assert any(
            line.split("│")[1:4] and "risk_weight" in line and "actor:main/actor-1" in line
            for line in shown.splitlines()
        )
        wrong = await asyncio.to_thread(_esplanade, "op", "set", "risk_weight=-1", **here)
        assert wrong.returncode == 1
        assert "values.risk_weight" in wrong.stderr
        rows: list[dict[str, Any]] = [
            json.loads(line) for line in _told("op", "audit", "--data", data, "--json").splitlines()
        ]
        (asked,) = [row for row in rows if row["seq"] == change and row["writer"] == "server"]
        assert asked["note"] == "try"
        server.process.send_signal(signal.SIGKILL)
        server.process.wait(PATIENCE_S)
        assert "fault" not in _told("op", "audit", "--verify", "--data", data)


def _row(shown: str, name: str) -> list[str]:
    """The cells beside a parameter's name in a table."""
    (line,) = [line for line in shown.splitlines() if f" {name} " in line]
    return [cell.strip() for cell in line.strip("│| ").split("│")[1:]]

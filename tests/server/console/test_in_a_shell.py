"""The lines by which the documentation begins are a script: a shell runs them over real ports."""

import json
import os
import re
import signal
import subprocess
import sys
from contextlib import suppress
from pathlib import Path
from typing import Any

from tests.patience import COMPILING_PATIENCE_S
from tests.ports import free_ports

PAGE = Path(__file__).resolve().parents[3] / "docs" / "operators.md"


def the_script() -> str:
    (found,) = re.findall(
        r"^```sh\n(esplanade serve --data world &\n.*?)^```",
        PAGE.read_text(),
        re.MULTILINE | re.DOTALL,
    )
    return found


def test_the_lines_of_the_documentation_work_as_written(tmp_path: Path) -> None:
    port, private_port = free_ports(2)
    # Nothing of the script is another but the port, since others may serve on this machine too.
    script = the_script().replace("8081", str(private_port))
    called = tmp_path / "esplanade"
    called.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m esplanade "$@"\n')
    called.chmod(0o755)
    variables = {
        **{name: value for name, value in os.environ.items() if not name.startswith("ESPLANADE_")},
        "PATH": f"{tmp_path}{os.pathsep}{os.environ['PATH']}",
        "ESPLANADE_PORT": str(port),
        "ESPLANADE_PRIVATE_PORT": str(private_port),
    }
    with (tmp_path / "told").open("w+b") as told, (tmp_path / "log").open("w+b") as log:
        shell = subprocess.Popen(
            ["bash", "-euo", "pipefail", "-c", f"{script}\nkill $!\nwait $!"],
            cwd=tmp_path,
            env=variables,
            stdout=told,
            stderr=log,
            start_new_session=True,
        )
        try:
            code = shell.wait(COMPILING_PATIENCE_S)
        finally:
            with suppress(ProcessLookupError):  # where all went well nobody of it is left
                os.killpg(shell.pid, signal.SIGKILL)
        log.seek(0)
        assert code == 0, log.read().decode()[-4000:]
        told.seek(0)
        ready, actors, answer, shown = parts(told.read().decode())
    assert "ready" in ready
    assert "main/actor-1" in {each["id"] for each in actors["actors"]}
    assert answer["after"] == {"world": {"risk_weight": 12.0}}
    assert answer["price"] == "tick"
    (row,) = [line for line in shown.splitlines() if " risk_weight " in line and "│" in line]
    assert [cell.strip() for cell in row.strip("│| ").split("│")[1:]] == ["12", "world"]
    assert "world risk_weight: 12.0 -> not set" in shown


def parts(told: str) -> tuple[str, Any, Any, str]:
    """The output of each line of the script; answers of the server have no end of line."""
    decoder = json.JSONDecoder()
    ready, _, rest = told.partition("{")
    actors, end = decoder.raw_decode("{" + rest)
    rest = ("{" + rest)[end:].lstrip()
    answer, end = decoder.raw_decode(rest)
    return ready, actors, answer, rest[end:]

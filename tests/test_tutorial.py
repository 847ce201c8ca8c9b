"""The tutorial holds: its programs and commands run one after the other in an empty folder."""

import re
import shlex
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

from tests.patience import COMPILING_PATIENCE_S

PAGE = (Path(__file__).parents[1] / "docs" / "tutorial.md").read_text(encoding="utf-8")
BLOCK = re.compile(r"^```(python|sh)\n(.*?)^```", re.MULTILINE | re.DOTALL)


def run(line: str, folder: Path) -> None:
    words = shlex.split(line, comments=True)
    programs = {"python": [sys.executable], "esplanade": [sys.executable, "-m", "esplanade"]}
    ours = words[0] in programs
    command = shlex.join([*programs[words[0]], *words[1:]]) if ours else line
    done = subprocess.run(
        command,
        shell=True,
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=COMPILING_PATIENCE_S,
        check=False,
    )
    assert done.returncode == 0, f"{line}\n{done.stdout}\n{done.stderr}"


@pytest.mark.skipif(find_spec("pyrvo") is None, reason="pyrvo is absent")
def test_a_newcomer_gets_to_the_comparison(tmp_path: Path) -> None:
    for language, text in BLOCK.findall(PAGE):
        if language == "python":
            name = text.split("\n", 1)[0].removeprefix("# ")
            (tmp_path / name).write_text(text)
            continue
        for line in text.splitlines():
            run(line, tmp_path)
    assert (tmp_path / "out.html").stat().st_size > 10_000
    assert len((tmp_path / "scores.jsonl").read_text().splitlines()) > 20

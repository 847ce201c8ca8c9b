"""The lines of Python in the documents make the file that they promise."""

import re
from pathlib import Path

import pytest

from esplanade.recordings import read_crowd

ROOT = Path(__file__).resolve().parents[3]


def test_the_lines_of_the_documents_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "scenes").symlink_to(ROOT / "scenes")
    monkeypatch.chdir(tmp_path)
    (lines,) = re.findall(r"```python\n(.*?)```", (ROOT / "docs/files.md").read_text(), re.DOTALL)
    assert len([line for line in lines.splitlines() if line.strip()]) <= 10
    exec(lines, {})
    assert capsys.readouterr().out.endswith("12 are there at 20.0 s\n")
    crowd = read_crowd("plaza.csv")
    assert len(crowd.tracks) == 12
    assert crowd.end_s == pytest.approx(20.0)
    text = Path("plaza.csv").read_text()
    assert "tick 201, parameters: {" in text
    assert text.endswith("tick 400, end: {}\n")

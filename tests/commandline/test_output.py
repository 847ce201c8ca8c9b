"""Results go to a console, a file or a folder."""

import json
from pathlib import Path

import pytest

from esplanade.commandline.errors import UsageError
from esplanade.commandline.output import console, made_folder, write_json


def test_json_has_null_where_a_number_is_not_finite(tmp_path: Path) -> None:
    target = tmp_path / "x.json"
    write_json("--json", target, {"a": (1.0, float("inf")), "b": {"c": float("nan")}})
    assert json.loads(target.read_text()) == {"a": [1.0, None], "b": {"c": None}}


def test_what_cannot_be_written_is_told_with_the_option(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"^--json: "):
        write_json("--json", tmp_path, {})
    (tmp_path / "file").touch()
    with pytest.raises(UsageError, match=r"^--out: "):
        made_folder("--out", tmp_path / "file" / "in")


def test_a_file_or_pipe_is_wide(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("COLUMNS", "20")
    console().print("x" * 150)
    assert capsys.readouterr().out == "x" * 150 + "\n"

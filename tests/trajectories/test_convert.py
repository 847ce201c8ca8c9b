"""`esplanade recording convert`: other formats, with what the file comes from."""

from pathlib import Path

import pytest

from esplanade.cli import main
from esplanade.recordings import read_crowd
from tests.recordings.forms import FORMS, SPEED_MPS


@pytest.mark.parametrize("suffix", ["csv", "txt", "sqlite"])
def test_a_recording_in_another_format(
    tmp_path: Path, suffix: str, capsys: pytest.CaptureFixture[str]
) -> None:
    path, made = tmp_path / "annotations.txt", tmp_path / f"made.{suffix}"
    path.write_bytes(FORMS["stanford"].content)
    options = ["--scale", "0.04", "--hz", "10", "--out", str(made)]
    assert main(["recording", "convert", str(path), *options]) == 0
    shown = capsys.readouterr()
    assert shown.out == f"{made}\n"
    assert "2 people" in shown.err
    crowd = read_crowd(made)
    assert crowd.report is not None
    assert crowd.report.sample_s == pytest.approx(0.1)
    assert crowd.report.median_mps == pytest.approx(SPEED_MPS, rel=0.05)
    content = made.read_bytes().decode(errors="replace")
    assert "--scale 0.04 --hz 10.0" in content
    assert "annotations.txt" in content


def test_a_format_that_is_none(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "a.csv"
    path.write_bytes(FORMS["csv"].content)
    assert main(["recording", "convert", str(path), "--out", str(tmp_path / "a.doc")]) == 2
    assert "a.doc ends in none of .csv, .txt, .sqlite, .parquet" in capsys.readouterr().err

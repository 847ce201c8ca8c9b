"""`esplanade recording check`: figures, pictures, warnings, refusals."""

import json
from pathlib import Path

import pytest

from esplanade.cli import main
from tests.recordings.forms import FORMS


def write(folder: Path, name: str) -> Path:
    form = FORMS[name]
    path = folder / form.name
    path.write_bytes(form.content)
    return path


@pytest.mark.parametrize("suffix", ["png", "svg"])
def test_figures_are_told_and_drawn(
    tmp_path: Path, suffix: str, capsys: pytest.CaptureFixture[str]
) -> None:
    picture = tmp_path / f"crowd.{suffix}"
    path = write(tmp_path, "petrack")
    assert main(["recording", "check", str(path), "--out", str(picture)]) == 0
    shown = capsys.readouterr().out
    assert f"{path}: 2 people, 0.56 s, 0.04 s a sample, median 1.25 m/s" in shown
    assert "25 frames a second, as the file says" in shown
    assert "in cm as its header says" in shown
    assert picture.stat().st_size > 10_000


def test_figures_as_json(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write(tmp_path, "stanford")
    assert main(["recording", "check", str(path), "--scale", "0.04", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["people"] == 2
    assert found["unit"] == "0.04 m a unit by --scale"
    assert found["most_at_once"] == 2


def test_what_is_odd_fails(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write(tmp_path, "csv")
    assert main(["recording", "check", str(path), "--unit", "ft"]) == 0
    assert main(["recording", "check", str(path), "--scale", "0.1"]) == 1
    assert "warning: the median speed is 0.125 m/s" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("name", "options", "said"),
    [
        ("stanford", [], "its coordinates are pixels: give --scale"),
        ("csv", ["--unit", "cm", "--scale", "2"], "unit and scale: give one of them, not both"),
        ("csv", ["--out", "a.txt"], "a.txt is no .png, .svg or .pdf file"),
        ("csv", ["--unit", "mile"], "'mile' is no choice"),
    ],
)
def test_refusals_name_what_helps(
    tmp_path: Path, name: str, options: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    path = write(tmp_path, name)
    try:
        code = main(["recording", "check", str(path), *options])
    except SystemExit as end:
        code = int(end.code or 0)
    assert code == 2
    assert said in capsys.readouterr().err


def test_help_teaches(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["recording", "check", "--help"])
    shown = capsys.readouterr().out
    for word in ("TrajNet", "JuPedSim", "--fps", "--unit", "--scale", "# framerate", "gzip"):
        assert word in shown


def test_columns_are_named_by_hand(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write(tmp_path, "csv with columns named by hand")
    assert main(["recording", "check", str(path)]) == 2
    assert "--columns names them" in capsys.readouterr().err
    named = ["--columns", "t=Zeit/ms,id=Wer,x=Rechts/cm,y=Hoch/cm"]
    assert main(["recording", "check", str(path), *named]) == 0
    assert "median 1.25 m/s" in capsys.readouterr().out
    assert main(["recording", "check", str(path), "--columns", "t=Uhr,id=Wer,x=Ost,y=Hoch"]) == 2
    assert "--columns: there is no column 'Uhr'" in capsys.readouterr().err


def test_a_folder_is_one_recording(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = tmp_path / "people"
    folder.mkdir()
    write(folder, "vadere")
    assert main(["recording", "check", str(folder)]) == 0
    assert f"{folder}: 2 people" in capsys.readouterr().out
    target = tmp_path / "both.csv"
    assert main(["recording", "convert", str(folder), "--out", str(target)]) == 0
    assert target.is_file()
